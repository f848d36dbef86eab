"""A part that somebody puts right each time and that fails each time is not tried for ever."""

from typing import Any

import pytest
from pretend_service import pretend_service
from task_documents import definition_of

from server.journal import events as ev
from server.journal.audit import audit
from server.journal.untruths import find_untruths
from server.runtime.context import RunSettings
from server.runtime.views import RunStatus, RunView
from sim.tabletop.layout import lay_out
from tasks.resolution import Resolution

NAMES = [("part_1", "spot_1"), ("part_2", "spot_2")]
SCENE = lay_out(NAMES, seed=1)
LEAVES = [{"behavior": "pick_and_place", "object": part, "place": spot} for part, spot in NAMES]
FOR_EVER = 100


async def run_with(goal: str, fault: tuple[str, int], most: int) -> tuple[RunView, list[ev.Event]]:
    """A run in which one fault comes again and again, and every help is given."""
    async with pretend_service(
        definition_of({goal: LEAVES}),
        {"part_1": [fault] * FOR_EVER},
        scene=SCENE,
        settings=RunSettings(max_helped_retries=most),
        stubborn=True,
    ) as service:
        view, events = await service.run_to_end(answers=["yes"] * FOR_EVER)
    assert audit(events, {node.node: node.kind for node in view.nodes}) == []
    return view, events


def helped(events: list[ev.Event]) -> list[Any]:
    return [each for each in events if isinstance(each, ev.Resolved) and each.helped]


@pytest.mark.parametrize("most", [0, 1, 5])
@pytest.mark.parametrize("fault", [("missed", 4), ("dropped", 5)])
async def test_a_leaf_that_fails_after_every_help_gives_up(
    fault: tuple[str, int], most: int
) -> None:
    view, events = await run_with("then", fault, most)
    assert view.status is RunStatus.FAILED
    assert view.result is not None
    assert view.result.reason == (
        f"'part_1' could not be done: it failed again after {most} helped retries"
    )
    assert view.result.node == "/0"
    assert {each.resolution for each in helped(events)} == {Resolution.ROBOT_RETRY}
    assert len(helped(events)) == most + 1
    assert sum(isinstance(each, ev.NodeStarted) for each in events) == most + 1
    assert find_untruths(events, {}) == []


async def test_a_robot_that_goes_on_after_every_help_gives_up_as_well() -> None:
    view, events = await run_with("then", ("blocked", 6), 3)
    assert {each.resolution for each in helped(events)} == {Resolution.ROBOT_FINISH}
    assert view.result is not None
    assert "it failed again after 3 helped retries" in view.result.reason
    assert len(helped(events)) == 4


async def test_the_other_alternative_is_taken_instead() -> None:
    view, events = await run_with("or", ("missed", 4), 2)
    assert view.status is RunStatus.FINISHED
    [abandoned] = [each for each in events if isinstance(each, ev.NodeAbandoned)]
    assert abandoned.node == abandoned.leaf == "/0"
    assert abandoned.reason == "it failed again after 2 helped retries"
    assert [each.node for each in events if isinstance(each, ev.NodeDone)] == ["/1"]


async def test_a_reason_that_counts_too_many_helped_retries_is_untrue() -> None:
    _, events = await run_with("then", ("missed", 4), 2)
    said = "'part_1' could not be done: it failed again after 3 helped retries"
    assert find_untruths([*events[:-1], events[-1].model_copy(update={"reason": said})], {}) != []
