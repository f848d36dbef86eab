"""Plans go through all their waypoints, on one branch, or are not made."""

import math

import numpy as np
import pytest
from small_arm import small_arm

from mend.robots.arm.body import NoWay, ToolPose
from mend.robots.arm.motion.kinematics import KinematicChain
from mend.robots.arm.motion.planner import JointPath, PathPlanner, pose_matrix

START = np.array([0.0, 0.4, 1.2, 0.0, 0.9, 0.0])
ABOVE = ToolPose(0.55, 0.1, 0.45, 0.2)
BELOW = ToolPose(0.55, 0.1, 0.30, 0.2)
ASIDE = ToolPose(0.45, -0.3, 0.45, -0.3)


@pytest.fixture(scope="module")
def chain(tmp_path_factory: pytest.TempPathFactory) -> KinematicChain:
    arm = small_arm(tmp_path_factory.mktemp("urdf"))
    # Its tool points along z; planned are tools that point along x.
    arm._tail = arm._tail @ pose_matrix(ToolPose(0, 0, 0, 0)).T
    return arm


@pytest.fixture(scope="module")
def path(chain: KinematicChain) -> JointPath:
    found = PathPlanner(chain, START).plan(
        START, [ABOVE, BELOW, ABOVE, ASIDE], np.random.default_rng(0)
    )
    assert isinstance(found, JointPath)
    return found


def test_every_segment_ends_at_its_waypoint_and_begins_where_the_last_ended(
    chain: KinematicChain, path: JointPath
) -> None:
    assert path.segments == 4
    joints = START
    for way, waypoint in zip(path.ways, (ABOVE, BELOW, ABOVE, ASIDE), strict=True):
        assert np.allclose(way.curve.start, joints)
        joints = way.curve.end
        assert np.allclose(
            chain.pose(joints)[:3, 3], (waypoint.x, waypoint.y, waypoint.z), atol=2e-4
        )


def test_all_waypoints_are_at_their_yaw_or_all_turned_by_half_a_turn(
    chain: KinematicChain, path: JointPath
) -> None:
    turns = []
    for way, waypoint in zip(path.ways, (ABOVE, BELOW, ABOVE, ASIDE), strict=True):
        opening = chain.pose(way.curve.end)[:3, 1]
        turns.append(
            abs(math.remainder(math.atan2(opening[1], opening[0]) - waypoint.yaw, math.tau))
        )
    assert max(turns) - min(turns) < 2e-3
    assert min(abs(turns[0]), abs(turns[0] - math.pi)) < 2e-3


def test_a_vertical_way_is_straight(chain: KinematicChain, path: JointPath) -> None:
    assert [way.straight for way in path.ways] == [False, True, True, False]
    down = path.ways[1].curve
    assert down.length == pytest.approx(0.15, abs=1e-3)
    for parameter in np.linspace(0.0, down.length, 30):
        tool = chain.pose(down.at(float(parameter)))[:3, 3]
        assert math.hypot(tool[0] - ABOVE.x, tool[1] - ABOVE.y) < 5e-4
        assert tool[2] == pytest.approx(ABOVE.z - parameter, abs=5e-4)


def test_one_waypoint_out_of_reach_makes_the_whole_path_impossible(chain: KinematicChain) -> None:
    planner = PathPlanner(chain, START)
    too_far = ToolPose(1.6, 0.0, 0.3, 0.0)
    found = planner.plan(START, [ABOVE, too_far], np.random.default_rng(0))
    assert isinstance(found, NoWay)
    assert "does not reach" in found.reason


def test_the_same_generator_gives_the_same_path(chain: KinematicChain) -> None:
    planner = PathPlanner(chain, START)
    one, other = (
        planner.plan(START, [ABOVE, BELOW, ASIDE], np.random.default_rng(4)) for _ in range(2)
    )
    assert isinstance(one, JointPath)
    assert isinstance(other, JointPath)
    for way, same in zip(one.ways, other.ways, strict=True):
        assert np.array_equal(way.curve.end, same.curve.end)


def test_a_path_without_waypoints_is_refused(chain: KinematicChain) -> None:
    with pytest.raises(ValueError, match="at least one waypoint"):
        PathPlanner(chain, START).plan(START, [], np.random.default_rng(0))
