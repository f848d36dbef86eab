"""Trees of very many nodes: read, shown and chosen from in pieces, and as small ones are."""

import asyncio
import json
from collections.abc import Awaitable, Callable
from datetime import UTC, datetime
from typing import TypeVar
from uuid import uuid4

import pytest
from pretend_service import pretend_service
from service_under_test import build

import mend.server.turns
from mend.server.api.first_answers import answer_of
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry
from mend.server.journal.sqlite import SqliteJournal
from mend.server.journal.stored_event import UnreadableEventError
from mend.server.journal.subscriptions import Record
from mend.server.runtime.journaled_tree import read_nodes, read_started, read_without_tree
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.run_views import NODES, RunViewing
from mend.tasks.definition import BehaviorNode, GoalNode, TaskTreeDefinition

MANY = 3000

T = TypeVar("T")


def many_alternatives(count: int = MANY) -> TaskTreeDefinition:
    """THEN of an OR with many alternatives and one more leaf."""
    nodes: list[GoalNode | BehaviorNode] = [
        GoalNode(kind="then", parent=None, name="all"),
        GoalNode(kind="or", parent=0, name="any"),
    ]
    nodes += [_leaf(f"red_{number}", "red_box", 1) for number in range(count)]
    return TaskTreeDefinition(name="tree", nodes=[*nodes, _leaf("blue", "blue_box", 0)])


def _leaf(name: str, part: str, parent: int) -> BehaviorNode:
    parameters = {"object": part, "place": part}
    return BehaviorNode(parent=parent, name=name, behavior="pick_and_place", parameters=parameters)


def started(tree: TaskTreeDefinition | None) -> ev.RunStarted:
    return ev.RunStarted(
        time=0.0,
        wall_time=datetime(2026, 1, 1, tzinfo=UTC),
        run=uuid4(),
        tree_name='a "tree":{} of its own',
        tree={} if tree is None else tree.to_json(),
        scene={"tree": {}},
        world="tabletop",
        robots=["pr2"],
        seed=1,
        speed="max",
        scenario=None,
        options={"tree": {}},
    )


