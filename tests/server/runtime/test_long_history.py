"""A long history: only runs that go on are folded at the start; ended ones when asked for."""

import asyncio
import gc
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any
from uuid import UUID, uuid4

import pytest
from made_up_history import run_id, write_history
from pretend_service import PretendService, pretend_service
from task_documents import definition_of

from mend.errors import ConflictError, NotFoundError, UnreadableError
from mend.server.journal import events as ev
from mend.server.journal.pruning import Keep
from mend.server.journal.run_index import RunPage
from mend.server.runtime.history import MOST_KEPT
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus

RUNS = 30
TWO_PARTS = definition_of(
    {
        "then": [
            {"behavior": "pick_and_place", "object": f"part_{i}", "place": f"spot_{i}"}
            for i in range(2)
        ]
    }
)
REQUEST = RunRequest(tree="tree", world="tabletop", speed="max")


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "journal.db"
    write_history(path, RUNS)
    return path


async def listed(service: PretendService, **page: Any) -> list[UUID]:
    return [each.id for each in await service.runtime.runs(RunPage(**page))]


async def test_only_runs_that_have_not_ended_are_folded_at_the_start(
    path: Path, folded: list[UUID]
) -> None:
    async with pretend_service(TWO_PARTS, journal=path, deaf=True) as service:
        run = (await service.runtime.start_run(REQUEST)).id
    assert folded == []
    async with pretend_service(TWO_PARTS, journal=path, boot=2) as service:
        assert folded == [run]
        assert (await service.runtime.wait_for_end(run)).status is RunStatus.FINISHED


async def test_runs_are_listed_and_a_helper_comes_without_folding_any_that_ended(
    path: Path, folded: list[UUID]
) -> None:
    async with pretend_service(TWO_PARTS, journal=path) as service:
        assert await listed(service) == [run_id(n) for n in reversed(range(RUNS))]
        assert (await service.runtime.snapshot(None)).runs == []
        assert (await service.runtime.count_runs())[RunStatus.FINISHED] == RUNS
        [one] = await service.runtime.runs(RunPage(limit=1))
    assert folded == []
    assert one.status is RunStatus.FINISHED
    assert one.result is not None
    assert (one.tree, one.world, one.result.reason) == ("made_up", "tabletop", "the task is done")
    assert one.ended is not None


async def test_the_line_about_an_ended_run_is_the_same_from_the_index_as_from_its_events(
    path: Path,
) -> None:
    async with pretend_service(TWO_PARTS, journal=path) as service:
        own, _ = await service.run_to_end()
        for line in await service.runtime.runs(RunPage()):
            view = await service.runtime.run(line.id)
            assert line.model_dump() == view.model_dump(include=set(type(line).model_fields))
        assert own.id in await listed(service)


async def test_pages_go_on_where_they_were_whatever_begins_meanwhile(path: Path) -> None:
    async with pretend_service(TWO_PARTS, journal=path) as service:
        first = await listed(service, limit=10)
        await service.run_to_end()
        second = await listed(service, limit=10, before=first[-1])
        assert first + second == [run_id(n) for n in reversed(range(RUNS - 20, RUNS))]
        assert await listed(service, limit=3, offset=RUNS - 1) == [run_id(1), run_id(0)]
        assert await listed(service, statuses=["running", "paused"]) == []
        assert len(await listed(service, statuses=["finished"], limit=1000)) == RUNS + 1
        with pytest.raises(NotFoundError):
            await listed(service, before=uuid4())


async def test_ended_runs_are_folded_when_asked_for_and_few_are_kept(
    path: Path, folded: list[UUID]
) -> None:
    async with pretend_service(TWO_PARTS, journal=path) as service:
        for _ in range(2):
            view = await service.runtime.run(run_id(3))
        assert folded == [run_id(3)]
        assert [node.done for node in view.nodes] == [True] * 5
        for number in range(RUNS):
            await service.runtime.run(run_id(number))
        assert len(service.runtime._states._history._kept) == MOST_KEPT
        assert service.runtime._states._going_on == {}
        with pytest.raises(ConflictError, match="has ended"):
            await service.runtime.pause(run_id(3))


async def test_a_run_that_ends_is_let_go_of(path: Path, folded: list[UUID]) -> None:
    async with pretend_service(TWO_PARTS, journal=path) as service:
        view, _ = await service.run_to_end()
        assert service.runtime._states._going_on == {}
        assert (await service.runtime.run(view.id)).status is RunStatus.FINISHED
    assert folded == []


