"""Looks: what is seen, and waiting until what was promised has come to be."""

import math
from dataclasses import replace

import numpy as np
import pytest
from drawn_scene import Resting
from robot_bench import RobotBench
from scripted_body import HAND_OVER, NEUTRAL, PLACES, STARTS

from mend.robots.arm.looks.expectation import AtPlace
from mend.robots.link.jpeg import read_jpeg
from mend.robots.link.messages import (
    Finished,
    FinishedResult,
    Holding,
    Interrupt,
    IssueDetected,
    Looked,
    Resume,
    Resumed,
)


def hold_with_issue(bench: RobotBench, name: str = "pink_bar") -> None:
    """Bring a robot to hold at neutral because the object is missing."""
    bench.body.vanish(name)
    bench.start(name)
    bench.run()
    assert bench.of(IssueDetected)[-1].issue == "missing"


def looked(bench: RobotBench) -> Looked:
    bench.run()
    return bench.of(Looked)[-1]


def test_a_plain_look_sees_all_and_says_where_the_gripper_is() -> None:
    bench = RobotBench()
    bench.look()
    seen = looked(bench)
    assert set(seen.objects) == set(STARTS)
    assert seen.fulfilled is None
    for name, where in STARTS.items():
        assert math.dist((seen.objects[name].x, seen.objects[name].y), (where.x, where.y)) < 0.003
    assert math.dist((seen.gripper.x, seen.gripper.y), (NEUTRAL.x, NEUTRAL.y)) < 0.001


def test_the_arm_clears_the_view_first() -> None:
    bench = RobotBench()
    bench.look(expect="in_gripper", object="pink_bar", within_s=1.0)
    bench.run()
    assert bench.body.tool != NEUTRAL
    bench.look()
    bench.run()
    assert bench.body.tool == NEUTRAL


def test_what_is_not_at_its_place_is_shown_with_where_it_is_and_is_to_be() -> None:
    bench = RobotBench()
    bench.look(expect="at_place", object="pink_bar", place="left", within_s=1.0)
    seen = looked(bench)
    assert seen.fulfilled is False
    assert seen.jpeg is not None
    assert read_jpeg(seen.jpeg)
    assert seen.detection is not None
    assert (seen.detection.camera, seen.detection.area_px > 0) == ("head", True)
    width_px, height_px = seen.detection.size_px or (0, 0)
    for point in (seen.detection.center, seen.detection.expected):
        assert point is not None
        assert 0 <= point[0] < width_px
        assert 0 <= point[1] < height_px
    assert seen.detection.center != seen.detection.expected
    assert (seen.detection.tolerance_px or 0.0) > 2.0


def test_of_what_is_so_no_picture_is_sent() -> None:
    bench = RobotBench()
    bench.look(expect="in_reach", object="pink_bar", within_s=2.0)
    seen = looked(bench)
    assert seen.fulfilled
    assert (seen.jpeg, seen.detection) == (None, None)


def test_what_is_not_held_out_is_shown_by_the_forearm_camera() -> None:
    bench = RobotBench()
    bench.look(expect="in_gripper", object="pink_bar", within_s=1.0)
    seen = looked(bench)
    assert seen.fulfilled is False
    assert seen.jpeg is not None
    assert seen.detection is not None
    assert seen.detection.camera == "forearm"


def test_what_comes_to_its_place_in_time_is_seen() -> None:
    bench = RobotBench()
    hold_with_issue(bench)
    asked_s = bench.robot.time_s()

    def place() -> None:
        if bench.robot.time_s() > asked_s + 1.7 and "pink_bar" not in bench.body.parts:
            bench.body.parts["pink_bar"] = type(STARTS["pink_bar"])(0.55, 0.05)

    bench.body.at_cycle = place
    bench.look(expect="at_place", object="pink_bar", place="left", within_s=10.0)
    seen = looked(bench)
    assert seen.fulfilled is True
    assert 1.7 < bench.robot.time_s() - asked_s < 2.6


def test_what_one_picture_alone_shows_is_not_believed(monkeypatch: pytest.MonkeyPatch) -> None:
    bench = RobotBench()
    pictures = iter([True])
    monkeypatch.setattr(AtPlace, "is_fulfilled", lambda _: next(pictures, False))
    bench.look(expect="at_place", object="pink_bar", place="left", within_s=1.0)
    assert looked(bench).fulfilled is False
    pictures = iter([True, True])
    bench.look(expect="at_place", object="pink_bar", place="left", within_s=1.0)
    assert looked(bench).fulfilled is True


