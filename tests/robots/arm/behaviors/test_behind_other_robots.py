"""Other robots in the head camera's view: they are waited for while they move, and blamed never."""

import math
from collections.abc import Callable

from robot_bench import RobotBench
from scripted_body import NEUTRAL, STARTS

from mend.robots.link.messages import Finished, Holding, IssueDetected, Looked

ITS_PLACE = (0.55, 0.05)
ITS_START = (STARTS["pink_bar"].x, STARTS["pink_bar"].y)
PASSES_M_PER_S = 0.10


def passes(bench: RobotBench, over: tuple[float, float]) -> Callable[[], None]:
    """Another robot is over a point, and goes slowly on and away once this one's arm rests."""
    since_s: list[float] = []

    def pass_over() -> None:
        if bench.body.tool == NEUTRAL and not since_s:
            since_s.append(bench.robot.time_s())
        went_m = PASSES_M_PER_S * (bench.robot.time_s() - since_s[0]) if since_s else 0.0
        bench.body.other_robot_at = (over[0], over[1] + went_m) if went_m < 0.8 else None

    return pass_over


def is_seen_past_others(bench: RobotBench, point: tuple[float, float]) -> bool:
    other = bench.body.other_robot_at
    return other is None or math.dist(other, point) > 0.05


def test_where_a_part_was_put_is_looked_at_until_who_passes_over_it_has_passed() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(8)
    bench.body.at_cycle = passes(bench, ITS_PLACE)
    assert bench.run_until(Finished) == Finished(execution="e1")
    assert bench.of(IssueDetected) == []
    assert is_seen_past_others(bench, ITS_PLACE)


def test_what_is_stolen_behind_who_passes_is_not_finished() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(8)
    passing = passes(bench, ITS_PLACE)

    def steal() -> None:
        passing()
        bench.body.vanish("pink_bar")

    bench.body.at_cycle = steal
    bench.run()
    assert [each.issue for each in bench.of(IssueDetected)] == ["undone"]
    assert bench.of(Finished) == []


def test_who_stands_still_before_where_a_part_was_put_is_no_blindness() -> None:
    bench = RobotBench()
    bench.start("pink_bar")
    bench.run_to(8)
    bench.body.other_robot_at = ITS_PLACE
    bench.run()
    assert bench.of(IssueDetected) == []
    assert bench.of(Finished) == [Finished(execution="e1")]


def test_a_part_behind_who_passes_is_not_missing() -> None:
    bench = RobotBench()
    bench.body.at_cycle = passes(bench, ITS_START)
    bench.start("pink_bar")
    bench.run()
    assert bench.of(IssueDetected) == []
    assert bench.of(Finished) == [Finished(execution="e1")]


def test_a_part_that_is_gone_is_missing_once_who_passes_has_shown_all_of_the_table() -> None:
    bench = RobotBench()
    bench.body.vanish("pink_bar")
    bench.body.at_cycle = passes(bench, ITS_START)
    bench.start("pink_bar")
    assert bench.run_until(IssueDetected).issue == "missing"
    assert is_seen_past_others(bench, ITS_START)


def test_a_look_at_what_others_pass_over_tells_what_is_there() -> None:
    bench = RobotBench()
    bench.body.vanish("pink_bar")
    bench.start("pink_bar")
    bench.run_until(Holding)
    bench.body.parts["pink_bar"] = type(STARTS["pink_bar"])(*ITS_PLACE)
    bench.body.at_cycle = passes(bench, ITS_PLACE)
    bench.look(expect="at_place", object="pink_bar", place="left", within_s=0.0)
    bench.run()
    assert bench.of(Looked)[-1].fulfilled is True
