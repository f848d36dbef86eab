"""Whoever waits for help plans meanwhile; what was planned is done once, for just what is seen."""

from collections.abc import Sequence

from drawn_scene import Resting
from robot_bench import RobotBench
from scripted_body import STARTS, ScriptedBody

from mend.robots.arm.body import ArmPath, Leg, NoWay
from mend.robots.link.messages import Finished, Interrupt, IssueDetected, Looked, StepStarted
from mend.robots.vision.seen_box import SeenBox


class CountingBody(ScriptedBody):
    """Counts how often it was asked for a plan."""

    def __init__(self) -> None:
        super().__init__(STARTS, 1 / 30)
        self.plans = 0

    def plan_among(self, legs: Sequence[Leg], boxes: Sequence[SeenBox]) -> ArmPath | NoWay:
        self.plans += 1
        return super().plan_among(legs, boxes)


def waiting(body: CountingBody) -> RobotBench:
    """A robot that waits, as the object was missing, and has seen it put back somewhere."""
    bench = RobotBench(body=body)
    body.vanish("pink_bar")
    bench.start("pink_bar")
    bench.run()
    assert bench.of(IssueDetected)[-1].issue == "missing"
    body.parts["pink_bar"] = Resting(STARTS["pink_bar"].x, STARTS["pink_bar"].y + 0.02)
    bench.look(expect="in_reach", object="pink_bar", within_s=5.0)
    bench.run()
    assert bench.of(Looked)[-1].fulfilled
    return bench


def test_what_was_planned_while_waiting_is_not_planned_again() -> None:
    body = CountingBody()
    bench = waiting(body)
    planned = body.plans
    bench.start("pink_bar")
    bench.run_until(StepStarted)
    assert body.plans == planned
    bench.run()
    assert bench.of(Finished)


def test_what_has_moved_since_is_planned_anew() -> None:
    body = CountingBody()
    bench = waiting(body)
    planned = body.plans
    body.parts["pink_bar"] = Resting(STARTS["pink_bar"].x, STARTS["pink_bar"].y - 0.02)
    bench.start("pink_bar")
    bench.run()
    assert body.plans > planned
    assert bench.of(Finished)


def test_another_place_is_planned_anew() -> None:
    body = CountingBody()
    bench = waiting(body)
    planned = body.plans
    bench.start("pink_bar", place="right")
    bench.run()
    assert body.plans > planned
    assert bench.of(Finished)


def test_a_plan_that_was_begun_is_not_taken_again() -> None:
    """What failed once would fail the very same way."""
    body = CountingBody()
    bench = waiting(body)
    bench.start("pink_bar")
    bench.run_until(StepStarted)
    planned = body.plans
    bench.send(Interrupt(retreat=True))
    bench.run()
    bench.start("pink_bar")
    bench.run_until(StepStarted)
    assert body.plans > planned


def test_looks_that_nobody_waits_for_plan_nothing() -> None:
    body = CountingBody()
    bench = RobotBench(body=body)
    bench.look()
    bench.run()
    assert body.plans == 0


def test_what_is_done_is_not_planned_again() -> None:
    body = CountingBody()
    bench = RobotBench(body=body)
    bench.start("pink_bar")
    bench.run()
    assert bench.of(Finished)
    planned = body.plans
    bench.look(expect="at_place", object="pink_bar", place="left", within_s=2.0)
    bench.run()
    assert body.plans == planned
