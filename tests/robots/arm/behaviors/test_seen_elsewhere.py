"""What is seen elsewhere than others expect is fetched once the service says so."""

import pytest
from robot_bench import RobotBench
from scripted_body import STARTS

from mend.robots.link.messages import (
    Finished,
    Holding,
    IssueDetected,
    Resume,
    Start,
    StepStarted,
)

ITS_START = (STARTS["pink_bar"].x, STARTS["pink_bar"].y)
ITS_PLACE = (0.55, 0.05)
ELSEWHERE = (0.45, -0.60)


def started(object_at: tuple[float, float] | None) -> RobotBench:
    bench = RobotBench()
    parameters = {"object": "pink_bar", "place": "left"}
    bench.send(
        Start(
            execution="e1",
            node="/0",
            behavior="pick_and_place",
            parameters=parameters,
            object_at=object_at,
        )
    )
    bench.run()
    return bench


@pytest.mark.parametrize("object_at", [None, ITS_START, (ITS_START[0] + 0.02, ITS_START[1])])
def test_what_is_where_it_was_is_fetched(object_at: tuple[float, float] | None) -> None:
    assert started(object_at).of(Finished) == [Finished(execution="e1")]


def test_for_what_is_elsewhere_it_waits_at_neutral_and_blames_nobody() -> None:
    bench = started(ELSEWHERE)
    assert bench.of(Holding) == [Holding(execution="e1", at="neutral")]
    assert bench.of(StepStarted) == []
    assert bench.of(IssueDetected) == []
    bench.send(Resume(execution="e1", object_at=ITS_START))
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1")]


def test_what_it_has_told_of_once_it_does_not_tell_again() -> None:
    bench = started(ELSEWHERE)
    bench.send(Resume(execution="e1", object_at=ELSEWHERE))
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1")]


def test_what_was_pushed_on_the_way_to_its_place_is_fetched_from_there() -> None:
    between = tuple((a + b) / 2 for a, b in zip(ITS_START, ITS_PLACE, strict=True))
    bench = RobotBench()
    bench.body.parts["pink_bar"] = type(STARTS["pink_bar"])(*between)
    parameters = {"object": "pink_bar", "place": "left"}
    start = Start(
        execution="e1",
        node="/0",
        behavior="pick_and_place",
        parameters=parameters,
        object_at=ITS_START,
    )
    bench.send(start)
    bench.run()
    assert bench.of(Finished) == [Finished(execution="e1")]