def test_what_does_not_come_is_given_up_in_time() -> None:
    bench = RobotBench()
    hold_with_issue(bench)
    asked_s = bench.robot.time_s()
    bench.look(expect="at_place", object="pink_bar", place="left", within_s=3.2)
    assert looked(bench).fulfilled is False
    assert bench.robot.time_s() - asked_s == pytest.approx(3.2, abs=0.05)


def test_a_wrong_place_and_a_wrong_height_do_not_count() -> None:
    bench = RobotBench()
    resting = type(STARTS["pink_bar"])
    for x, z in ((0.58, 0.7), (0.55, 0.74)):
        bench.body.parts["pink_bar"] = resting(x, 0.05, z)
        bench.look(expect="at_place", object="pink_bar", place="left")
        assert looked(bench).fulfilled is False


def test_in_reach_waits_until_the_object_rests() -> None:
    bench = RobotBench()
    hold_with_issue(bench)
    resting = type(STARTS["pink_bar"])
    began_s = bench.robot.time_s()

    def carry() -> None:
        passed = bench.robot.time_s() - began_s
        bench.body.parts["pink_bar"] = resting(0.45, -0.5 + 0.1 * min(passed, 2.0))

    bench.body.at_cycle = carry
    bench.look(expect="in_reach", object="pink_bar", within_s=8.0)
    assert looked(bench).fulfilled is True
    assert bench.robot.time_s() - began_s > 2.0


def test_out_of_reach_is_not_in_reach() -> None:
    bench = RobotBench()
    bench.body.parts["pink_bar"].x = 0.95
    bench.look(expect="in_reach", object="pink_bar", within_s=1.5)
    assert looked(bench).fulfilled is False
    bench.body.parts["pink_bar"].x = 0.45


def test_what_the_arm_does_not_get_to_for_something_else_is_not_in_reach() -> None:
    bench = RobotBench()
    bench.body.bars = frozenset({"green_leg"})
    bench.look(expect="in_reach", object="pink_bar", within_s=1.5)
    assert looked(bench).fulfilled is False


def test_it_is_in_reach_once_that_has_moved() -> None:
    bench = RobotBench()
    bench.body.bars = frozenset({"green_leg"})
    began_s = bench.robot.time_s()

    def take_away() -> None:
        if bench.robot.time_s() > began_s + 2.0:
            bench.body.parts.pop("green_leg", None)

    bench.body.at_cycle = take_away
    bench.look(expect="in_reach", object="pink_bar", within_s=8.0)
    assert looked(bench).fulfilled is True
    assert bench.robot.time_s() - began_s > 2.0


def test_a_look_does_not_end_what_is_held() -> None:
    bench = RobotBench()
    hold_with_issue(bench)
    bench.body.parts["pink_bar"] = STARTS["pink_bar"]
    bench.look(expect="in_reach", object="pink_bar", within_s=5.0)
    assert looked(bench).fulfilled is True
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1")]


@pytest.mark.parametrize("name", ["pink_bar", "purple_top"])
def test_an_object_is_taken_from_a_person_and_placed(name: str) -> None:
    bench = RobotBench()
    hold_with_issue(bench, name)
    asked_s = bench.robot.time_s()

    def offer() -> None:
        late = bench.robot.time_s() > asked_s + 4.0
        if late and bench.body.in_hand is None and bench.body.held_out is None:
            bench.body.hold_out(name)

    bench.body.at_cycle = offer
    bench.look(expect="in_gripper", object=name, within_s=20.0)
    seen = looked(bench)
    assert seen.fulfilled is True
    assert bench.of(Holding)[-1] == Holding(execution="e1", at="hand_over")
    assert bench.robot.time_s() - asked_s > 4.0
    bench.body.at_cycle = lambda: None
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Resumed) == [Resumed(execution="e1", step=5)]
    assert bench.of(Finished) == [Finished(execution="e1")]
    where = bench.body.parts[name]
    assert math.dist((where.x, where.y), (0.55, 0.05)) < 0.004


def test_nothing_handed_over_is_given_up_with_the_gripper_open() -> None:
    bench = RobotBench()
    hold_with_issue(bench)
    bench.look(expect="in_gripper", object="pink_bar", within_s=6.0)
    assert looked(bench).fulfilled is False
    assert bench.body.tool.y == pytest.approx(HAND_OVER.y)
    assert bench.body.gripper_opening_m() > 0.05
    bench.look(expect="in_reach", object="green_leg", within_s=2.0)
    assert looked(bench).fulfilled is True
    assert bench.body.tool == NEUTRAL


