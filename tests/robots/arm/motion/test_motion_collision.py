"""Collisions of an arm with boxes, and paths that keep away from them."""

import math

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from mend.robots.arm.behaviors.legs import table_box
from mend.robots.arm.body import HeldBox, NoWay, ToolPose
from mend.robots.arm.motion.collision import CollisionModel, HandPosture, Margins
from mend.robots.arm.motion.kinematics import Joints, KinematicChain
from mend.robots.arm.motion.obstacles import PathObstacles, samples
from mend.robots.arm.motion.planner import JointPath, PathPlanner
from mend.robots.vision.seen_box import SeenBox
from mend.sim.workcell.gripper import finger_angle_rad
from mend.sim.workcell.robot_model import (
    ARM_JOINTS,
    FINGER_JOINTS,
    NEUTRAL_RAD,
    PREFERRED_RAD,
    TOOL_FRAME,
    robot_urdf,
)
from mend.tasks.scene import Table

START = np.array(NEUTRAL_RAD)
PICK, PLACE = ToolPose(0.5, -0.45, 0.75, 0.0), ToolPose(0.55, 0.0, 0.75, 0.0)
LIFT_M = 0.10


@pytest.fixture(scope="module")
def chain() -> KinematicChain:
    return KinematicChain(robot_urdf(), TOOL_FRAME, ARM_JOINTS)


@pytest.fixture(scope="module")
def arm() -> CollisionModel:
    return CollisionModel(robot_urdf(), ARM_JOINTS, TOOL_FRAME)


def hand(opening_m: float, *held: HeldBox) -> HandPosture:
    return HandPosture(dict.fromkeys(FINGER_JOINTS, finger_angle_rad(opening_m)), held)


def box(x: float, y: float, size: tuple[float, float, float], name: str = "box") -> SeenBox:
    return SeenBox(x, y, 0.0, size, 0.7, name, complete=True)


def touching(_: SeenBox) -> Margins:
    return Margins(0.0, 0.0)


def over(pose: ToolPose) -> ToolPose:
    return ToolPose(pose.x, pose.y, pose.z + LIFT_M, pose.yaw)


def plan(arm: CollisionModel, chain: KinematicChain, *boxes: SeenBox) -> JointPath | NoWay:
    waypoints = [over(PICK), PICK, over(PICK), over(PLACE), PLACE]
    obstacles = PathObstacles(arm, boxes, [hand(0.04)] * len(waypoints), START)
    planner = PathPlanner(chain, np.array(PREFERRED_RAD))
    return planner.plan(START, waypoints, np.random.default_rng(0), obstacles)


@pytest.fixture(scope="module")
def at_pick(arm: CollisionModel, chain: KinematicChain) -> Joints:
    """With the fingers around what is picked."""
    path = plan(arm, chain)
    assert isinstance(path, JointPath)
    return path.ways[1].curve.end


def test_what_the_fingers_go_around_is_not_touched_until_they_close(
    arm: CollisionModel, at_pick: Joints
) -> None:
    between = box(PICK.x, PICK.y, (0.03, 0.05, 0.06))
    assert arm.among([between], hand(0.04), touching).hit(at_pick) is None
    assert arm.among([between], hand(0.02), touching).hit(at_pick) == between
    aside = box(PICK.x + 0.04, PICK.y, (0.03, 0.05, 0.06))
    assert arm.among([between, aside], hand(0.04), touching).hit(at_pick) == aside


def test_the_gripper_may_go_where_the_arm_keeps_away(arm: CollisionModel, at_pick: Joints) -> None:
    between = box(PICK.x, PICK.y, (0.03, 0.05, 0.06))
    for margins, hit in ((Margins(0.0, 0.01), between), (Margins(0.01, 0.0), None)):
        found = arm.among([between], hand(0.04), lambda _, each=margins: each).hit(at_pick)
        assert found == hit


def test_what_is_held_is_part_of_the_arm(arm: CollisionModel, chain: KinematicChain) -> None:
    path = plan(arm, chain)
    assert isinstance(path, JointPath)
    above = path.ways[0].curve.end
    below = box(PICK.x, PICK.y, (0.05, 0.05, 0.08))
    long = HeldBox((0.1, 0.02, 0.02), np.eye(4))
    assert arm.among([below], hand(0.02), touching).hit(above) is None
    hanging = HeldBox((0.16, 0.02, 0.02), np.eye(4))
    assert arm.among([below], hand(0.02, long), touching).hit(above) is None
    assert arm.among([below], hand(0.02, hanging), touching).hit(above) == below


def test_a_path_goes_around_or_over_what_stands_there(
    arm: CollisionModel, chain: KinematicChain
) -> None:
    posts = [
        box(0.55 - 0.15 * math.cos(a), -0.22 + 0.1 * math.sin(a), (0.04, 0.04, 0.12))
        for a in np.linspace(0.0, 3.0, 4)
    ]
    path = plan(arm, chain, *posts)
    assert isinstance(path, JointPath)
    around = arm.among(posts, hand(0.04), touching)
    assert all(around.hit(joints) is None for way in path.ways for joints in samples(way.curve))


