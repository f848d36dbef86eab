"""Which ways the workcell's arm can go, by the planner that it uses, without a world."""

from collections.abc import Sequence
from functools import cache, lru_cache

import numpy as np

from robots.body import Leg, NoWay, ToolPose
from robots.motion.collision import CollisionModel, Hand
from robots.motion.kinematics import KinematicChain
from robots.motion.obstacles import PathObstacles
from robots.motion.planner import JointPath, PathPlanner
from robots.vision.seen_box import SeenBox
from sim.workcell.gripper import finger_angle_rad
from sim.workcell.robot_model import (
    ARM_JOINTS,
    FINGER_JOINTS,
    NEUTRAL_RAD,
    PREFERRED_RAD,
    TOOL_FRAME,
    robot_urdf,
)

_SEED = 0
_TRIES = 5
"""A way around things is found by chance: what several searches do not find, is not there."""


def no_way(legs: Sequence[Leg], boxes: Sequence[SeenBox]) -> NoWay | None:
    """Why the arm cannot go from neutral through all legs amid boxes; None where it can."""
    if not boxes:
        return _out_of_reach(tuple(leg.to for leg in legs))
    start = np.array(NEUTRAL_RAD)
    obstacles = PathObstacles.around(_collisions(), boxes, [hand_on(leg) for leg in legs], start)
    found: JointPath | NoWay = NoWay("does not go there")
    for rng in np.random.default_rng(_SEED).spawn(_TRIES):
        found = _planner().plan(start, [leg.to for leg in legs], rng, obstacles)
        if isinstance(found, JointPath):
            return None
        if found.touched is None:
            break
    return found if isinstance(found, NoWay) else None


def hand_on(leg: Leg) -> Hand:
    """The gripper's joints on a leg, and what it holds."""
    angle_rad = finger_angle_rad(leg.opening_m)
    return Hand(dict.fromkeys(FINGER_JOINTS, angle_rad), leg.held)


@lru_cache(maxsize=4096)
def _out_of_reach(way: tuple[ToolPose, ...]) -> NoWay | None:
    found = _planner().plan(np.array(NEUTRAL_RAD), way, np.random.default_rng(_SEED))
    return None if isinstance(found, JointPath) else found


@cache
def _planner() -> PathPlanner:
    chain = KinematicChain(robot_urdf(), TOOL_FRAME, ARM_JOINTS)
    return PathPlanner(chain, np.array(PREFERRED_RAD))


@cache
def _collisions() -> CollisionModel:
    return CollisionModel(robot_urdf(), ARM_JOINTS, TOOL_FRAME)