def test_the_wrong_object_is_not_taken() -> None:
    bench = RobotBench()
    hold_with_issue(bench)
    bench.body.hold_out("green_leg")
    bench.look(expect="in_gripper", object="pink_bar", within_s=5.0)
    assert looked(bench).fulfilled is False
    assert bench.body.in_hand is None


def hide_the_hand(bench: RobotBench) -> None:
    """Let a piece of the gripper hide from the forearm camera all that is between the fingers."""
    corners = [(x, y, z) for x in (-0.2, -0.1) for y in (-0.2, 0.2) for z in (-0.2, 0.2)]
    bench.body.finger_hulls = lambda: [np.array(corners)]  # type: ignore[method-assign]


def test_a_part_that_the_fingers_hide_is_taken_by_closing_and_feeling() -> None:
    bench = RobotBench()
    hold_with_issue(bench)
    hide_the_hand(bench)
    bench.body.hold_out("pink_bar")
    bench.look(expect="in_gripper", object="pink_bar", within_s=20.0)
    assert looked(bench).fulfilled is True
    assert bench.body.in_hand is not None


def test_fingers_that_close_and_feel_nothing_open_again() -> None:
    bench = RobotBench()
    hold_with_issue(bench)
    hide_the_hand(bench)
    bench.look(expect="in_gripper", object="pink_bar", within_s=9.0)
    assert looked(bench).fulfilled is False
    assert bench.body.gripper_opening_m() > 0.05


def test_the_way_is_clear_once_nothing_pushes_or_stands_in_it() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(5, 0.5)
    bench.body.force_n = 250.0
    bench.run_until(IssueDetected)
    where = bench.body.tool
    bench.look(expect="way_clear", within_s=1.0)
    assert looked(bench).fulfilled is False
    bench.body.force_n = 0.0
    bench.look(expect="way_clear")
    assert looked(bench).fulfilled is True
    assert bench.body.tool == where
    bench.look(expect="way_clear", within_s=5.0)
    assert looked(bench).fulfilled is True
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Resumed) == [Resumed(execution="e1", step=5)]
    assert bench.kinds()[-1] == "finished"


def test_what_presses_along_the_way_that_is_left_is_not_in_it() -> None:
    """As the table does against a part that closing fingers have pressed down."""
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(4, 0.2)
    bench.body.force_n = 250.0
    bench.run_until(IssueDetected)
    for force_n, clear in ((30.0, False), (-30.0, True)):
        bench.body.force_n = force_n
        bench.look(expect="way_clear", within_s=1.0)
        assert looked(bench).fulfilled is clear


def held_up_by_a_wall(bench: RobotBench, until_s: float = math.inf) -> list[float]:
    """Bring a robot to hold before a wall that no camera sees; the speeds at which it is met."""
    met: list[float] = []

    def act() -> None:
        was, there = bench.body.force_n, bench.body.tool.y > -0.15
        bench.body.force_n = 45.0 if there and bench.robot.time_s() < until_s else 0.0
        if bench.body.force_n > was:
            met.append(bench.body.speeds[-1])

    bench.body.at_cycle = act
    bench.start("pink_bar")
    assert bench.run_until(IssueDetected).issue == "blocked"
    bench.run()
    met.clear()
    return met


def test_what_was_felt_and_cannot_be_seen_is_still_there_while_a_slow_try_feels_it() -> None:
    bench = RobotBench()
    met = held_up_by_a_wall(bench)
    bench.look(expect="way_clear")
    assert looked(bench).fulfilled is True
    assert met == []
    began_s = bench.robot.time_s()
    bench.look(expect="way_clear", within_s=20.0)
    assert looked(bench).fulfilled is False
    assert 19.0 < bench.robot.time_s() - began_s < 24.0
    assert 2 <= len(met) <= 4
    assert met == pytest.approx([0.15] * len(met))
    assert bench.body.tool.y < -0.15


def test_what_was_felt_is_gone_once_a_slow_try_feels_nothing() -> None:
    bench = RobotBench()
    met = held_up_by_a_wall(bench, until_s=20.0)
    bench.look(expect="way_clear", within_s=40.0)
    assert looked(bench).fulfilled is True
    assert len(met) >= 1
    assert 20.0 < bench.robot.time_s() < 30.0
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1")]


