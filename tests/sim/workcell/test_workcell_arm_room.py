"""The room that a PR2 says it takes holds all of its arm, on every way that it plans."""

import math

import numpy as np
import pytest
import shapely

from mend.robots.arm.body import Leg, ToolPose
from mend.robots.arm.motion.curve import JointCurve
from mend.robots.arm.motion.kinematics import KinematicChain
from mend.robots.arm.motion.planner import JointPath
from mend.robots.arm.shared_space import home, leaf_space
from mend.robots.vision.seen_box import SeenBox
from mend.sim.workcell.arm_planner import neutral_arm
from mend.sim.workcell.finger_hulls import drawn_hull
from mend.sim.workcell.reach import ARM_ROOM, pr2_reach
from mend.sim.workcell.robot_model import ARM_JOINTS, NEUTRAL_RAD, robot_urdf
from mend.tasks.frames import Frame

pytestmark = pytest.mark.slow

TABLE = SeenBox(0.75, 0.0, 0.0, (0.9, 1.6, 0.02), 0.68, "table", complete=True)
LINKS = {
    "r_shoulder_pan_link": 1,
    "r_upper_arm_link": 3,
    "r_elbow_flex_link": 4,
    "r_forearm_link": 5,
    "r_wrist_roll_link": 7,
    "r_gripper_palm_link": 7,
}


def spot(rng: np.random.Generator) -> tuple[float, float]:
    reach = pr2_reach()
    while True:
        x, y = float(rng.uniform(0.30, 0.80)), float(rng.uniform(-0.90, 0.45))
        if 0.34 <= math.dist((x, y), reach.origin) <= 0.76:
            return x, y


def legs(
    rng: np.random.Generator, start: tuple[float, float], end: tuple[float, float]
) -> list[Leg]:
    found = []
    for x, y in (start, end):
        yaw = float(rng.uniform(-math.pi, math.pi))
        found += [Leg(ToolPose(x, y, z, yaw), 0.06) for z in (0.90, 0.75, 0.90)]
    return found


def test_no_corner_of_the_arm_leaves_it() -> None:
    rng = np.random.default_rng(5)
    chains = [
        (drawn_hull(robot_urdf(), link), KinematicChain(robot_urdf(), link, ARM_JOINTS[:count]))
        for link, count in LINKS.items()
    ]
    neutral = np.array(NEUTRAL_RAD)

    def outside(space: shapely.Geometry, joints: np.ndarray) -> bool:
        for corners, chain in chains:
            frame = chain.pose(joints[: len(chain.lower)])
            points = corners @ frame[:3, :3].T + frame[:3, 3]
            if not shapely.covers(space, shapely.MultiPoint(points[:, :2])):
                return True
        return False

    assert not outside(home(Frame(), ARM_ROOM), neutral)
    planned = 0
    while planned < 12:
        ends = [spot(rng), spot(rng)]
        path = neutral_arm().plan_among(legs(rng, *ends), [TABLE])
        if not isinstance(path, JointPath):
            continue
        planned += 1
        space = leaf_space(Frame(), ARM_ROOM, ends, None)
        curves = [way.curve for way in path.ways]
        for curve in [*curves, JointCurve([curves[-1].end, neutral])]:
            for parameter in np.linspace(0.0, curve.length, 12):
                assert not outside(space, curve.at(float(parameter))), ends
