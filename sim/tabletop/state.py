"""Everything that is so in a tabletop world at one moment, and what one control cycle changes."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mend.robots.body import ToolPose
from mend.sim.tabletop.arm import GRIPPER, CartesianArm, Gripper
from mend.sim.tabletop.blocker import SIZE_M, Blocker, on_the_way
from mend.sim.tabletop.part import TablePart, UprightPose, Whereabouts
from mend.sim.tabletop.resting import on_top, settle
from mend.tasks.scene import Scene

CONTROL_PERIOD_S = 0.1

PUSH_N = 120.0
"""How hard the arm pushes against somebody in its way."""

_PASSES_M = 0.20
"""So far above the table the tool passes on most ways."""

_FINGER_M = 0.005
"""Fingers still grip what they overlap by less than they are wide."""


@dataclass(frozen=True, slots=True)
class HeldAt:
    """Where a held part's bottom centre is relative to the tool.

    `along` the opening direction, `aside` of it, `up` from the tool point, turned by `yaw`.
    """

    along: float
    aside: float
    up: float
    yaw: float


@dataclass(frozen=True, slots=True)
class Home:
    """The arm's poses beside the table."""

    neutral: ToolPose
    hand_over: ToolPose

    @classmethod
    def beside(cls, scene: Scene) -> "Home":
        """Neutral to the right of the table, out of view; hand-over above its near edge."""
        table = scene.table
        return cls(
            neutral=ToolPose(
                table.center[0],
                table.center[1] - table.size[1] / 2 - 0.20,
                table.height + 0.30,
                0.0,
            ),
            hand_over=ToolPose(
                table.center[0] - table.size[0] / 2 + 0.15,
                table.center[1],
                table.height + 0.25,
                0.0,
            ),
        )


