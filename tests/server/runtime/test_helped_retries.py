"""A part that somebody puts right each time and that fails each time is not tried for ever."""

from typing import Any

import pytest
from broken_constraints import broken_constraints
from pretend_service import pretend_service
from task_documents import definition_of
from untruths import find_untruths

from mend.server.journal import events as ev
from mend.server.runtime.context import RunSettings
from mend.server.runtime.views import RunStatus, RunView
from mend.sim.tabletop.layout import lay_out
from mend.tasks.resolution import Resolution

NAMES = [("part_1", "spot_1"), ("part_2", "spot_2")]
SCENE = lay_out(NAMES, seed=1)
LEAVES = [{"behavior": "pick_and_place", "object": part, "place": spot} for part, spot in NAMES]
FOR_EVER = 100


async def run_with(
    goal: str, fault: tuple[str, int], most: int, answers: list[str]
) -> tuple[RunView, list[ev.Event]]:
    """A run in which one fault comes again and again, and every promise is kept."""
    async with pretend_service(
        definition_of({goal: LEAVES}),
        {"part_1": [fault] * FOR_EVER},
        scene=SCENE,
        settings=RunSettings(max_helped_retries=most),
        stubborn=True,
    ) as service:
        view, events = await service.run_to_end(answers=answers)
    assert broken_constraints(events, {node.node: node.kind for node in view.nodes}) == []
    return view, events


def of_type(events: list[ev.Event], kind: type[Any]) -> list[Any]:
    return [each for each in events if isinstance(each, kind)]


def asked(events: list[ev.Event]) -> list[str]:
    return [each.text for each in of_type(events, ev.Prompt) if each.kind == "ask"]


@pytest.mark.parametrize("most", [0, 1, 5])
@pytest.mark.parametrize("fault", [("missed", 4), ("dropped", 5)])
async def test_after_so_many_helped_tries_the_helper_is_asked_to_place_it(
    fault: tuple[str, int], most: int
) -> None:
    view, events = await run_with("then", fault, most, ["yes"] * FOR_EVER)
    assert view.status is RunStatus.FINISHED
    resolutions = [each.resolution for each in of_type(events, ev.Resolved) if each.helped]
    assert resolutions == [*[Resolution.ROBOT_RETRY] * most, Resolution.HUMAN_FINISH]
    assert "I have now failed" in asked(events)[-1]
    assert not [each for each in of_type(events, ev.NodeReset) if each.failed_attempt]


async def test_a_helper_who_does_not_place_it_either_lets_the_attempts_fail() -> None:
    most, refusals = 2, ["no", "no"]
    answers = ["yes"] * most + refusals * 10
    view, events = await run_with("then", ("missed", 4), most, answers)
    assert view.status is RunStatus.FAILED
    assert view.result is not None
    assert view.result.reason == "'part_1' could not be done: it failed 3 times"
    failed = [each for each in of_type(events, ev.NodeReset) if each.failed_attempt]
    assert len(failed) == 3
    assert len(of_type(events, ev.NodeStarted)) == most + 3
    assert find_untruths(events, {}) == []


async def test_a_robot_that_goes_on_after_every_help_stops_offering_it_as_well() -> None:
    view, events = await run_with("then", ("blocked", 6), 3, ["yes"] * FOR_EVER)
    assert view.status is RunStatus.FINISHED
    resolutions = [each.resolution for each in of_type(events, ev.Resolved) if each.helped]
    assert resolutions == [*[Resolution.ROBOT_FINISH] * 3, Resolution.HUMAN_FINISH]


async def test_the_other_alternative_is_taken_instead() -> None:
    view, events = await run_with("or", ("missed", 4), 0, ["no"] * FOR_EVER)
    assert view.status is RunStatus.FINISHED
    assert [each.node for each in of_type(events, ev.NodeDone)] == ["/1"]
    last = [each.text for each in of_type(events, ev.Prompt) if each.kind == "say"][-1]
    assert last == "All right. I take the part 2 instead."


async def test_an_alternative_is_not_promised_that_a_neighbour_may_decide_against() -> None:
    both = [*NAMES, ("part_3", "spot_3")]
    first, second, third = (
        {"behavior": "pick_and_place", "object": part, "place": spot} for part, spot in both
    )
    async with pretend_service(
        definition_of({"or": [{"and": [first, third]}, second]}),
        {"part_1": [("missed", 4)]},
        scene=lay_out(both, seed=1),
        settings=RunSettings(max_helped_retries=0),
        stubborn=True,
    ) as service:
        view, events = await service.run_to_end(answers=["no"] * FOR_EVER)
    assert view.status is RunStatus.FINISHED
    started = [each.node for each in of_type(events, ev.NodeStarted)]
    assert started[0] == "/0/0"
    said = [each.text for each in of_type(events, ev.Prompt) if each.kind == "say"]
    assert said[0] == "All right. I try again (attempt 2 of 3), or I take the part 2 instead."
