"""Freeing the gripper: what it holds goes where it does no harm."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from mend.robots.arm.arm import Arm
from mend.robots.arm.behaviors.grasp_choice import MARGIN_M, others
from mend.robots.arm.behaviors.legs import held_boxes, table_box
from mend.robots.arm.body import ArmPath, Leg, NoWay, ToolPose
from mend.robots.arm.clearance import beside, in_the_way
from mend.robots.arm.grasp import RELEASE_CLEARANCE_M, Grasp
from mend.robots.arm.gripper import GripperModel
from mend.robots.arm.perception import Perception
from mend.robots.catalogue import Part
from mend.robots.execution.routine import Routine
from mend.robots.vision.seen_box import SeenBox
from mend.tasks.scene import Table

_SPEED = 0.4
_LIFT_M = 0.14
"""How far above where it is put down the tool point comes from."""

_SPACING_M = 0.05
_RINGS = 6
"""A free spot is looked for on so many rings around where the arm is, so far apart."""
_APART_M = 0.02
"""What is put down keeps so far away from everything else."""


def put_down(arm: Arm, perception: Perception, picked_at: ToolPose | None) -> Routine[None]:
    """Open the gripper; first take what it holds to where it was picked, or to a free spot.

    `picked_at` is the tool pose at which it was picked up, None if a person handed it over.
    """
    if not (yield from set_down(arm, perception, picked_at)):
        perception.let_go()
        yield from arm.open_gripper()


def set_down(arm: Arm, perception: Perception, picked_at: ToolPose | None) -> Routine[bool]:
    """Take what the gripper holds to where it was picked, or to a free spot, and let go of it.

    Whether that was done: without a way there it is still held.
    """
    grip = perception.hand.grip
    if grip is None or not perception.hand.holds():
        return False
    yield from arm.lift()
    path = _way_down(arm, perception, grip.part, grip.grasp, picked_at)
    if path is None:
        return False
    yield from arm.follow(path, _SPEED)
    perception.let_go()
    yield from arm.open_gripper(grip.grasp.opening_m)
    return True


def _way_down(
    arm: Arm, perception: Perception, part: Part, grasp: Grasp, picked_at: ToolPose | None
) -> ArmPath | None:
    """The path to the best spot that the arm can put something down at."""
    table = perception.catalogue.table
    boxes = others(part, perception.head.seen_boxes(perception.head.look()))
    spots = [] if picked_at is None else [picked_at]
    here = arm.tool_pose()
    if here is not None:
        spots += _free_spots(here, part, grasp, arm.body.gripper, boxes, table)
    held = held_boxes(part, grasp)
    for spot in spots:
        above = replace(spot, z=spot.z + _LIFT_M)
        legs = [Leg(each, grasp.width_m, held) for each in (above, spot)]
        path = arm.body.plan_among(legs, [table_box(table), *boxes])
        if not isinstance(path, NoWay):
            return path
    return None


def _free_spots(
    here: ToolPose,
    part: Part,
    grasp: Grasp,
    gripper: GripperModel,
    boxes: Sequence[SeenBox],
    table: Table,
) -> Iterator[ToolPose]:
    """Tool poses at which a part stands free on the table, the nearest first."""
    z = table.height + grasp.height_m + RELEASE_CLEARANCE_M
    for x, y in _rings(here.x, here.y):
        spot = ToolPose(x, y, z, here.yaw)
        stands = SeenBox(
            x, y, here.yaw - grasp.yaw, part.size, table.height, part.name, complete=True
        )
        if not all(table.is_under(float(px), float(py)) for px, py in stands.corners()):
            continue
        if beside(stands, boxes, _APART_M):
            continue
        blocked = in_the_way(
            gripper, spot, grasp.opening_m, boxes, MARGIN_M, closed_m=grasp.width_m
        )
        if blocked is None:
            yield spot


def _rings(x: float, y: float) -> Iterator[tuple[float, float]]:
    yield x, y
    for ring in range(1, _RINGS + 1):
        for number in range(6 * ring):
            angle = math.tau * number / (6 * ring)
            yield x + ring * _SPACING_M * math.cos(angle), y + ring * _SPACING_M * math.sin(angle)
