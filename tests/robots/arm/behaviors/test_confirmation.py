"""The look after the last step, and the monitors that judge what it shows."""

from typing import Any, ClassVar

import pytest
from robot_bench import RobotBench
from scripted_body import STARTS

from mend.documents.strict_model import StrictModel
from mend.robots.arm.monitors import ArmMonitor, ArmView
from mend.robots.execution.monitor import NoParameters, Reaction
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import (
    Detection,
    Finished,
    Holding,
    IssueDetected,
    Resume,
    StepStarted,
)
from mend.robots.vision.presence import Presence


class Onlooker(ArmMonitor[NoParameters]):
    """Raises nothing, but keeps what it is shown after the last step."""

    issue: ClassVar[str] = "watched"
    behaviors: ClassVar[frozenset[str]] = frozenset({"pick_and_place"})
    phases: ClassVar[frozenset[Phase]] = frozenset({Phase.CONFIRM})
    reaction: ClassVar[Reaction] = Reaction.STOP_IN_PLACE
    camera: ClassVar[str | None] = "head"
    parameters: ClassVar[type[StrictModel]] = NoParameters
    views: ClassVar[list[ArmView]] = []

    def check(self, view: ArmView) -> Detection | None:
        self.views.append(view)
        return None


def bench_that_looks_on(**body: Any) -> RobotBench:
    Onlooker.views.clear()
    return RobotBench(**body, monitors={Onlooker.issue: Onlooker})


def test_the_arm_is_out_of_view_and_the_part_seen_at_its_place_before_it_is_finished() -> None:
    bench = bench_that_looks_on()
    bench.start("pink_bar")
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1")]
    (view,) = Onlooker.views
    assert (view.phase, view.step, view.presence) == (Phase.CONFIRM, 8, Presence.THERE)
    assert view.placed is not None
    assert (view.placed.x, view.placed.y) == pytest.approx((0.55, 0.05), abs=0.005)
    assert bench.body.tool.y < -0.8


@pytest.mark.parametrize(("step", "fraction"), [(6, 0.9), (7, 0.5), (8, 0.1), (8, 0.9)])
def test_what_is_stolen_while_it_is_placed_is_not_finished(step: int, fraction: float) -> None:
    bench = bench_that_looks_on()
    bench.at(step, fraction, lambda: bench.body.vanish("pink_bar"))
    bench.start("pink_bar")
    bench.run()
    assert bench.of(Finished) == []
    (issue,) = bench.of(IssueDetected)
    assert (issue.issue, issue.step) == ("undone", 8)
    assert bench.of(Holding) == [Holding(execution="e1", at="neutral")]


def test_what_was_stolen_and_put_to_its_place_meanwhile_is_found_there_on_resuming() -> None:
    bench = bench_that_looks_on()
    bench.at(8, 0.1, lambda: bench.body.vanish("pink_bar"))
    bench.start("pink_bar")
    bench.run()
    bench.body.at_cycle = lambda: None
    bench.body.parts["pink_bar"] = type(STARTS["pink_bar"])(0.55, 0.05)
    bench.send(Resume(execution="e1"))
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1", found_in_place=True)]


def test_nothing_is_looked_at_after_a_fault() -> None:
    bench = bench_that_looks_on()
    bench.at(5, 0.5, lambda: bench.body.vanish("pink_bar"))
    bench.start("pink_bar")
    bench.run()
    assert [each.issue for each in bench.of(IssueDetected)] == ["dropped"]
    assert Onlooker.views == []


