"""Freeing the gripper: what it holds goes where it does no harm."""

import math

from robots.arm import Arm, Routine
from robots.body import ToolPose
from robots.catalogue import Part
from robots.grasp import RELEASE_CLEARANCE_M, grasp_of
from robots.senses import Senses

_FREE_RADIUS_M = 0.15
"""Nothing else may be this near to where something is put down."""
_SPEED = 0.4
_LIFT_M = 0.14
"""How far above where it is put down the tool point comes from."""


def put_down(arm: Arm, senses: Senses, picked_at: ToolPose | None) -> Routine[None]:
    """Open the gripper; first take what it holds to where it was picked, or straight down.

    `picked_at` is the tool pose at which it was picked up, None if a person handed it over.
    """
    if senses.holds():
        yield from arm.lift()
        for waypoints in _ways_down(arm, senses, picked_at):
            path = arm.body.plan_path(waypoints)
            if path is not None:
                yield from arm.follow(path, _SPEED)
                break
    senses.let_go()
    yield from arm.open_gripper()


def _ways_down(arm: Arm, senses: Senses, picked_at: ToolPose | None) -> list[list[ToolPose]]:
    """Where what is held can be put down, the best first."""
    ways = []
    if picked_at is not None:
        x, y, z, yaw = picked_at.x, picked_at.y, picked_at.z, picked_at.yaw
        ways.append([ToolPose(x, y, z + _LIFT_M, yaw), picked_at])
    pose, grip = arm.tool_pose(), senses.grip
    if pose is not None and grip is not None and _is_free_below(senses, pose, grip.part):
        height_m = grasp_of(grip.part, arm.body.gripper).height_m + RELEASE_CLEARANCE_M
        table_z = senses.catalogue.table.height
        ways.append([ToolPose(pose.x, pose.y, table_z + height_m, pose.yaw)])
    return ways


def _is_free_below(senses: Senses, pose: ToolPose, held: Part) -> bool:
    others = senses.sight_all(senses.look())
    return all(
        name == held.name or math.hypot(each.x - pose.x, each.y - pose.y) > _FREE_RADIUS_M
        for name, each in others.items()
    )
