"""The arm goes where it is told, as fast as it is told, and stops at once."""

import math
from dataclasses import replace

import numpy as np
import pytest
from workcell_hands import TABLE_M, Hands

from mend.robots.arm.arm import Arm
from mend.robots.arm.behaviors.contact import Track
from mend.robots.arm.body import ToolPose
from mend.sim.workcell.world import WorkcellWorld

HIGH = ToolPose(0.50, -0.35, TABLE_M + 0.25, 0.3)
LOW = ToolPose(0.50, -0.35, TABLE_M + 0.15, 0.3)
FAR_LEFT = ToolPose(0.50, 0.10, TABLE_M + 0.25, -0.3)


def test_the_tool_reaches_every_waypoint(hands: Hands) -> None:
    path = hands.plan(HIGH, LOW, HIGH, FAR_LEFT)
    for segment, waypoint in enumerate((HIGH, LOW, HIGH, FAR_LEFT)):
        hands.follow(path, segment, 1.0)
        tool = hands.body.tool_pose()
        assert np.allclose(tool[:3, 3], (waypoint.x, waypoint.y, waypoint.z), atol=5e-4)
        assert np.allclose(tool[:3, 0], (0, 0, -1), atol=2e-3)
        yaw = math.atan2(tool[1, 1], tool[0, 1])
        assert abs(math.remainder(yaw - waypoint.yaw, math.pi)) < 5e-3


def test_waypoints_above_each_other_are_joined_by_a_straight_line(hands: Hands) -> None:
    path = hands.plan(HIGH, LOW)
    hands.follow(path, 0, 1.0)
    strays = []

    def measure() -> bool:
        tool = hands.body.tool_pose()
        strays.append(math.hypot(tool[0, 3] - HIGH.x, tool[1, 3] - HIGH.y))
        return False

    hands.follow(path, 1, 1.0, measure)
    assert len(strays) > 50
    assert max(strays) < 0.0015


def test_what_is_too_far_away_has_no_path(hands: Hands) -> None:
    assert hands.body.plan_path([HIGH, ToolPose(1.1, 0.2, TABLE_M + 0.1, 0.0)]) is None


@pytest.mark.parametrize(("distance_m", "found"), [(0.40, True), (0.74, True), (0.82, False)])
def test_the_arm_grasps_in_a_ring_around_its_shoulder(
    hands: Hands, distance_m: float, found: bool
) -> None:
    reach = hands.body.reach
    assert (reach.min_m <= distance_m <= reach.max_m) is found
    for angle in (-0.5, 0.0, 0.35):
        for yaw in (-1.2, 0.0, 1.2):
            x = reach.origin[0] + distance_m * math.cos(angle)
            y = reach.origin[1] + distance_m * math.sin(angle)
            up, down = (ToolPose(x, y, TABLE_M + z, yaw) for z in (0.16, 0.025))
            path = hands.body.plan_path([up, down, up])
            assert (path is not None) is found, (angle, distance_m, yaw)


def test_the_arm_stops_within_one_control_cycle(hands: Hands) -> None:
    path = hands.plan(HIGH)
    hands.follow(path, 0, 1.0, lambda: hands.body.progress > 0.5)
    before = hands.body.tool_pose()[:3, 3]
    hands.body.advance_cycle()
    speed_m_s = np.linalg.norm(hands.body.tool_pose()[:3, 3] - before) * 240
    assert speed_m_s > 0.3
    at_stop = hands.body.tool_pose()[:3, 3]
    hands.body.stop()
    assert not hands.body.moving
    for _ in range(20):
        hands.body.advance_cycle()
        assert np.linalg.norm(hands.body.tool_pose()[:3, 3] - at_stop) < 2e-4


def test_a_stopped_segment_can_be_followed_to_its_end(hands: Hands) -> None:
    path = hands.plan(HIGH, LOW)
    hands.follow(path, 0, 1.0)
    hands.follow(path, 1, 1.0, lambda: hands.body.progress > 0.5)
    hands.body.stop()
    hands.wait(0.1)
    hands.follow(path, 1, 1.0)
    assert np.allclose(hands.body.tool_pose()[:3, 3], (LOW.x, LOW.y, LOW.z), atol=5e-4)


