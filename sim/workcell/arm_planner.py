"""The one planner of the workcell's arm: for its body, and for checks without a world."""

import zlib
from collections.abc import Sequence
from functools import cache

import numpy as np

from mend.robots.arm.body import ArmPath, Leg, NoWay
from mend.robots.arm.gripper import GripperModel
from mend.robots.arm.motion.collision import CollisionModel, HandPosture
from mend.robots.arm.motion.kinematics import Joints, KinematicChain
from mend.robots.arm.motion.obstacles import PathObstacles
from mend.robots.arm.motion.planner import JointPath, PathPlanner
from mend.robots.vision.seen_box import SeenBox
from mend.sim.workcell.gripper import PR2_GRIPPER, finger_angle_rad
from mend.sim.workcell.robot_model import (
    ARM_JOINTS,
    FINGER_JOINTS,
    NEUTRAL_RAD,
    PREFERRED_RAD,
    TOOL_FRAME,
    robot_urdf,
)


def plan_legs(
    planner: PathPlanner,
    collisions: CollisionModel,
    start: Joints,
    legs: Sequence[Leg],
    boxes: Sequence[SeenBox],
    rng: np.random.Generator,
) -> JointPath | NoWay:
    """Plan from `start` through all legs so that nothing touches any of `boxes`."""
    hands = [_hand(leg) for leg in legs]
    obstacles = PathObstacles(collisions, boxes, hands, start)
    return planner.plan(start, [leg.to for leg in legs], rng, obstacles)


class NeutralArm:
    """The arm at neutral, as one is whenever a leaf begins; the same question has one answer."""

    def __init__(self) -> None:
        urdf = robot_urdf()
        chain = KinematicChain(urdf, TOOL_FRAME, ARM_JOINTS)
        self._planner = PathPlanner(chain, np.array(PREFERRED_RAD))
        self._collisions = CollisionModel(urdf, ARM_JOINTS, TOOL_FRAME)

    @property
    def gripper(self) -> GripperModel:
        return PR2_GRIPPER

    def plan_among(self, legs: Sequence[Leg], boxes: Sequence[SeenBox]) -> ArmPath | NoWay:
        """Plan through all legs so that nothing touches any of `boxes`."""
        start = np.array(NEUTRAL_RAD)
        # By the way that is asked for: each way to grasp a part has a chance of its own.
        way = np.array([[leg.to.x, leg.to.y, leg.to.z, leg.to.yaw] for leg in legs])
        rng = np.random.default_rng(zlib.crc32(way.tobytes()))
        return plan_legs(self._planner, self._collisions, start, legs, boxes, rng)


@cache
def neutral_arm() -> NeutralArm:
    """The arm; made on the first call."""
    return NeutralArm()


def _hand(leg: Leg) -> HandPosture:
    """The gripper's joints on a leg, and what it holds."""
    angle_rad = finger_angle_rad(leg.opening_m)
    return HandPosture(dict.fromkeys(FINGER_JOINTS, angle_rad), leg.held)