@pytest.mark.parametrize("unplannable", [False, True], ids=["held", "no path was found"])
def test_what_stands_in_the_way_of_a_start_is_seen_until_it_is_gone(unplannable: bool) -> None:
    bench = RobotBench()
    bench.body.unplannable = unplannable
    bench.body.grey_boxes.append(((0.5, -0.12, 0.7), (0.12, 0.12, 0.2)))
    bench.start("pink_bar")
    bench.run()
    assert bench.of(IssueDetected)[-1].issue == "blocked"
    bench.look(expect="way_clear", within_s=1.0)
    assert looked(bench).fulfilled is False
    bench.body.grey_boxes.clear()
    bench.look(expect="way_clear", within_s=1.0)
    assert looked(bench).fulfilled is True


def test_another_part_at_the_place_blocks_until_it_is_taken_away() -> None:
    bench = RobotBench()
    left = PLACES["left"]
    bench.body.parts["yellow_bar"] = Resting(left.x, left.y, yaw=left.yaw)
    bench.start("pink_bar")
    bench.run()
    issue = bench.of(IssueDetected)[0]
    assert (issue.issue, issue.step) == ("blocked", 0)
    assert "yellow_bar is where pink_bar belongs" in issue.detection.explanation
    bench.look(expect="way_clear", within_s=1.0)
    assert looked(bench).fulfilled is False
    bench.body.parts["yellow_bar"] = STARTS["yellow_bar"]
    bench.look(expect="way_clear", within_s=1.0)
    assert looked(bench).fulfilled is True
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.kinds()[-1] == "finished"


def test_a_new_command_replaces_a_look_without_a_word() -> None:
    bench = RobotBench()
    hold_with_issue(bench)
    bench.look(expect="in_reach", object="pink_bar", within_s=30.0)
    bench.robot.advance(1.0)
    bench.body.parts["pink_bar"] = STARTS["pink_bar"]
    bench.start("pink_bar")
    bench.run()
    assert bench.of(Looked) == []
    assert len(bench.of(Finished)) == 1


def test_an_interrupt_ends_a_hand_over() -> None:
    bench = RobotBench()
    hold_with_issue(bench)
    bench.look(expect="in_gripper", object="pink_bar", within_s=30.0)
    bench.robot.advance(0.3)
    assert bench.body.moving
    bench.send(Interrupt(retreat=False))
    assert not bench.body.moving
    assert bench.of(Holding)[-1] == Holding(execution="e1", at="in_place")


def test_in_the_dark_nothing_is_seen_and_nothing_fulfilled() -> None:
    bench = RobotBench()
    bench.look()
    assert looked(bench).blind is None
    bench.body.head_covered = True
    result = FinishedResult(object="pink_bar", place="where_pink_is")
    for expect in ("at_place", "in_reach", "way_clear", "view_clear"):
        bench.look(expect=expect, object="pink_bar", place="where_pink_is", finished=[result])
        seen = looked(bench)
        assert seen.fulfilled is False, expect
        assert seen.blind == "the picture of my head camera is black"
        assert (seen.objects, seen.there, seen.gone) == ({}, [], [])
    bench.body.head_covered = False
    bench.look(expect="view_clear", finished=[result])
    seen = looked(bench)
    assert (seen.fulfilled, seen.blind, seen.there) == (True, None, [result])


def test_what_is_taken_away_in_the_dark_is_seen_gone_afterwards() -> None:
    bench = RobotBench()
    result = FinishedResult(object="pink_bar", place="where_pink_is")
    bench.look(finished=[result])
    assert looked(bench).there == [result]
    bench.body.head_covered = True
    bench.look(finished=[result])
    bench.run()
    bench.body.vanish("pink_bar")
    bench.body.head_covered = False
    bench.look(finished=[result])
    assert looked(bench).gone == [result]


def test_a_part_that_was_taken_out_of_the_held_arm_is_seen_at_its_place() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(5, 0.5)
    bench.send(Interrupt(retreat=False))
    bench.look(expect="at_place", object="pink_bar", place="left", within_s=1.0)
    assert looked(bench).held == "pink_bar"
    bench.body.in_hand = None
    bench.body.parts["pink_bar"] = replace(STARTS["pink_bar"], x=0.55, y=0.05)
    bench.look(expect="at_place", object="pink_bar", place="left", within_s=10.0)
    seen = looked(bench)
    assert (seen.held, seen.fulfilled) == (None, True)
