"""The legs of a way: what the gripper is like between the poses that steps move through."""

from collections.abc import Sequence

import numpy as np

from mend.robots.arm.behaviors.behavior import Move, SetGripper, Step
from mend.robots.arm.body import HeldBox, Leg
from mend.robots.arm.grasp import Grasp, part_in_tool
from mend.robots.arm.gripper import GripperModel
from mend.robots.catalogue import Part
from mend.robots.vision.seen_box import SeenBox
from mend.tasks.scene import Table

_LESS_M = 0.004
"""A held part is taken for so much smaller on every side: where it fits closely it may go."""


def legs_of(
    steps: Sequence[Step],
    part: Part | None,
    grasp: Grasp | None,
    gripper: GripperModel,
    *,
    carrying: bool,
) -> list[Leg]:
    """One leg for each step that moves the arm; `carrying`: the part is held from the start."""
    opening_m, held = gripper.max_opening_m, False
    if carrying and grasp is not None:
        opening_m, held = grasp.width_m, True
    in_hand = held_boxes(part, grasp) if part is not None and grasp is not None else []
    legs = []
    for step in steps:
        if isinstance(step.action, Move):
            if not held and step.action.opening_m is not None:
                opening_m = step.action.opening_m
            legs.append(Leg(step.action.to, opening_m, in_hand if held else ()))
        elif step.action == SetGripper("closed"):
            opening_m, held = (0.0 if grasp is None else grasp.width_m), True
        else:
            wanted_m = step.action.opening_m
            opening_m, held = (gripper.max_opening_m if wanted_m is None else wanted_m), False
    return legs


def held_boxes(part: Part, grasp: Grasp) -> list[HeldBox]:
    """A grasped part, a little smaller than it is."""
    in_tool = part_in_tool(grasp)
    found = []
    for bottom_m, size in part.boxes:
        middle = np.eye(4)
        middle[2, 3] = bottom_m + size[2] / 2
        x, y, z = (max(extent - 2 * _LESS_M, extent / 2) for extent in size)
        found.append(HeldBox((x, y, z), in_tool @ middle))
    return found


def table_box(table: Table) -> SeenBox:
    """The table as something to keep away from."""
    (x, y), (length, width) = table.center, table.size
    return SeenBox(x, y, 0.0, (length, width, table.height), 0.0, "the table", complete=True)
