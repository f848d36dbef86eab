"""What finished leaves left behind: judged by looks, and found in place when it is done again."""

from typing import Any

import pytest
from drawn_scene import TABLE_Z, Resting
from robot_bench import RobotBench
from scripted_body import PLACES

from mend.robots.link.messages import (
    Finished,
    FinishedResult,
    IssueDetected,
    Looked,
    Start,
    StepStarted,
)

BAR = FinishedResult(object="pink_bar", place="left")
LEG = FinishedResult(object="green_leg", place="right")


def bench_with(**parts: Resting) -> RobotBench:
    bench = RobotBench()
    bench.body.parts.update(parts)
    return bench


def at(place: str, **moved: float) -> Resting:
    where = PLACES[place]
    z = TABLE_Z if where.z is None else where.z
    return Resting(where.x + moved.get("x", 0.0), where.y + moved.get("y", 0.0), z, where.yaw)


def lid(place: str) -> Resting:
    """Where the top lies that hides a place from above."""
    return Resting(PLACES[place].x, PLACES[place].y, TABLE_Z + 0.045)


def judged(bench: RobotBench, *results: FinishedResult) -> Looked:
    bench.look(finished=list(results))
    bench.run()
    return bench.of(Looked)[-1]


def restart(bench: RobotBench, was_done: Any, name: str = "pink_bar", place: str = "left") -> None:
    bench.send(
        Start(
            execution="e",
            node="/0",
            behavior="pick_and_place",
            parameters={"object": name, "place": place},
            was_done=was_done,
        )
    )
    bench.run()


def test_what_stands_at_its_place_is_there() -> None:
    looked = judged(bench_with(pink_bar=at("left")), BAR)
    assert (looked.there, looked.gone) == ([BAR], [])


def test_what_stands_elsewhere_and_what_is_nowhere_is_gone() -> None:
    bench = bench_with(pink_bar=at("left", y=-0.12))
    bench.body.vanish("green_leg")
    looked = judged(bench, BAR, LEG)
    assert (looked.there, looked.gone) == ([], [BAR, LEG])


def test_what_still_covers_most_of_its_place_but_is_off_it_is_gone() -> None:
    looked = judged(bench_with(pink_bar=at("left", x=0.03)), BAR)
    assert (looked.there, looked.gone) == ([], [BAR])


def test_what_something_hides_is_neither_there_nor_gone() -> None:
    bench = bench_with()
    bench.body.vanish("pink_bar")
    bench.body.parts["purple_top"] = lid("left")
    looked = judged(bench, BAR)
    assert (looked.there, looked.gone) == ([], [])


def test_what_is_gone_in_one_picture_only_is_not_gone() -> None:
    bench = bench_with()
    bench.body.vanish("pink_bar")
    pictures = bench.body.cameras["head"]

    def come_back() -> None:
        if pictures.pictures_taken == 1:
            bench.body.parts["pink_bar"] = at("left")

    bench.body.at_cycle = come_back
    looked = judged(bench, BAR)
    assert (looked.there, looked.gone) == ([BAR], [])
    assert pictures.pictures_taken == 2


def test_what_this_robot_does_not_know_it_does_not_judge() -> None:
    looked = judged(
        bench_with(),
        FinishedResult(object="teapot", place="left"),
        FinishedResult(object="pink_bar", place="nowhere"),
    )
    assert (looked.there, looked.gone) == ([], [])


@pytest.mark.parametrize("was_done", [None, "there", "gone"])
def test_what_is_seen_at_its_place_is_finished_without_moving(was_done: Any) -> None:
    bench = bench_with(pink_bar=at("left"))
    restart(bench, was_done)
    assert bench.of(Finished) == [Finished(execution="e", found_in_place=True)]
    assert bench.of(StepStarted) == []


def test_what_was_placed_and_is_hidden_since_is_found_in_place() -> None:
    bench = bench_with()
    bench.body.vanish("pink_bar")
    bench.body.parts["purple_top"] = lid("left")
    restart(bench, "there")
    assert bench.of(Finished) == [Finished(execution="e", found_in_place=True)]


@pytest.mark.parametrize(("was_done", "issue"), [("gone", "undone"), (None, "missing")])
def test_what_is_hidden_but_was_not_left_there_is_not_believed_to_be_there(
    was_done: Any, issue: str
) -> None:
    bench = bench_with()
    bench.body.vanish("pink_bar")
    bench.body.parts["purple_top"] = lid("left")
    restart(bench, was_done)
    assert bench.of(Finished) == []
    assert [each.issue for each in bench.of(IssueDetected)] == [issue]


def test_what_was_taken_from_its_place_and_stands_in_reach_is_placed_again() -> None:
    bench = bench_with()
    restart(bench, "gone")
    [issue] = bench.of(IssueDetected)
    assert (issue.issue, issue.step, issue.interrupts) == ("undone", 0, False)
    assert bench.of(Finished) == [Finished(execution="e")]
    assert judged(bench, BAR).there == [BAR]
