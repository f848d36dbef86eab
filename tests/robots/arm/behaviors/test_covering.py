"""What is to be covered is looked at past the arm, until nobody can see it any more."""

from typing import Any

import pytest
from drawn_scene import Resting
from robot_bench import RobotBench

from mend.robots.link.messages import (
    Finished,
    FinishedResult,
    Holding,
    IssueDetected,
    Resume,
    Start,
)

UNDER = FinishedResult(object="green_leg", place="left")


def covers(under: Resting, **fields: Any) -> RobotBench:
    """The purple top is on its way to where the green leg stands."""
    bench = RobotBench()
    bench.body.parts["green_leg"] = under
    start = Start(
        execution="e1",
        node="/1",
        behavior="pick_and_place",
        parameters={"object": "purple_top", "place": "left"},
        target={"x": 0.55, "y": 0.05, "z": 0.78},
        **fields,
    )
    bench.send(start)
    return bench


@pytest.mark.parametrize("step", [4, 5])
def test_what_is_taken_from_under_the_place_stops_the_robot_before_it_is_covered(
    step: int,
) -> None:
    bench = covers(Resting(0.55, 0.05), finished=[UNDER])
    bench.run_to(step)
    bench.body.vanish("green_leg")
    bench.run()
    assert bench.of(Holding) == [Holding(execution="e1", at="neutral")]
    assert bench.of(IssueDetected) == []
    assert bench.of(Finished) == []


def test_it_is_told_once_and_whoever_goes_on_knows_it() -> None:
    bench = covers(Resting(0.55, 0.05), finished=[UNDER])
    bench.run_to(4)
    bench.body.vanish("green_leg")
    bench.run()
    bench.send(Resume(execution="e1"))
    bench.run_to(7)
    assert len(bench.of(Holding)) == 1


def test_what_stays_and_what_nobody_called_done_stop_nothing() -> None:
    bench = covers(Resting(0.55, 0.05), finished=[UNDER])
    bench.run_to(7)
    assert bench.of(Holding) == []
    bench = covers(Resting(0.55, 0.05))
    bench.run_to(4)
    bench.body.vanish("green_leg")
    bench.run_to(7)
    assert bench.of(Holding) == []
