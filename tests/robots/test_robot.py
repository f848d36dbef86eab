"""The robot from its end of the link: steps, issues, holds, resumes, refusals."""

import base64
import math

import cv2
import numpy as np
import pytest
from drawn_scene import Resting
from hypothesis import given, settings
from hypothesis import strategies as st
from robot_bench import RobotBench
from sampled import sample
from scripted_body import STARTS, ScriptedBody, catalogue, trained_model

from mend.robots.arm.body import NoWay
from mend.robots.arm.perception.head import HeadSense
from mend.robots.arm.subsystem import ArmSubsystem
from mend.robots.link.messages import (
    Finished,
    Hold,
    Holding,
    Interrupt,
    IssueDetected,
    Location,
    Look,
    Looked,
    Rejected,
    Resume,
    Resumed,
    Shutdown,
    SlowDown,
    Start,
    StepStarted,
    TakePicture,
)
from mend.robots.vision.obstruction import Obstruction
from mend.tasks.plugins import load_plugins


def placed(bench: RobotBench, name: str) -> tuple[float, float]:
    resting = bench.body.parts[name]
    return float(resting.x), float(resting.y)


def steps(bench: RobotBench) -> list[int]:
    return [each.step for each in bench.of(StepStarted)]


def only_issue(bench: RobotBench) -> IssueDetected:
    (issue,) = bench.of(IssueDetected)
    return issue


# --- Without faults ---------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["pink_bar", "green_leg", "purple_top"])
def test_an_object_is_placed_in_eight_steps(name: str) -> None:
    bench = RobotBench()
    bench.start(name)
    bench.run()
    assert steps(bench) == [1, 2, 3, 4, 5, 6, 7, 8]
    assert bench.of(Finished) == [Finished(execution="e1")]
    assert math.dist(placed(bench, name), (0.55, 0.05)) < 0.003


def test_what_is_in_its_place_already_is_left_there() -> None:
    bench = RobotBench()
    bench.start("pink_bar", "where_pink_is")
    bench.run()
    assert bench.kinds() == ["finished"]
    assert bench.of(Finished)[0].found_in_place


@pytest.mark.parametrize(
    ("x", "y", "yaw"), [(0.46, -0.31, 0.2), (0.45, -0.30, 0.45), (0.45, -0.30, 1.4)]
)
def test_what_is_only_about_in_its_place_is_placed_better(x: float, y: float, yaw: float) -> None:
    bench = RobotBench(body=ScriptedBody({"pink_bar": Resting(x, y, yaw=yaw)}, 1 / 30))
    bench.start("pink_bar", "where_pink_is")
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1")]
    assert math.dist(placed(bench, "pink_bar"), (0.45, -0.30)) < 0.003
    assert bench.body.parts["pink_bar"].yaw == pytest.approx(0.2, abs=0.03)


def test_what_somebody_put_there_may_be_off_by_a_centimetre_but_not_turned_round() -> None:
    for yaw, steps_left in ((0.35, []), (1.4, list(range(1, 9)))):
        bench = RobotBench()
        del bench.body.parts["pink_bar"]
        bench.start("pink_bar", "where_pink_is")
        bench.run()
        assert only_issue(bench).issue == "missing"
        bench.body.parts["pink_bar"] = Resting(0.46, -0.30, yaw=yaw)
        bench.send(Resume(execution="e1"))
        bench.run()
        assert steps(bench) == steps_left
        assert bench.of(Finished)[0].found_in_place is (not steps_left)


def test_no_time_passes_while_nothing_is_to_be_done() -> None:
    bench = RobotBench()
    assert bench.robot.advance(5.0) is False
    assert bench.robot.time_s() == 0.0
    assert not bench.robot.busy


def test_advance_keeps_to_its_time_and_returns_early_for_what_must_be_seen() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    assert bench.robot.advance(0.25)
    assert bench.robot.time_s() == pytest.approx(0.25, abs=0.02)
    while bench.robot.advance(1000.0):
        pass
    assert bench.robot.time_s() < 60.0
    assert bench.kinds()[-1] == "finished"


def test_task_progress_counts_steps_fractions_and_attempts() -> None:
    bench = RobotBench()
    assert bench.robot.task_progress is None
    bench.start("pink_bar")
    bench.run_to(5, 0.4)
    progress = bench.robot.task_progress
    assert progress is not None
    assert (progress.object, progress.step, progress.attempt) == ("pink_bar", 5, 1)
    assert 0.4 <= progress.fraction < 0.6
    bench.body.vanish("pink_bar")
    bench.run()
    bench.start("pink_bar")
    progress = bench.robot.task_progress
    assert progress is not None
    assert (progress.step, progress.attempt) == (0, 2)