@pytest.mark.parametrize("seed", range(4))
def test_where_every_straight_way_touches_something_one_around_it_is_found(
    arm: CollisionModel, chain: KinematicChain, seed: int
) -> None:
    x, y = np.random.default_rng(seed).uniform((0.5, -0.26), (0.56, -0.2))
    tower = box(float(x), float(y), (0.05, 0.05, 0.2))
    boxes = [tower, table_box(Table())]
    path = plan(arm, chain, *boxes)
    assert isinstance(path, JointPath)
    around = arm.among(boxes, hand(0.04), touching)
    for number, way in enumerate(path.ways):
        for joints in samples(way.curve):
            assert around.hit(joints) is None
            assert number == 0 or chain.pose(joints)[2, 0] < -0.6
    for way, waypoint in zip(
        path.ways, (over(PICK), PICK, over(PICK), over(PLACE), PLACE), strict=True
    ):
        end = chain.pose(way.curve.end)[:3, 3]
        assert np.allclose(end, (waypoint.x, waypoint.y, waypoint.z), atol=2e-4)


@pytest.mark.parametrize("seed", range(3))
def test_a_link_is_touched_up_to_its_hull(arm: CollisionModel, seed: int) -> None:
    """Of the forearm's mesh only a part of the points are corners of its hull."""
    mesh = robot_urdf().parent / "meshes" / "forearm_v0" / "forearm.stl"
    triangles = np.frombuffer(
        mesh.read_bytes()[84:], np.dtype([("n", "<3f4"), ("v", "<9f4"), ("a", "<u2")])
    )
    hull = ConvexHull(triangles["v"].reshape(-1, 3).astype(float))
    joints = np.array(PREFERRED_RAD)
    roll = KinematicChain(robot_urdf(), "r_forearm_link", ARM_JOINTS[:5]).pose(joints[:5])
    rng = np.random.default_rng(seed)
    for _ in range(100):
        inside = rng.dirichlet(np.ones(3)) @ hull.points[rng.choice(hull.vertices, 3)]
        x, y, z = (float(each) for each in roll[:3, :3] @ inside + roll[:3, 3])
        crumb = SeenBox(x, y, 0.0, (0.002, 0.002, 0.002), z - 0.001, "crumb", complete=True)
        assert arm.among([crumb], hand(0.04), touching).hit(joints) == crumb


@pytest.mark.parametrize("seed", range(6))
def test_what_was_asked_before_changes_nothing(arm: CollisionModel, seed: int) -> None:
    rng = np.random.default_rng(seed)
    boxes = [
        box(*rng.uniform((0.4, -0.6), (0.75, 0.2)), tuple(rng.uniform(0.012, 0.1, 3)))
        for _ in range(20)
    ]
    around = arm.among(boxes, hand(0.04), touching)
    start = np.array(PREFERRED_RAD) + rng.normal(0.0, 0.2, len(PREFERRED_RAD))
    way = rng.normal(0.0, 0.4, len(PREFERRED_RAD))
    for share in np.linspace(0.0, 1.0, 40):
        joints = start + share * way
        afresh = arm.among(boxes, hand(0.04), touching).hit(joints)
        assert (around.hit(joints) is None) is (afresh is None)


def test_what_is_near_or_touched_at_the_beginning_is_not_gone_through_later(
    arm: CollisionModel, chain: KinematicChain, at_pick: Joints
) -> None:
    start = at_pick
    beside = box(PICK.x + 0.04, PICK.y, (0.03, 0.05, 0.06), "vase")
    hands = [hand(0.04)] * 2
    planner = PathPlanner(chain, np.array(PREFERRED_RAD))
    rng = np.random.default_rng(0)
    assert arm.among([beside], hands[0], touching).hit(start) == beside
    obstacles = PathObstacles(arm, [beside], hands, start)
    away = planner.plan(start, [over(PICK)], rng, obstacles)
    assert isinstance(away, JointPath)
    back = planner.plan(start, [over(PICK), PICK], rng, obstacles)
    assert back == NoWay("would touch vase on the way", beside)


def not_touched_beside(arm: CollisionModel, joints: Joints) -> SeenBox:
    """A box 1 mm beside the gripper, or a little more."""
    boxes = (
        box(PICK.x + off_m, PICK.y, (0.03, 0.05, 0.06)) for off_m in np.arange(0.02, 0.15, 0.001)
    )
    *_, last = (each for each in boxes if arm.among([each], hand(0.04), touching).hit(joints))
    return box(last.x + 0.002, last.y, last.size)


def test_what_is_near_at_the_beginning_is_kept_away_from_less(
    arm: CollisionModel, at_pick: Joints
) -> None:
    beside = not_touched_beside(arm, at_pick)
    hands = [hand(0.04)] * 2
    from_elsewhere = PathObstacles(arm, [beside], hands, START)
    from_there = PathObstacles(arm, [beside], hands, at_pick)
    for number in range(len(hands)):
        assert not from_elsewhere.is_free(number, at_pick)
        assert from_there.is_free(number, at_pick)


def test_only_the_first_segment_leaves_out_what_is_touched_at_the_beginning(
    arm: CollisionModel, at_pick: Joints
) -> None:
    touched = box(PICK.x + 0.04, PICK.y, (0.03, 0.05, 0.06))
    obstacles = PathObstacles(arm, [touched], [hand(0.04)] * 2, at_pick)
    assert obstacles.is_free(0, at_pick)
    assert not obstacles.is_free(1, at_pick)


def test_what_no_path_keeps_away_from_is_named(arm: CollisionModel, chain: KinematicChain) -> None:
    vase = box(PLACE.x, PLACE.y, (0.1, 0.1, 0.2), "vase")
    assert plan(arm, chain, vase) == NoWay("would touch vase on the way", vase)