@pytest.fixture
def _short_turns(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever is done in pieces passes its turn on after each."""
    monkeypatch.setattr(mend.server.turns, "LONGEST_S", 0.0)


async def turns_of_others(work: Callable[[], Awaitable[T]]) -> tuple[T, int]:
    """What comes of some work, and how often another task had its turn meanwhile."""
    turns = 0

    async def count() -> None:
        nonlocal turns
        while True:
            turns += 1
            await asyncio.sleep(0)

    counting = asyncio.create_task(count())
    result = await work()
    counting.cancel()
    return result, turns


@pytest.mark.usefixtures("_short_turns")
async def test_others_have_their_turn_while_a_run_is_viewed_and_written() -> None:
    async with pretend_service(many_alternatives()) as service:
        run = await service.runtime.start_run(RunRequest(tree="tree", world="tabletop"))
        await service.runtime.wait_for_end(run.id)
        view, turns = await turns_of_others(lambda: service.runtime.run(run.id))
        assert turns >= MANY / NODES
        written, turns = await turns_of_others(lambda: service.runtime.run_json(run.id))
        assert turns >= MANY / NODES
    assert len(view.nodes) == MANY + 3
    assert b"".join(written) == view.model_dump_json().encode()
    assert len(written) >= MANY / NODES


@pytest.mark.usefixtures("_short_turns")
async def test_of_many_who_want_a_large_run_one_is_served_after_the_other(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    at_once: list[int] = []
    writing, write = 0, RunViewing.json

    async def counted(viewing: RunViewing) -> list[bytes]:
        nonlocal writing
        writing += 1
        at_once.append(writing)
        try:
            return await write(viewing)
        finally:
            writing -= 1

    monkeypatch.setattr(RunViewing, "json", counted)
    async with pretend_service(many_alternatives()) as service:
        run = await service.runtime.start_run(RunRequest(tree="tree", world="tabletop"))
        await service.runtime.wait_for_end(run.id)
        await asyncio.gather(*(service.runtime.run_json(run.id) for _ in range(5)))
    assert at_once == [1] * 5


@pytest.mark.usefixtures("_short_turns")
async def test_others_have_their_turn_while_a_tree_is_read() -> None:
    text = many_alternatives().model_dump_json()
    nodes, turns = await turns_of_others(lambda: read_nodes(text))
    assert turns >= MANY
    assert len(nodes) == MANY + 3
    assert nodes.leaf(MANY + 2) == many_alternatives().nodes[-1]


async def test_a_run_of_a_large_tree_goes_on_after_a_restart_and_ends(tmp_path) -> None:
    journal = tmp_path / "journal.db"
    async with pretend_service(many_alternatives(), journal=journal) as service:
        run = await service.runtime.start_run(RunRequest(tree="tree", world="tabletop"))
        tree = service.runtime._states.going_on(run.id).tree
    async with pretend_service(many_alternatives(), journal=journal) as service:
        again = service.runtime._states.going_on(run.id).tree
        assert again.nodes.names == tree.nodes.names
        ended = await service.runtime.wait_for_end(run.id)
        events = await service.journal.read(0, 10_000, run.id)
    assert ended.status == "finished"
    assert [each.name for each in ended.nodes if each.done] == ["all", "any", "red_0", "blue"]
    chosen = next(each for each in events if isinstance(each, ev.NodeStarted))
    assert [each.name for each in chosen.candidates] == [f"red_{n}" for n in range(100)]


async def test_a_tree_that_was_given_as_text_is_journaled_as_any_other() -> None:
    tree = many_alternatives(3)
    journal = SqliteJournal(":memory:")
    whole, empty = started(tree), started(None)
    await journal.append(Entry(events=[whole]))
    await journal.append(Entry(events=[empty], tree=tree.model_dump_json()))
    first, second = await journal.read_records(0, 10)
    journal.close()
    one, two = json.loads(first.text), json.loads(second.text)
    assert {**one, "seq": 2, "run": str(empty.run)} == two
    for record in (first, second):
        event, nodes = await read_started(record)
        assert isinstance(event, ev.RunStarted)
        assert (event.tree, event.scene, event.options) == ({}, {"tree": {}}, {"tree": {}})
        assert nodes is not None
        assert nodes.names == [each.name for each in tree.nodes]


@pytest.mark.parametrize(
    ("change", "what"),
    [
        (('"parent":1,"name":"red_1"', '"parent":7,"name":"red_1"'), "depth-first order"),
        (('"kind":"or"', '"kind":"xor"'), "its tree is none"),
        (('"name":"red_1"', '"name":"red_0"'), "two nodes are called 'red_0'"),
        (('"nodes":[', '"notes":['), "it has no 'nodes'"),
        (('"nodes":[{', '"nodes":[{{'), "its tree is none"),
        (('"nodes":[', '"nodes":' + "[" * 100_000), "its tree is none"),
        (("}}]", "}},]"), "something more was expected"),
        (('"nodes":[', '"nodes":[],"notes":['), "it has no 'nodes'"),
    ],
)
async def test_a_damaged_tree_is_told_of(change: tuple[str, str], what: str) -> None:
    text = started(many_alternatives(3)).model_dump_json().replace(*change, 1)
    with pytest.raises(UnreadableEventError, match=f"event 1 cannot be read.*{what}"):
        await read_started(Record(1, text))


@pytest.mark.usefixtures("_short_turns")
async def test_others_have_their_turn_while_a_tree_is_passed_over() -> None:
    whole = started(many_alternatives())
    record = Record(0, whole.model_dump_json())
    event, turns = await turns_of_others(lambda: read_without_tree(record))
    assert turns >= MANY
    assert event == whole.model_copy(update={"tree": {}})


async def test_a_tree_that_cannot_be_passed_over_is_told_of() -> None:
    text = started(many_alternatives(3)).model_dump_json().replace("[{", "[" * 100_000, 1)
    with pytest.raises(UnreadableEventError, match="event 1 cannot be read: its tree is none"):
        await read_without_tree(Record(1, text))


@pytest.mark.usefixtures("_short_turns")
async def test_the_audit_and_a_first_answer_pass_over_the_tree_of_a_run() -> None:
    service = build()
    run = await service.runs.start_run(RunRequest(tree="eket", world="tabletop"))
    begun = started(many_alternatives()).model_copy(update={"run": run.id})
    await service.journal.append(Entry(events=[begun]))
    async with service.client() as client:
        audit, turns = await turns_of_others(lambda: client.get("/api/access/deeds"))
        assert turns >= MANY
    assert [each["deed"] for each in audit.json()["deeds"]] == ["run_started"] * 2
    answer, turns = await turns_of_others(lambda: answer_of(2, service.app.state.services))
    assert turns >= MANY
    assert (answer.status, json.loads(answer.body)["id"]) == (201, str(run.id))
    service.journal.close()


async def test_an_event_that_begins_no_run_is_read_as_it_is() -> None:
    paused = ev.RunPaused(time=0.0, wall_time=datetime(2026, 1, 1, tzinfo=UTC), run=uuid4())
    assert await read_started(Record(0, paused.model_dump_json())) == (paused, None)