# --- Issues before the first step -------------------------------------------------------------


def test_an_object_nowhere_to_be_seen_is_missing() -> None:
    bench = RobotBench()
    bench.body.vanish("pink_bar")
    bench.start("pink_bar")
    bench.run()
    assert (only_issue(bench).issue, only_issue(bench).step) == ("missing", 0)
    assert bench.of(Holding) == [Holding(execution="e1", at="neutral")]
    assert steps(bench) == []


def test_an_object_out_of_reach_is_unreachable() -> None:
    bench = RobotBench()
    bench.body.parts["pink_bar"].x = 0.95
    bench.start("pink_bar")
    bench.run()
    issue = only_issue(bench)
    assert (issue.issue, issue.interrupts) == ("unreachable", True)
    assert issue.detection is not None
    assert issue.detection.center is not None


def test_an_object_in_reach_to_which_no_path_leads_is_unreachable_too() -> None:
    bench = RobotBench()
    bench.body.unplannable = True
    bench.start("pink_bar")
    bench.run()
    assert only_issue(bench).issue == "unreachable"


def test_what_stands_only_in_a_way_that_is_not_taken_blocks_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    bench = RobotBench()
    plan = bench.body.plan_among

    def is_high(way) -> bool:
        return max(pose.z for pose in way) > 0.7 + 0.15

    def plan_low(legs, boxes):
        too_high = is_high([leg.to for leg in legs])
        return NoWay("finds no path") if too_high else plan(legs, boxes)

    def see_high(_, __, way, ___=None) -> Obstruction | None:
        return Obstruction((0.5, -0.1, 0.9), (80.0, 60.0), 500) if is_high(way) else None

    monkeypatch.setattr(bench.body, "plan_among", plan_low)
    monkeypatch.setattr(HeadSense, "obstruction", see_high)
    bench.start("pink_bar")
    bench.run()
    assert bench.of(IssueDetected) == []
    assert bench.of(Finished)


def test_something_unknown_in_the_way_blocks_the_start() -> None:
    bench = RobotBench()
    bench.body.grey_boxes.append(((0.5, -0.12, 0.7), (0.12, 0.12, 0.2)))
    bench.start("pink_bar")
    bench.run()
    assert (only_issue(bench).issue, only_issue(bench).step) == ("blocked", 0)
    bench.body.grey_boxes.clear()
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Resumed) == [Resumed(execution="e1", step=1)]
    assert bench.kinds()[-1] == "finished"


def test_an_issue_carries_the_picture_with_the_detection_drawn() -> None:
    bench = RobotBench()
    bench.at(5, 0.5, lambda: bench.body.vanish("pink_bar"))
    bench.start("pink_bar")
    bench.run()
    jpeg = only_issue(bench).jpeg
    assert jpeg is not None
    picture = cv2.imdecode(np.frombuffer(base64.b64decode(jpeg), np.uint8), cv2.IMREAD_COLOR)
    assert picture.shape == (240, 320, 3)


# --- Issues on the way ------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("step", "fraction", "issue", "seen_in"),
    [
        (1, 0.5, "missed", (3, 4)),
        (2, 0.8, "missed", (3, 4)),
        (3, 0.5, "missed", (3, 4)),
        (4, 0.0, "dropped", (4,)),
        (4, 0.9, "dropped", (4, 5)),
        (5, 0.05, "dropped", (5,)),
        (5, 0.9, "dropped", (5,)),
    ],
)
@pytest.mark.parametrize("period_s", [1 / 30, 0.1])
def test_a_stolen_object_is_told_as_missed_or_dropped(
    step, fraction, issue, seen_in, period_s
) -> None:
    bench = RobotBench(period_s)
    stolen_s: list[float] = []

    def steal() -> None:
        stolen_s.append(bench.robot.time_s())
        bench.body.vanish("green_leg")

    bench.at(step, fraction, steal)
    bench.start("green_leg")
    bench.run()
    detected = only_issue(bench)
    assert detected.issue == issue
    assert detected.step in seen_in
    assert bench.of(Holding) == [Holding(execution="e1", at="neutral")]
    if issue == "dropped":
        noticed_s = next(time for time, body in bench.reports if isinstance(body, IssueDetected))
        assert noticed_s - stolen_s[0] <= 0.15


