"""The room that a part needs where it stands: its own, and that of the gripper around it.

Quick and rough, for drawing scenes; whether a robot can do them is for its world to check.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from mend.robots.arm.grasp import grasps_of
from mend.robots.arm.gripper import ToolBox
from mend.robots.catalogue import Part
from mend.sim.workcell.gripper import PR2_GRIPPER
from mend.tasks.footprint import TOUCH_M, Footprint

_GAP_M = 0.003
"""Kept between what one site needs and what stands on another."""


@dataclass(frozen=True, slots=True)
class Solid:
    """An upright box: the ground under it, from which height on and up to which."""

    ground: Footprint
    low_m: float
    high_m: float = math.inf

    def meets(self, other: "Solid") -> bool:
        """Whether two come nearer to each other than `_GAP_M`, one beside the other."""
        if self.low_m >= other.high_m or other.low_m >= self.high_m:
            return False
        one, two = self.ground, other.ground
        room_m = one.radius_m + two.radius_m + 2 * (_GAP_M + TOUCH_M)
        if math.hypot(one.x - two.x, one.y - two.y) > room_m:
            return False
        wide = Footprint(
            self.ground.x,
            self.ground.y,
            self.ground.yaw,
            self.ground.length + 2 * (_GAP_M + TOUCH_M),
            self.ground.width + 2 * (_GAP_M + TOUCH_M),
        )
        return wide.overlaps(other.ground)


@dataclass(frozen=True, slots=True)
class RestingPart:
    """A part at rest: what it fills, and what the gripper fills that grasps or has placed it."""

    body: Solid
    gripper: Sequence[Solid]

    def hinders(self, other: "RestingPart") -> bool:
        """Whether the two parts, or either and the gripper at the other, have no room."""
        return (
            self.body.meets(other.body)
            or any(each.meets(other.body) for each in self.gripper)
            or any(each.meets(self.body) for each in other.gripper)
        )


def standing(part: Part, x: float, y: float, bottom_z: float, yaw: float) -> RestingPart:
    """A part that stands with its bottom centre at (x, y, bottom_z), base frame."""
    # The one that needs the least room; the others are there where they have room as well.
    grasp = max(grasps_of(part, PR2_GRIPPER), key=lambda each: (each.height_m, -each.opening_m))
    tool_z = bottom_z + grasp.height_m
    return RestingPart(
        Solid(Footprint(x, y, yaw, part.size[0], part.size[1]), bottom_z, bottom_z + part.height),
        [
            Solid(Footprint(x, y, yaw + grasp.yaw, length_m, width_m), tool_z + bottom_m)
            for bottom_m, length_m, width_m in _levels(PR2_GRIPPER.boxes(grasp.opening_m))
        ],
    )


def _levels(boxes: Sequence[ToolBox]) -> list[tuple[float, float, float]]:
    """From each height up, the extents of all boxes that begin there, with what is between them.

    Nothing but the part itself finds room between the two fingers.
    """
    extents: dict[float, tuple[float, float]] = {}
    for box in boxes:
        length_m, width_m = extents.get(box.bottom_m, (0.0, 0.0))
        extents[box.bottom_m] = (
            max(length_m, 2 * abs(box.along_m) + box.length_m),
            max(width_m, 2 * abs(box.aside_m) + box.width_m),
        )
    return [(bottom_m, *extent) for bottom_m, extent in sorted(extents.items())]
