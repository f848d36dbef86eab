"""One robot's arm and fingers over the table, and what they hold."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mend.robots.arm.body import ArmRoom, ToolPose
from mend.sim.base_frame import tool_in_base, tool_in_scene
from mend.sim.tabletop.arm import GRIPPER, CartesianArm, Gripper
from mend.sim.tabletop.blocker import Blocker
from mend.sim.tabletop.part import TablePart, UprightPose, Whereabouts
from mend.sim.tabletop.resting import on_top, settle
from mend.tasks.frames import Frame
from mend.tasks.scene import Table

PUSH_N = 120.0
"""How hard the arm pushes against somebody in its way."""

_AROUND_M = 0.10
"""So far from the tool point the gripper reaches in the plane, with some room to spare."""

_BESIDE_M = 0.35
"""So far beside the table an arm rests: from any side of it the cameras of robots that stand there
see all of the table past it."""

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
    """The arm's poses beside the table, in the frame in which the table is given."""

    neutral: ToolPose
    hand_over: ToolPose

    @classmethod
    def beside(cls, table: Table) -> "Home":
        """Neutral to the right of the table, out of every view; hand-over above its near edge."""
        return cls(
            neutral=ToolPose(
                table.center[0],
                table.center[1] - table.size[1] / 2 - _BESIDE_M,
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

    @property
    def room(self) -> ArmRoom:
        """The room that the gripper takes, in that frame."""
        neutral, hand_over = self.neutral, self.hand_over
        return ArmRoom([(neutral.x, neutral.y)], (hand_over.x, hand_over.y), _AROUND_M)


class Manipulator:
    """An arm with two fingers, in the scene's frame; `frame` is the base that it belongs to."""

    def __init__(self, frame: Frame, table: Table, parts: Mapping[str, TablePart]) -> None:
        self.frame = frame
        self.home = Home.beside(frame.table_to_robot(table))
        """In the base frame."""
        self.arm = CartesianArm(tool_in_scene(frame, self.home.neutral))
        self.gripper = Gripper()
        self.gripper.opening_m = GRIPPER.max_opening_m
        self.held: TablePart | None = None
        self.touching = False
        """Whether the arm has run into whoever stands in its way."""
        self._held_at = HeldAt(0.0, 0.0, 0.0, 0.0)
        self._table = table
        self._parts = parts

    def reset(self) -> None:
        """Start again at neutral with open, empty fingers (a rebuilt world)."""
        self.touching = False
        self.held = None
        self.arm.jump(tool_in_scene(self.frame, self.home.neutral))
        self.gripper.grip(GRIPPER.max_opening_m)

    def advance(self, duration_s: float, blocker: Blocker | None) -> None:
        """Go on with what is under way."""
        if self.arm.moving:
            self.touching = self.arm.advance(duration_s, blocker)
        self._advance_gripper(duration_s)
        if self.held is not None:
            self.held.pose = self.pose_in_fingers(self._held_at)

    def contact_force(self) -> NDArray[np.float64]:
        """What whoever stands in the way holds against the arm's motion (3, N, base frame)."""
        force = np.zeros(3)
        if self.touching and self.arm.target is not None:
            tool = tool_in_base(self.frame, self.arm.pose)
            target = tool_in_base(self.frame, self.arm.target)
            way = np.array([target.x - tool.x, target.y - tool.y, target.z - tool.z])
            force = -PUSH_N * way / max(float(np.linalg.norm(way)), 1e-6)
        return force

    def lose_held(self) -> None:
        """What the fingers hold is taken from between them; nobody has it for a moment."""
        self.held = None
        self.gripper.snap_shut()

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

    def held_out_to_it(self, part: TablePart) -> UprightPose | None:
        """Where somebody holds a part out so that the fingers can close on it.

        None unless they are open for it, and at rest.
        """
        box = part.grasp_box
        at = HeldAt(0.0, 0.0, -(box.low + box.high) / 2, -box.thin_yaw)
        width_m = 2 * box.half_width(-at.yaw)
        fits = width_m <= self.gripper.opening_m <= GRIPPER.max_opening_m
        waits = fits and self.held is None and not self.arm.moving
        return self.pose_in_fingers(at) if waits else None

    def off_hand_over_m(self) -> float:
        """How far the tool is from where it takes what people hold out."""
        there, tool = tool_in_scene(self.frame, self.home.hand_over), self.arm.pose
        return math.dist((there.x, there.y, there.z), (tool.x, tool.y, tool.z))

    def _drop_held(self) -> None:
        """The fingers let go: the part falls onto what is below it."""
        if self.held is None:
            return
        part, self.held = self.held, None
        part.give_to(Whereabouts.RESTING)
        part.pose = on_top(part, self._parts.values(), self._table)
        settle(self._parts.values(), self._table)
        part.last_rest = part.pose

    def _advance_gripper(self, duration_s: float) -> None:
        if not self.gripper.moving:
            return
        if self.gripper.opening:
            self._drop_held()
        elif self.held is not None:
            self.gripper.grip(self.gripper.opening_m)
            return
        closing = self.gripper.closing
        self.gripper.advance(duration_s)
        if closing:
            self._grip()

    def _grip(self) -> None:
        """Take what is between the closing fingers once they touch it; they centre it."""
        for part in self._parts.values():
            at = self._between_fingers(part)
            if at is None:
                continue
            width = 2 * part.grasp_box.half_width(-at.yaw)
            if self.gripper.opening_m <= width:
                part.give_to(Whereabouts.HELD)
                self.held = part
                self._held_at = replace(at, along=0.0)
                self.gripper.grip(width)
                return

    def _between_fingers(self, part: TablePart) -> HeldAt | None:
        """Where a part is between open fingers; None if they do not go around it."""
        if part.whereabouts in (Whereabouts.GONE, Whereabouts.HELD) or not part.shown:
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