def test_after_a_fault_the_gripper_is_open_and_the_arm_stopped_at_once() -> None:
    bench = RobotBench()
    bench.at(5, 0.3, lambda: bench.body.vanish("green_leg"))
    bench.start("green_leg")
    bench.run_until(IssueDetected)
    assert not bench.body.arm_moving
    bench.run()
    assert bench.body.gripper_opening_m() > 0.05


def test_a_dropped_object_that_was_put_back_is_placed_by_the_next_start() -> None:
    bench = RobotBench()
    bench.at(5, 0.9, lambda: bench.body.vanish("pink_bar"))
    bench.start("pink_bar")
    bench.run()
    bench.body.parts["pink_bar"] = STARTS["pink_bar"]
    bench.start("pink_bar")
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e2")]


def test_a_start_that_comes_while_the_arm_retreats_waits_for_it() -> None:
    bench = RobotBench()
    bench.at(5, 0.5, lambda: bench.body.vanish("pink_bar"))
    bench.start("pink_bar")
    bench.run_until(IssueDetected)
    bench.start("green_leg", "right")
    bench.run()
    kinds = bench.kinds()
    assert kinds.index("holding") < len(kinds) - 9
    assert bench.of(Finished) == [Finished(execution="e2")]


def test_positioning_slows_down_and_interrupts_nothing() -> None:
    plain, helped = RobotBench(), RobotBench()
    plain.start("pink_bar")
    helped.start("pink_bar", needs_help=True)
    plain.run()
    helped.run()
    issue = only_issue(helped)
    assert (issue.issue, issue.step, issue.interrupts) == ("positioning", 5, False)
    assert steps(helped) == [1, 2, 3, 4, 5, 6, 7, 8]
    begun = {
        bench: {b.step: t for t, b in bench.reports if isinstance(b, StepStarted)}
        for bench in (plain, helped)
    }
    for step in (5, 6):
        spent = [begun[bench][step + 1] - begun[bench][step] for bench in (helped, plain)]
        assert spent[0] > 1.6 * spent[1]
    assert begun[helped][5] == pytest.approx(begun[plain][5], abs=0.05)
    helped.start("green_leg", "right")
    helped.run_to(1)
    assert helped.body.speeds[-1] == 1.0


def test_an_object_that_the_catalogue_says_needs_help_raises_positioning() -> None:
    bench = RobotBench()
    bench.start("yellow_bar", "right")
    bench.run()
    assert only_issue(bench).issue == "positioning"
    assert bench.kinds()[-1] == "finished"


def test_a_push_against_the_arm_holds_it_in_place() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(5, 0.5)
    bench.body.force_n = 250.0
    issue = bench.run_until(IssueDetected)
    assert (issue.issue, issue.step) == ("blocked", 5)
    where = bench.body.tool
    bench.run()
    assert bench.body.tool == where
    assert bench.of(Holding) == [Holding(execution="e1", at="in_place")]


# --- Interrupt and resume ---------------------------------------------------------------------


@pytest.mark.slow
@settings(deadline=None, max_examples=sample(5, 20))
@given(cycles=st.integers(0, 300), retreat=st.booleans())
def test_an_interrupt_stops_all_motion_within_a_cycle(cycles: int, retreat: bool) -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    for _ in range(cycles):
        bench.robot.advance(bench.body.control_period_s)
    finished = bool(bench.of(Finished))
    before = bench.body.stops
    bench.send(Interrupt(retreat=retreat))
    assert bench.body.stops > before
    assert not bench.body.arm_moving
    where = bench.body.tool
    if retreat:
        bench.run()
        assert bench.of(Holding)[-1].at == "neutral"
        assert not bench.body.in_hand
    else:
        bench.robot.advance(1.0)
        assert bench.body.tool == where
        assert bench.of(Holding)[-1].execution == (None if finished else "e1")


@pytest.mark.slow
@settings(deadline=None, max_examples=sample(5, 20))
@given(cycles=st.integers(0, 240))
def test_a_behavior_interrupted_anywhere_resumes_and_finishes(cycles: int) -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    for _ in range(cycles):
        bench.robot.advance(bench.body.control_period_s)
    assert not bench.of(Finished)
    bench.send(Interrupt(retreat=False))
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(IssueDetected) == []
    assert len(bench.of(Finished)) == 1
    assert math.dist(placed(bench, "pink_bar"), (0.55, 0.05)) < 0.004


@pytest.mark.parametrize(("step", "expected"), [(2, 1), (4, 5), (5, 5), (6, 5)])
def test_a_resume_goes_on_where_the_hands_allow(step: int, expected: int) -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(step, 0.5)
    bench.send(Interrupt(retreat=False))
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Resumed) == [Resumed(execution="e1", step=expected)]


