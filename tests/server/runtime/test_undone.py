"""What is seen gone is done no longer: it is taken back, and nothing is built on it."""

from typing import Any

import pytest
from pretend_service import pretend_service
from task_documents import definition_of

from server.journal import events as ev
from server.journal.audit import audit
from server.runtime.context import RunSettings
from server.runtime.views import RunStatus, RunView
from sim.tabletop.layout import lay_out

NAMES = [(f"part_{i}", f"spot_{i}") for i in range(1, 6)]
SCENE = lay_out(NAMES, seed=1)
LEAVES = [{"behavior": "pick_and_place", "object": part, "place": spot} for part, spot in NAMES]


async def run_with(
    tree: Any, thefts: dict[str, list[str]], *, settings: RunSettings | None = None, **fields: Any
) -> tuple[RunView, list[ev.Event]]:
    """A run in which parts are gone once another one has been placed; its audit finds nothing."""
    async with pretend_service(
        definition_of(tree), scene=SCENE, settings=settings, thefts=thefts
    ) as service:
        view, events = await service.run_to_end(**fields)
    assert audit(events, {node.node: node.kind for node in view.nodes}) == []
    return view, events


def story(events: list[ev.Event]) -> list[str]:
    """What became of the leaves, in order."""
    words = {ev.NodeStarted: "start", ev.NodeDone: "done", ev.NodeUndone: "undone"}
    return [
        f"{words[type(each)]} {each.name.removeprefix('part_')}"
        for each in events
        if isinstance(each, ev.NodeStarted | ev.NodeDone | ev.NodeUndone)
    ]


def in_turn(*numbers: int) -> list[str]:
    return [line for i in numbers for line in (f"start {i}", f"done {i}")]


async def test_what_a_then_puts_after_a_stolen_part_is_taken_back_and_found_in_place() -> None:
    view, events = await run_with({"then": LEAVES}, {"part_3": ["part_1"]}, answers=["yes"])
    assert view.status is RunStatus.FINISHED
    assert story(events) == [
        *in_turn(1, 2, 3),
        *("undone 3", "undone 2", "undone 1"),
        *in_turn(1, 2, 3, 4, 5),
    ]
    undone = [each for each in events if isinstance(each, ev.NodeUndone)]
    assert [each.because_of for each in undone] == ["/0", "/0", None]
    assert undone[-1].reason == "part_1 is no longer at spot_1"
    [issue] = [each for each in events if isinstance(each, ev.IssueRaised)]
    assert (issue.issue, issue.object, issue.step) == ("undone", "part_1", 0)


async def test_an_and_takes_back_the_stolen_part_alone() -> None:
    view, events = await run_with({"and": LEAVES}, {"part_3": ["part_1"]}, answers=["yes"])
    assert view.status is RunStatus.FINISHED
    assert [line for line in story(events) if "undone" in line] == ["undone 1"]


async def test_what_is_stolen_after_everything_is_done_is_seen_by_the_last_look() -> None:
    view, events = await run_with({"and": LEAVES[:2]}, {"part_2": ["part_1"]}, answers=["yes"])
    assert view.status is RunStatus.FINISHED
    assert story(events) == [*in_turn(1, 2), "undone 1", *in_turn(1)]
    assert view.result is not None
    assert (view.result.reason, view.result.missing) == ("the task is done", [])


async def test_with_nobody_there_the_run_fails_naming_the_part_that_is_gone() -> None:
    view, events = await run_with({"then": LEAVES[:2]}, {"part_2": ["part_1"]}, answers="none")
    assert view.status is RunStatus.FAILED
    assert view.result is not None
    assert view.result.reason == "'part_1' could not be done: it failed 3 times"
    issues = [each.issue for each in events if isinstance(each, ev.IssueRaised)]
    assert issues == ["undone"] * 3


async def test_another_alternative_is_taken_when_a_part_is_gone_for_good() -> None:
    tree = {"then": [{"or": LEAVES[:2]}, LEAVES[2]]}
    view, events = await run_with(tree, {"part_3": ["part_1"]}, answers="none")
    assert view.status is RunStatus.FINISHED
    assert view.result is not None
    assert view.result.missing == []
    assert story(events)[-4:] == in_turn(2, 3)


@pytest.mark.parametrize("most", [0, 2])
async def test_what_is_taken_away_each_time_is_not_placed_for_ever(most: int) -> None:
    settings = RunSettings(max_times_gone=most)
    thefts = {"part_1": ["part_1"] * 50}
    view, events = await run_with(
        {"then": LEAVES[:1]}, thefts, settings=settings, answers=["yes"] * 50
    )
    assert view.status is RunStatus.FAILED
    assert view.result is not None
    times = most + 1
    assert view.result.reason == (
        f"'part_1' could not be done: it was gone again after it had been done {times} times"
    )
    assert story(events).count("undone 1") == times


async def test_the_last_leaf_for_a_part_says_where_it_is_to_be() -> None:
    there = {**LEAVES[0], "name": "there"}
    back = {**LEAVES[0], "place": "spot_2", "name": "back"}
    view, events = await run_with(
        {"then": [there, back, LEAVES[2]]}, {"part_3": ["part_1"]}, answers=["yes"]
    )
    assert view.status is RunStatus.FINISHED
    assert [each.name for each in events if isinstance(each, ev.NodeUndone)] == ["part_3", "back"]