class TabletopState:
    """The arm, the parts, who stands in the way, and the clock."""

    def __init__(self, scene: Scene, rng: np.random.Generator) -> None:
        self.scene = scene
        self.time_s = 0.0
        self.home = Home.beside(scene)
        self.arm = CartesianArm(self.home.neutral)
        self.gripper = Gripper()
        self.gripper.opening_m = GRIPPER.max_opening_m
        self.parts: Mapping[str, TablePart] = {
            name: TablePart(name, definition, _start_pose(scene, name, rng))
            for name, definition in scene.objects.items()
        }
        self.held: TablePart | None = None
        self.held_at = HeldAt(0.0, 0.0, 0.0, 0.0)
        self.blocker: Blocker | None = None
        """Who stands in the way; the arm can always go up and home."""
        self.touching = False
        """Whether the arm has run into whoever stands in its way."""
        self.person_acts: Callable[[], None] = lambda: None
        """What people do in each cycle."""
        settle(self.parts.values(), scene.table)

    def advance_cycle(self) -> None:
        """Let one control period pass."""
        self.time_s += CONTROL_PERIOD_S
        self._advance_arm()
        self._advance_gripper()
        self._carry()
        self.person_acts()

    def reset(self, time_s: float, blocker: Blocker | None) -> None:
        """Start again at neutral with open, empty fingers (a rebuilt world)."""
        self.time_s = time_s
        self.blocker = blocker
        self.touching = False
        self.held = None
        self.arm.jump(self.home.neutral)
        self.gripper.grip(GRIPPER.max_opening_m)

    def block_way(self) -> None:
        """Somebody stands where the arm, on its way or setting off from here, runs into them."""
        table = self.scene.table
        middle = ToolPose(*table.center, table.height + _PASSES_M, 0.0)
        ways = (self.arm.way_ahead, [self.arm.pose, middle])
        found = (on_the_way(way, table.height) for way in ways)
        self.blocker = next(
            (each for each in found if each is not None),
            Blocker(*table.center, table.height + SIZE_M[2]),
        )

    def contact_force(self) -> NDArray[np.float64]:
        """What whoever stands in the way holds against the arm's motion (3, N)."""
        force = np.zeros(3)
        tool, target = self.arm.pose, self.arm.target
        if self.touching and target is not None:
            way = np.array([target.x - tool.x, target.y - tool.y, target.z - tool.z])
            force = -PUSH_N * way / max(float(np.linalg.norm(way)), 1e-6)
        return force

    def take_from_robot(self) -> None:
        """What the fingers hold is taken from between them; nobody has it for a moment."""
        self.held = None
        self.gripper.snap_shut()

    def drop_held(self) -> None:
        """The fingers let go: the part falls onto what is below it."""
        if self.held is None:
            return
        part, self.held = self.held, None
        part.give_to(Whereabouts.RESTING)
        part.pose = on_top(part, self.parts.values(), self.scene.table)
        self.settle()
        part.last_rest = part.pose

    def settle(self) -> None:
        """Let everything fall that nothing holds up any more."""
        settle(self.parts.values(), self.scene.table)

    def pose_in_fingers(self, held: HeldAt) -> UprightPose:
        """Where a part is that is held so."""
        tool = self.arm.pose
        cos, sin = math.cos(tool.yaw), math.sin(tool.yaw)
        return UprightPose(
            tool.x + held.along * cos - held.aside * sin,
            tool.y + held.along * sin + held.aside * cos,
            tool.z + held.up,
            tool.yaw + held.yaw,
        )

    def centred_in_fingers(self, part: TablePart) -> HeldAt:
        """How somebody holds a part out so that the fingers can close on it."""
        box = part.grasp_box
        return HeldAt(0.0, 0.0, -(box.low + box.high) / 2, -box.thin_yaw)

    def _advance_arm(self) -> None:
        if not self.arm.moving:
            return
        self.touching = self.arm.advance(CONTROL_PERIOD_S, self.blocker)

    def _advance_gripper(self) -> None:
        if not self.gripper.moving:
            return
        if self.gripper.opening:
            self.drop_held()
        elif self.held is not None:
            self.gripper.grip(self.gripper.opening_m)
            return
        closing = self.gripper.closing
        self.gripper.advance(CONTROL_PERIOD_S)
        if closing:
            self._grip()

    def _grip(self) -> None:
        """Take what is between the closing fingers once they touch it; they centre it."""
        for part in self.parts.values():
            at = self._between_fingers(part)
            if at is None:
                continue
            width = 2 * part.grasp_box.half_width(-at.yaw)
            if self.gripper.opening_m <= width:
                part.give_to(Whereabouts.HELD)
                self.held = part
                self.held_at = replace(at, along=0.0)
                self.gripper.grip(width)
                return

    def _between_fingers(self, part: TablePart) -> HeldAt | None:
        """Where a part is between open fingers; None if they do not go around it."""
        if part.whereabouts is Whereabouts.GONE or not part.shown:
            return None
        tool, pose, box = self.arm.pose, part.pose, part.grasp_box
        up = pose.z - tool.z
        if not box.low + up - _FINGER_M <= 0.0 <= box.high + up + _FINGER_M:
            return None
        cos, sin = math.cos(tool.yaw), math.sin(tool.yaw)
        dx, dy = pose.x - tool.x, pose.y - tool.y
        at = HeldAt(dx * cos + dy * sin, dy * cos - dx * sin, up, pose.yaw - tool.yaw)
        fits = abs(at.along) + box.half_width(-at.yaw) <= self.gripper.started_at_m / 2
        beside = abs(at.aside) <= box.half_width(math.pi / 2 - at.yaw) + _FINGER_M
        return at if fits and beside else None

    def _carry(self) -> None:
        if self.held is not None:
            self.held.pose = self.pose_in_fingers(self.held_at)


def _start_pose(scene: Scene, name: str, rng: np.random.Generator) -> UprightPose:
    """Where an object starts: where the scene says, give or take the scene's scatter."""
    pose, scatter = scene.objects[name].pose, scene.scatter
    dx, dy, turn = rng.uniform(-1.0, 1.0, 3)
    return UprightPose(
        pose.x + float(dx) * scatter.xy,
        pose.y + float(dy) * scatter.xy,
        scene.table.height if pose.z is None else pose.z,
        pose.yaw + float(turn) * scatter.yaw,
    )