def test_what_was_pushed_aside_while_it_was_placed_is_placed_again_at_once() -> None:
    bench = bench_that_looks_on()
    moved: list[bool] = []

    def push() -> None:
        if not moved and bench.robot.task_progress and bench.robot.task_progress.step == 8:
            moved.append(True)
            bench.body.parts["pink_bar"] = type(STARTS["pink_bar"])(0.60, -0.10)

    bench.body.at_cycle = push
    bench.start("pink_bar")
    bench.run()
    (issue,) = bench.of(IssueDetected)
    assert (issue.issue, issue.step, issue.interrupts) == ("undone", 8, False)
    assert [view.presence for view in Onlooker.views] == [Presence.GONE, Presence.THERE]
    assert bench.of(Finished) == [Finished(execution="e1")]


def test_what_is_placed_in_vain_again_and_again_is_asked_about() -> None:
    bench = bench_that_looks_on()

    def push() -> None:
        if bench.robot.task_progress and bench.robot.task_progress.step == 8:
            bench.body.parts["pink_bar"] = type(STARTS["pink_bar"])(0.60, -0.10)

    bench.body.at_cycle = push
    bench.start("pink_bar")
    bench.run()
    assert [each.interrupts for each in bench.of(IssueDetected)] == [False, True]
    assert bench.of(Finished) == []
    assert bench.of(Holding) == [Holding(execution="e1", at="neutral")]


@pytest.mark.parametrize("off_m", [0.01, 0.015])
def test_a_part_that_is_seen_off_its_place_is_placed_once_more(off_m: float) -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(8, 0.2)
    bench.body.parts["pink_bar"].y += off_m
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1")]
    assert bench.of(IssueDetected) == []
    assert [each.step for each in bench.of(StepStarted)] == [*range(1, 9)] * 2
    resting = bench.body.parts["pink_bar"]
    assert (resting.x, resting.y) == pytest.approx((0.55, 0.05), abs=0.004)


def test_a_part_that_ends_off_its_place_twice_is_left_there() -> None:
    bench = RobotBench()
    nudged: list[float] = []

    def nudge() -> None:
        begun = sum(each.step == 8 for each in bench.of(StepStarted))
        if len(nudged) < begun:
            nudged.append(bench.body.time_s())
            bench.body.parts["pink_bar"].y += 0.01

    bench.body.at_cycle = nudge
    bench.start("pink_bar")
    bench.run()
    assert len(nudged) == 2
    assert bench.of(Finished) == [Finished(execution="e1")]
    assert bench.body.parts["pink_bar"].y == pytest.approx(0.06, abs=0.004)


def test_a_camera_that_shows_what_was_before_the_part_was_moved_says_nothing_of_it() -> None:
    bench = RobotBench()
    bench.body.head_noisy = True
    for _ in range(2):
        bench.look()
        bench.run()
    bench.start("pink_bar")
    bench.body.head_frozen = True
    bench.run()
    (issue,) = bench.of(IssueDetected)
    assert (issue.issue, issue.step) == ("blind", 8)
    assert issue.detection.explanation.startswith("my head camera is frozen")
    bench.send(Resume(execution="e3"))
    bench.run()
    assert [each.issue for each in bench.of(IssueDetected)] == ["blind", "blind"]
    bench.body.head_frozen = False
    bench.send(Resume(execution="e3"))
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e3")]
    assert len(bench.of(StepStarted)) == 8


def test_a_camera_that_is_frozen_while_the_next_part_is_placed_is_found_out_then() -> None:
    bench = RobotBench()
    bench.body.head_noisy = True
    bench.start("pink_bar")
    bench.run()
    bench.look()
    bench.run()
    bench.body.head_frozen = True
    bench.start("green_leg", "right")
    bench.run()
    (issue,) = bench.of(IssueDetected)
    assert (issue.issue, issue.step) == ("blind", 8)


def test_what_was_put_back_before_a_camera_without_noise_is_no_frozen_picture() -> None:
    bench = RobotBench()
    start = bench.body.parts["pink_bar"]
    bench.start("pink_bar")
    bench.run_to(8, 0.5)
    bench.body.parts["pink_bar"] = start
    bench.run()
    assert [each.issue for each in bench.of(IssueDetected)] == ["undone"]