@pytest.mark.parametrize("yaw", [-1.4, 0.0, 1.4])
def test_what_was_met_on_the_way_is_left_as_it_was_come_to(hands: Hands, yaw: float) -> None:
    """A hand that turned on its way back would wedge what it holds against what it met."""
    path, track, arm = hands.plan(HIGH, replace(FAR_LEFT, yaw=yaw)), Track(), Arm(hands.body)
    hands.follow(path, 0, 1.0)
    came = []

    def note() -> bool:
        pose = arm.tool_pose()
        track.note(pose)
        came.append(pose)
        return hands.body.progress > 0.6

    hands.follow(path, 1, 1.0, note)
    hands.body.stop()
    back = hands.body.plan_back(track.way_back())
    assert back is not None
    begin = arm.tool_pose()

    def check() -> bool:
        here = arm.tool_pose()
        assert min(apart(here, pose) for pose in came) < 0.01
        return False

    for segment in range(back.segments):
        hands.follow(back, segment, 0.3, check)
    assert 0.1 <= apart(arm.tool_pose(), begin) < 0.15


def apart(one: ToolPose, other: ToolPose) -> float:
    """In metres, with 0.1 m for a radian."""
    turn = 0.1 * math.remainder(one.yaw - other.yaw, 2 * math.pi)
    return math.hypot(one.x - other.x, one.y - other.y, one.z - other.z, turn)


def test_half_speed_takes_about_twice_as_long(hands: Hands) -> None:
    path = hands.plan(HIGH, FAR_LEFT, HIGH)
    hands.follow(path, 0, 1.0)
    durations = []
    for segment, speed in ((1, 1.0), (2, 0.5)):
        begin = hands.body.time_s()
        hands.follow(path, segment, speed)
        durations.append(hands.body.time_s() - begin)
    assert 1.4 < durations[1] / durations[0] < 2.1


def test_a_motion_is_slowed_down_while_it_is_under_way(hands: Hands) -> None:
    path = hands.plan(HIGH)
    hands.follow(path, 0, 1.0, lambda: hands.body.progress > 0.4)
    hands.body.set_speed(0.1)
    hands.wait(0.5)
    before = hands.body.progress
    hands.wait(0.2)
    assert hands.body.moving
    assert 0.0 < hands.body.progress - before < 0.05


def test_progress_rises_from_0_to_1(hands: Hands) -> None:
    assert hands.body.progress == 1.0
    hands.body.follow(hands.plan(HIGH), 0, 1.0)
    seen = [hands.body.progress]
    while hands.body.moving:
        hands.body.advance_cycle()
        seen.append(hands.body.progress)
    assert seen[0] == 0.0
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


def test_an_arm_at_neutral_hides_no_part_from_the_head(world: WorkcellWorld) -> None:
    _, rendering = world.head.capture_with_bodies()
    for part in world.parts.values():
        assert (rendering.bodies == part.body_id).sum() > 100


@pytest.mark.slow
def test_an_arm_that_is_held_up_gives_up_after_a_while_and_stays(hands: Hands) -> None:
    into_the_table = replace(FAR_LEFT, z=TABLE_M - 0.10)
    path = hands.plan(FAR_LEFT, into_the_table)
    hands.follow(path, 0, 1.0)
    hands.follow(path, 1, 0.3)
    stuck = hands.body.tool_pose()[:3, 3]
    assert stuck[2] == pytest.approx(TABLE_M, abs=0.03)
    hands.wait(0.5)
    assert np.linalg.norm(hands.body.tool_pose()[:3, 3] - stuck) < 0.01
    hands.follow(hands.plan(FAR_LEFT), 0, 0.5)
    assert hands.body.tool_pose()[2, 3] == pytest.approx(FAR_LEFT.z, abs=1e-3)


def test_another_bodys_path_is_refused(hands: Hands) -> None:
    class Foreign:
        segments = 1

    with pytest.raises(TypeError, match="planned itself"):
        hands.body.follow(Foreign(), 0, 1.0)