def test_a_resume_after_the_release_finds_the_object_in_place() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(8, 0.5)
    bench.send(Interrupt(retreat=False))
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1", found_in_place=True)]


def test_an_object_taken_while_held_is_looked_for_on_resume() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(5, 0.5)
    bench.send(Interrupt(retreat=False))
    bench.body.vanish("pink_bar")
    bench.body.parts["pink_bar"] = STARTS["pink_bar"]
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Resumed) == [Resumed(execution="e1", step=1)]
    assert bench.kinds()[-1] == "finished"


def test_a_retreat_puts_back_what_is_carried_and_ends_the_execution() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(5, 0.7)
    bench.send(Interrupt(retreat=True))
    bench.run()
    assert bench.of(Holding) == [Holding(execution="e1", at="neutral")]
    start = STARTS["pink_bar"]
    assert math.dist(placed(bench, "pink_bar"), (start.x, start.y)) < 0.005
    assert bench.robot.task_progress is None
    bench.send(Resume(execution="e1"))
    assert "is not held" in bench.of(Rejected)[0].reason


def test_a_start_right_after_a_retreat_command_waits_for_it() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(5, 0.5)
    bench.send(Interrupt(retreat=True))
    bench.start("green_leg", "right")
    bench.run()
    assert bench.of(Rejected) == []
    assert bench.of(Holding) == [Holding(execution="e1", at="neutral")]
    assert bench.of(Finished) == [Finished(execution="e3")]


def test_a_start_right_after_a_retreat_command_waits_for_an_idle_robot_too() -> None:
    bench = RobotBench()
    bench.send(Interrupt(retreat=True))
    bench.start("green_leg", "right")
    bench.run()
    assert bench.of(Rejected) == []
    assert bench.of(Holding) == [Holding(execution=None, at="neutral")]
    assert bench.of(Finished) == [Finished(execution="e2")]


def test_an_interrupt_of_a_retreat_holds_and_resumes() -> None:
    bench = RobotBench()
    bench.at(5, 0.5, lambda: bench.body.vanish("pink_bar"))
    bench.start("pink_bar")
    bench.run_until(IssueDetected)
    for _ in range(20):
        bench.robot.advance(bench.body.control_period_s)
    bench.send(Interrupt(retreat=False))
    assert bench.of(Holding) == [Holding(execution="e1", at="in_place")]
    bench.body.parts["pink_bar"] = STARTS["pink_bar"]
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.kinds()[-1] == "finished"


def test_an_idle_robot_holds_or_retreats_when_told() -> None:
    bench = RobotBench()
    bench.send(Interrupt(retreat=False))
    bench.send(Interrupt(retreat=True))
    bench.run()
    assert bench.of(Holding) == [
        Holding(execution=None, at="in_place"),
        Holding(execution=None, at="neutral"),
    ]


# --- The rest ---------------------------------------------------------------------------------


def test_motion_slows_down_as_commanded() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(1, 0.1)
    bench.send(SlowDown(factor=0.25))
    assert bench.body.speeds[-1] == pytest.approx(0.25)
    bench.run_to(2)
    assert bench.body.speeds[-1] == pytest.approx(0.125)
    bench.send(SlowDown(factor=1.0))
    assert bench.body.speeds[-1] == pytest.approx(0.5)


def test_hello_says_what_it_is_and_what_it_does() -> None:
    bench = RobotBench()
    hello = bench.robot.hello("b1")
    assert hello.behaviors == ["pick_and_place"]
    assert hello.cameras == ["forearm", "head"]
    assert (hello.robot, hello.boot, hello.executing) == ("r1", "b1", None)
    bench.at(5, 0.5, lambda: bench.body.vanish("pink_bar"))
    bench.start("pink_bar")
    bench.run_to(2)
    states = [bench.robot.hello("b1").executing]
    bench.run_until(IssueDetected)
    bench.robot.advance(0.1)
    states.append(bench.robot.hello("b1").executing)
    bench.run()
    states.append(bench.robot.hello("b1").executing)
    assert [each.state for each in states if each] == ["running", "retreating", "holding"]


def test_a_picture_says_where_is_to_be_what_the_robot_looks_for() -> None:
    bench = RobotBench()
    bench.look(expect="at_place", object="pink_bar", place="left", within_s=60.0)
    bench.robot.advance(1.0)
    for camera in ("head", "forearm"):
        bench.send(TakePicture(camera=camera))
    of_head, of_forearm = bench.pictures
    assert of_head.detection is not None
    assert of_head.detection.expected is not None
    assert of_head.detection.center is None
    assert of_forearm.detection is None
    bench.look()
    bench.run()
    bench.send(TakePicture(camera="head"))
    assert bench.pictures[-1].detection is None


