"""The floating gripper: straight motions of a tool that points down, and two fingers."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from mend.robots.arm.body import ToolPose
from mend.robots.arm.gripper import GripperModel, Slab
from mend.sim.tabletop.blocker import Blocker, between, shares_between

SEGMENT_S = 0.5
"""How long a segment of a path takes at full speed, however long it is."""

GIVE_UP_S = 2.0
"""An arm that is held up for so long gives its motion up, as real controllers do."""

GRIPPER_S = 0.5
"""How long the fingers take from fully open to closed."""

GRIPPER = GripperModel(
    min_width_m=0.012,
    max_width_m=0.078,
    min_height_m=0.020,
    max_length_m=0.40,
    max_height_m=0.25,
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


class CartesianArm:
    """Moves the tool along one straight segment at a time."""

    def __init__(self, pose: ToolPose) -> None:
        self.pose = pose
        self.speed = 1.0
        self.homeward = False
        self._start = pose
        self._target: ToolPose | None = None
        self._ahead: Sequence[ToolPose] = ()
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
        self._ahead = path.waypoints[segment:]
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

    @property
    def way_ahead(self) -> Sequence[ToolPose]:
        """Where the tool is, and the waypoints that it has still to go to."""
        return [self.pose, *self._ahead] if self.moving else [self.pose]

    def advance(self, duration_s: float, blocker: Blocker | None) -> bool:
        """Go on; whether it runs into a blocker, before which it stops and pushes in vain."""
        if self._target is None:
            return False
        wanted = min(1.0, self._fraction + duration_s * self.speed / SEGMENT_S)
        self._fraction, runs_into = self._free_until(wanted, blocker)
        if self._fraction >= 1.0 - 1e-9:
            self.pose = self._target
            self._target = None
            return False
        self.pose = between(self._start, self._target, self._fraction)
        self._held_up_s = self._held_up_s + duration_s if runs_into else 0.0
        if self._held_up_s >= GIVE_UP_S:
            self.stop()
        return runs_into

    def _free_until(self, wanted: float, blocker: Blocker | None) -> tuple[float, bool]:
        """How far the segment can be gone, up to a fraction, and whether the blocker ends that."""
        if blocker is None or self._target is None or not self.can_be_blocked:
            return wanted, False
        free, left = self._fraction, wanted - self._fraction
        end = between(self._start, self._target, wanted)
        for share in shares_between(self.pose, end):
            fraction = self._fraction + left * share
            if blocker.meets(between(self._start, self._target, fraction)):
                return free, True
            free = fraction
        return wanted, False


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
