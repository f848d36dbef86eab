"""Which ways the workcell's arm can go, by the planner that it uses, without a world."""

from collections.abc import Sequence
from functools import cache, lru_cache

import numpy as np

from robots.body import ToolPose
from robots.motion.kinematics import KinematicChain
from robots.motion.planner import JointPath, PathPlanner
from sim.workcell.robot_model import (
    ARM_JOINTS,
    NEUTRAL_RAD,
    PREFERRED_RAD,
    TOOL_FRAME,
    robot_urdf,
)

_SEED = 0


def reachable(way: Sequence[ToolPose]) -> bool:
    """Whether the arm can go from neutral through all these poses."""
    return _reachable(tuple(way))


@lru_cache(maxsize=4096)
def _reachable(way: tuple[ToolPose, ...]) -> bool:
    rng = np.random.default_rng(_SEED)
    return isinstance(_planner().plan(np.array(NEUTRAL_RAD), way, rng), JointPath)


@cache
def _planner() -> PathPlanner:
    chain = KinematicChain(robot_urdf(), TOOL_FRAME, ARM_JOINTS)
    return PathPlanner(chain, np.array(PREFERRED_RAD))