def test_a_picture_is_sent_when_asked_for() -> None:
    bench = RobotBench()
    command = bench.send(TakePicture(camera="head"))
    (picture,) = bench.pictures
    assert (picture.command, picture.camera) == (command, "head")
    assert picture.jpeg


def test_shut_down_is_noted() -> None:
    bench = RobotBench()
    assert not bench.robot.shut_down
    bench.send(Shutdown())
    assert bench.robot.shut_down


def start(behavior="pick_and_place", **parameters) -> Start:
    return Start(execution="e", node="/0", behavior=behavior, parameters=parameters)


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        (start("dance"), "behavior 'dance' is unknown; this robot has pick_and_place"),
        (start(object="pink_bar"), "pick_and_place: place: Field required"),
        (start(object="spoon", place="left"), "object 'spoon' is unknown"),
        (start(object="pink_bar", place="moon"), "place 'moon' is unknown"),
        (Resume(execution="e9"), "execution 'e9' is not held"),
        (TakePicture(camera="tail"), "camera 'tail' is unknown; this robot has forearm, head"),
        (Hold(until=5.0), "only a simulated world can do 'hold'"),
        (Look(expect="in_reach"), "needs an object"),
        (Look(expect="at_place", object="pink_bar"), "needs a place"),
        (Look(expect="in_reach", object="spoon"), "object 'spoon' is unknown"),
    ],
)
def test_what_cannot_be_done_is_refused_in_one_sentence(command, reason: str) -> None:
    bench = RobotBench()
    bench.send(command)
    assert bench.kinds() == ["rejected"]
    assert reason in bench.of(Rejected)[0].reason
    assert not bench.robot.busy


def test_a_second_start_and_an_expecting_look_are_refused_while_a_behavior_runs() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(2)
    bench.start("green_leg")
    bench.look(expect="in_reach", object="green_leg")
    assert len(bench.of(Rejected)) == 2
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1")]


def test_a_resume_of_what_runs_is_refused() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(2)
    bench.send(Resume(execution="e1"))
    assert "only a held one can resume" in bench.of(Rejected)[0].reason


def test_a_target_in_the_command_is_enough() -> None:
    bench = RobotBench()
    bench.send(
        Start(
            execution="e1",
            node="/0",
            behavior="pick_and_place",
            parameters={"object": "pink_bar", "place": "nowhere_known"},
            target=Location(x=0.60, y=0.12),
        )
    )
    bench.run()
    assert math.dist(placed(bench, "pink_bar"), (0.60, 0.12)) < 0.003


def test_a_look_while_a_behavior_runs_disturbs_nothing() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(5, 0.3)
    where = bench.body.tool
    bench.look()
    assert "green_leg" in bench.of(Looked)[0].objects
    assert bench.body.tool == where
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1")]


def test_a_robot_needs_the_monitors_that_explain_why_nothing_starts() -> None:
    monitors = {k: v for k, v in load_plugins("mend.monitors").items() if k != "missing"}
    with pytest.raises(ValueError, match="expected monitors for"):
        ArmSubsystem(
            ScriptedBody(STARTS),
            trained_model(),
            catalogue(),
            load_plugins("mend.behaviors"),
            monitors,
        )


# --- What it shows ----------------------------------------------------------------------------


def test_a_robot_shows_what_it_has_located_and_hides_what_it_has_not() -> None:
    bench = RobotBench()
    names = [each.name for each in bench.robot.pose_layout().objects]
    assert set(names) == set(catalogue().parts)
    assert all(each.hidden for each in bench.robot.poses().objects)
    bench.look()
    bench.run()
    (looked,) = bench.of(Looked)
    poses = bench.robot.poses()
    assert poses.tool[:3] == pytest.approx(tuple(bench.body.tool_pose()[:3, 3]))
    for name, shown in zip(names, poses.objects, strict=True):
        assert shown.hidden == (name not in looked.objects)
        if not shown.hidden:
            seen = looked.objects[name]
            assert shown.pose[:3] == (seen.x, seen.y, seen.z)


def test_a_robot_shows_what_it_holds_in_its_gripper() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(5, 0.5)
    names = [each.name for each in bench.robot.pose_layout().objects]
    held = {
        name for name, each in zip(names, bench.robot.poses().objects, strict=True) if each.held
    }
    assert held == {"pink_bar"}
