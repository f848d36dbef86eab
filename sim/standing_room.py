"""The room that a part needs where it stands: its own, and that of the gripper around it.

Quick and rough, for drawing scenes; whether a robot can do them is for its world to check.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from robots.catalogue import Part
from robots.grasp import grasp_of
from sim.workcell.gripper import PR2_GRIPPER
from tasks.footprint import TOUCH_M, Footprint

_GAP_M = 0.010
"""Kept between what one site needs and what stands on another."""
_FINGER_M = 0.024
"""How much room a finger needs beside the part: its thickness, and the way that it opens."""
_FINGER_WIDTH_M = 0.026
_TIP_M = 0.014
"""How far the finger tips reach below the tool point."""
_HAND_M = (0.16, 0.06)
"""The hand above the fingers: along the direction in which they open, and across."""
_HAND_HEIGHT_M = 0.045
"""How far the hand is above the tool point."""


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
        wide = Footprint(
            self.ground.x,
            self.ground.y,
            self.ground.yaw,
            self.ground.length + 2 * (_GAP_M + TOUCH_M),
            self.ground.width + 2 * (_GAP_M + TOUCH_M),
        )
        return wide.overlaps(other.ground)


@dataclass(frozen=True, slots=True)
class Standing:
    """A part at rest: what it fills, and what the gripper fills that grasps or has placed it."""

    body: Solid
    gripper: Sequence[Solid]

    def hinders(self, other: "Standing") -> bool:
        """Whether the two parts, or either and the gripper at the other, have no room."""
        return (
            self.body.meets(other.body)
            or any(each.meets(other.body) for each in self.gripper)
            or any(each.meets(self.body) for each in other.gripper)
        )


def standing(part: Part, x: float, y: float, bottom_z: float, yaw: float) -> Standing:
    """A part that stands with its bottom centre at (x, y, bottom_z), base frame."""
    grasp = grasp_of(part, PR2_GRIPPER)
    tool_z = bottom_z + grasp.height_m
    across = yaw + grasp.yaw
    top = bottom_z + part.size[2] + (part.knob[2] if part.knob else 0.0)
    fingers = Footprint(x, y, across, grasp.width_m + 2 * _FINGER_M, _FINGER_WIDTH_M)
    return Standing(
        Solid(Footprint(x, y, yaw, part.size[0], part.size[1]), bottom_z, top),
        (
            Solid(fingers, tool_z - _TIP_M),
            Solid(Footprint(x, y, across, *_HAND_M), tool_z + _HAND_HEIGHT_M),
        ),
    )
