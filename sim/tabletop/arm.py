"""The floating gripper: straight motions of a tool that points down, and two fingers."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from robots.body import ToolPose
from robots.gripper import GripperModel, Slab

SEGMENT_S = 0.5
"""How long a segment of a path takes at full speed, however long it is."""

GIVE_UP_S = 2.0
"""An arm that is held up for so long gives its motion up, as real controllers do."""

GRIPPER_S = 0.5
"""How long the fingers take from fully open to closed."""

GRIPPER = GripperModel(
    min_width_m=0.010,
    max_width_m=0.078,
    max_opening_m=0.090,
    max_mass_kg=0.5,
    grip_force_n=33.0,
    tip_reach_m=0.010,
    pad_above_tip_m=0.0,
    overlap_m=0.007,
    deepest_m=0.025,
    link_m=0.0,
    link_offset_m=0.0,
    fingers=(Slab(0.0, 0.010, 0.020),),
    palm=(Slab(0.070, 0.110, 0.050),),
)
"""Two thin fingers that slide; it takes what the workcell's takes."""


@dataclass(frozen=True, slots=True)
class StraightPath:
    """Straight lines through waypoints. `homeward`: nobody stands in the way of this one."""

    waypoints: Sequence[ToolPose]
    homeward: bool = False

    @property
    def segments(self) -> int:
        return len(self.waypoints)


class Arm:
    """Moves the tool along one straight segment at a time."""

    def __init__(self, pose: ToolPose) -> None:
        self.pose = pose
        self.speed = 1.0
        self.homeward = False
        self._start = pose
        self._target: ToolPose | None = None
        self._fraction = 1.0
        self._held_up_s = 0.0

    @property
    def moving(self) -> bool:
        return self._target is not None

    @property
    def progress(self) -> float:
        return 1.0 if self._target is None else self._fraction

    @property
    def target(self) -> ToolPose | None:
        """Where the segment under way leads."""
        return self._target

    def follow(self, path: StraightPath, segment: int, speed: float) -> None:
        """Go straight to a waypoint from wherever the tool is."""
        self._start = self.pose
        self._target = path.waypoints[segment]
        self._fraction = 0.0
        self._held_up_s = 0.0
        self.homeward = path.homeward
        self.speed = speed

    def stop(self) -> None:
        self._target = None

    def jump(self, pose: ToolPose) -> None:
        """Be somewhere else at once (a rebuilt world)."""
        self.stop()
        self.pose = pose

    @property
    def can_be_blocked(self) -> bool:
        """Whether somebody can stand in the way of this motion; up and home are always free."""
        if self._target is None or self.homeward:
            return False
        straight_up = (self._target.x, self._target.y) == (self.pose.x, self.pose.y)
        return not (straight_up and self._target.z >= self.pose.z)

    def push(self, duration_s: float) -> None:
        """Try in vain to move on."""
        self._held_up_s += duration_s
        if self._held_up_s >= GIVE_UP_S:
            self.stop()

    def advance(self, duration_s: float) -> None:
        if self._target is None:
            return
        self._fraction += duration_s * self.speed / SEGMENT_S
        if self._fraction >= 1.0 - 1e-9:
            self.pose = self._target
            self._target = None
        else:
            self.pose = _between(self._start, self._target, self._fraction)


class Gripper:
    """Two fingers that open and close evenly; something gripped stops them early."""

    def __init__(self) -> None:
        self.opening_m = 0.0
        self._start_m = 0.0
        self._target_m: float | None = None

    @property
    def moving(self) -> bool:
        return self._target_m is not None

    @property
    def opening(self) -> bool:
        """Whether the fingers are on their way apart."""
        return self._target_m is not None and self._target_m > self._start_m

    @property
    def closing(self) -> bool:
        """Whether the fingers are on their way together."""
        return self._target_m == 0.0

    @property
    def started_at_m(self) -> float:
        """How far apart the fingers were when they began to move."""
        return self._start_m

    @property
    def progress(self) -> float:
        if self._target_m is None:
            return 1.0
        way = self._target_m - self._start_m
        return (self.opening_m - self._start_m) / way if way else 1.0

    def open(self, opening_m: float) -> None:
        """Move the fingers to be so far apart, as far as they go."""
        self._move_to(min(opening_m, GRIPPER.max_opening_m))

    def close(self) -> None:
        self._move_to(0.0)

    def grip(self, width_m: float) -> None:
        """Stop at something between the fingers."""
        self.opening_m = width_m
        self._target_m = None

    def snap_shut(self) -> None:
        """What was between the fingers is gone: they meet."""
        self.opening_m = 0.0
        self._target_m = None

    def advance(self, duration_s: float) -> None:
        if self._target_m is None:
            return
        reach = GRIPPER.max_opening_m * duration_s / GRIPPER_S
        left = self._target_m - self.opening_m
        if abs(left) <= reach + 1e-9:
            self.opening_m = self._target_m
            self._target_m = None
        else:
            self.opening_m += math.copysign(reach, left)

    def _move_to(self, opening_m: float) -> None:
        self._start_m = self.opening_m
        self._target_m = opening_m


def _between(start: ToolPose, end: ToolPose, fraction: float) -> ToolPose:
    turn = (end.yaw - start.yaw + math.pi) % (2 * math.pi) - math.pi
    return ToolPose(
        start.x + (end.x - start.x) * fraction,
        start.y + (end.y - start.y) * fraction,
        start.z + (end.z - start.z) * fraction,
        start.yaw + turn * fraction,
    )