async def test_dialogues_of_ended_runs_are_found(path: Path) -> None:
    async with pretend_service(TWO_PARTS, journal=path) as service:
        page = await service.runtime.dialogues.page("closed", 5, 2)
        assert [each.run for each in page] == [run_id(n) for n in range(2, 7)]
        found = await service.runtime.dialogues.view(page[0].dialogue)
        assert (found.status, found.answered_by) == ("closed", "anna")
        assert await service.runtime.dialogues.page("open", 100, 0) == []


async def test_a_pruned_run_is_unknown_also_if_it_was_just_looked_at(path: Path) -> None:
    async with pretend_service(TWO_PARTS, journal=path) as service:
        view = await service.runtime.run(run_id(0))
        assert view.ended is not None
        await service.journal.prune(Keep(ended_runs=1), view.ended)
        with pytest.raises(NotFoundError, match="ended runs have been pruned"):
            await service.runtime.run(run_id(0))


def alter(path: Path, statement: str, *parameters: object) -> None:
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute(statement, parameters)


@pytest.fixture
async def interrupted(path: Path) -> UUID:
    """A run that goes on in the journal."""
    async with pretend_service(TWO_PARTS, journal=path, deaf=True) as service:
        return (await service.runtime.start_run(REQUEST)).id


async def test_a_run_whose_events_were_changed_is_not_taken_up_but_listed(
    path: Path, interrupted: UUID
) -> None:
    changed = "UPDATE events SET body = replace(body, 'spot_1', 'spot_0') WHERE run = ?"
    alter(path, changed, str(interrupted))
    for _ in range(2):
        async with pretend_service(TWO_PARTS, journal=path, boot=2) as service:
            assert service.journal.damage
            [line] = await service.runtime.runs(RunPage(statuses=["unreadable"]))
            assert line.id == interrupted
            assert line.result is not None
            assert "not what was committed" in line.result.reason
            with pytest.raises(UnreadableError, match="not what was committed"):
                await service.runtime.run(interrupted)
            assert (await service.runtime.snapshot(None)).runs == []
            assert service.robots.robots == {}
            assert (await service.run_to_end())[0].status is RunStatus.FINISHED


async def test_a_run_that_can_be_read_again_goes_on(path: Path, interrupted: UUID) -> None:
    body = "SELECT body FROM events WHERE type = 'run_started' AND run = ?"
    with closing(sqlite3.connect(path)) as connection:
        (text,) = connection.execute(body, (str(interrupted),)).fetchone()
    write = "UPDATE events SET body = ? WHERE type = 'run_started' AND run = ?"
    alter(path, write, "{}", str(interrupted))
    async with pretend_service(TWO_PARTS, journal=path, boot=2) as service:
        assert (await service.runtime.count_runs())[RunStatus.UNREADABLE] == 1
    alter(path, write, text, str(interrupted))
    async with pretend_service(TWO_PARTS, journal=path, boot=3) as service:
        ended = await service.runtime.wait_for_end(interrupted)
    assert ended.status is RunStatus.FINISHED


async def test_an_older_journal_is_indexed_as_it_is_opened(path: Path, interrupted: UUID) -> None:
    added = ("runs", "dialogues", "batches", "pruning", "pruned", "requests", "issues")
    for table in (*added, "picks", "questions"):
        alter(path, f"DROP TABLE {table}")
    alter(path, "ALTER TABLE receipts DROP COLUMN time")
    alter(path, "DELETE FROM schema_version WHERE version >= 3")
    async with pretend_service(TWO_PARTS, journal=path, boot=2) as service:
        assert await listed(service, limit=2) == [interrupted, run_id(RUNS - 1)]
        assert service.journal.damage == []
        await service.runtime.wait_for_end(interrupted)
        ended = await service.journal.read(0, 10_000, interrupted)
    assert isinstance(ended[-1], ev.RunFinished)


async def test_nothing_is_kept_of_the_tasks_of_runs_that_ended(path: Path) -> None:
    async with pretend_service(TWO_PARTS, journal=path) as service:
        names = set[str]()
        for _ in range(3):
            started = await service.runtime.start_run(REQUEST)
            await service.runtime.wait_for_end(started.id)
            names.add(f"run {started.id}")
            del started
        gc.collect()
        left = [
            each
            for each in gc.get_objects()
            if isinstance(each, asyncio.Task) and each.get_name() in names
        ]
        assert left == []
