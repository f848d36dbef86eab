"""A journal that cannot be written: robots hold, nothing is lost, and runs go on by themselves."""

import asyncio
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest
from broken_constraints import broken_constraints
from full_disk import FailingConnection, Passing, SmallDisk, small_disk
from pretend_service import PretendService, pretend_service
from task_documents import definition_of

from mend.robots.link.messages import Interrupt, Start
from mend.server.journal import events as ev
from mend.server.journal.journal import JournalWriteError
from mend.server.journal.run_index import RunPage
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus, RunView

THREE_PARTS = definition_of(
    {
        "then": [
            {"behavior": "pick_and_place", "object": f"part_{i}", "place": f"spot_{i}"}
            for i in range(3)
        ]
    }
)
REQUEST = RunRequest(tree="tree", world="tabletop", speed="max")


@pytest.fixture
def disk(tmp_path: Path) -> Iterator[SmallDisk]:
    with small_disk(tmp_path / "disk") as disk:
        yield disk


async def until(condition: Callable[[], bool]) -> None:
    async with asyncio.timeout(60):
        while not condition():  # noqa: ASYNC110
            await asyncio.sleep(0)


@asynccontextmanager
async def working(journal: Path | None = None) -> AsyncIterator[tuple[PretendService, RunView]]:
    """A service with a run whose robot is at its first start until it is interrupted."""
    async with pretend_service(THREE_PARTS, journal=journal, sleep=Passing(), slow=True) as service:
        run = await service.runtime.start_run(REQUEST)
        await until(lambda: any(isinstance(each, Start) for each in commands(service)))
        yield service, run


def commands(service: PretendService) -> list[object]:
    return [each for robot in service.robots.robots.values() for each in robot.commands]


def interrupts(service: PretendService) -> list[bool]:
    """Whether to retreat, of each interrupt that the robot was told."""
    return [each.retreat for each in commands(service) if isinstance(each, Interrupt)]


def failing(service: PretendService) -> FailingConnection:
    """Puts a connection that can fail between the journal's writer and its file."""
    connection = FailingConnection(service.journal._write_connection)
    service.journal._writer._connection = connection  # type: ignore[assignment]
    return connection


async def in_trouble(service: PretendService) -> str:
    """Have a write fail, as another run is asked for."""
    with pytest.raises(JournalWriteError) as failure:
        await service.runtime.start_run(REQUEST)
    return str(failure.value)


async def check_end(service: PretendService, run: RunView, status: RunStatus) -> list[ev.Event]:
    ended = await asyncio.wait_for(service.runtime.wait_for_end(run.id), timeout=60)
    assert ended.status is status
    events = await service.journal.read(0, 10_000, run.id)
    assert [each.seq for each in events] == list(range(1, len(events) + 1))
    assert broken_constraints(events, {node.node: node.kind for node in ended.nodes}) == []
    return events


async def test_on_a_full_disk_robots_hold_and_go_on_when_there_is_space(disk: SmallDisk) -> None:
    async with working(disk.folder / "journal.db") as (service, run):
        disk.fill()
        reason = await in_trouble(service)
        assert reason == "the journal could not be written: database or disk is full"
        assert interrupts(service) == [False]
        assert (await service.runtime.run(run.id)).trouble == reason
        assert [each.trouble for each in await service.runtime.runs(RunPage())] == [reason]
        assert (await service.runtime.run(run.id)).status is RunStatus.RUNNING
        disk.free()
        await check_end(service, run, RunStatus.FINISHED)
        assert (await service.runtime.run(run.id)).trouble is None


async def test_a_disk_that_fills_in_the_middle_of_a_run_loses_nothing(disk: SmallDisk) -> None:
    path = disk.folder / "journal.db"
    async with pretend_service(THREE_PARTS, journal=path, sleep=Passing()) as service:
        with service.journal.subscribe(0) as events:
            run = await service.runtime.start_run(REQUEST)
            seen = 0
            while seen < 5:
                seen += len(await events.take())
        disk.fill()
        await asyncio.wait_for(service.journal.trouble.begun(), timeout=60)
        disk.free()
        await check_end(service, run, RunStatus.FINISHED)


@pytest.mark.parametrize(
    "error", ["disk I/O error", "attempt to write a readonly database", "database or disk is full"]
)
async def test_whatever_keeps_the_journal_from_being_written_robots_hold(error: str) -> None:
    async with working() as (service, run):
        connection = failing(service)
        connection.error = error
        await in_trouble(service)
        assert interrupts(service) == [False]
        connection.error = None
        await check_end(service, run, RunStatus.FINISHED)


async def test_an_abort_stops_the_robots_at_once_and_is_journaled_later(disk: SmallDisk) -> None:
    async with working(disk.folder / "journal.db") as (service, run):
        disk.fill()
        await in_trouble(service)
        aborted = await asyncio.wait_for(service.runtime.abort(run.id), timeout=60)
        assert aborted.status is RunStatus.RUNNING
        assert interrupts(service)[:2] == [False, True]
        starts = sum(isinstance(each, Start) for each in commands(service))
        disk.free()
        events = await check_end(service, run, RunStatus.ABORTED)
        assert isinstance(events[-1], ev.RunAborted)
        assert sum(isinstance(each, Start) for each in commands(service)) == starts


async def test_an_abort_whose_write_is_the_first_to_fail_stops_the_robots_too() -> None:
    async with working() as (service, run):
        connection = failing(service)
        connection.error = "disk I/O error"
        aborted = await asyncio.wait_for(service.runtime.abort(run.id), timeout=60)
        assert aborted.trouble is not None
        assert True in interrupts(service)
        connection.error = None
        await check_end(service, run, RunStatus.ABORTED)


async def test_what_people_ask_for_meanwhile_is_refused_and_changes_nothing() -> None:
    async with working() as (service, run):
        connection = failing(service)
        connection.error = "disk I/O error"
        for _ in range(2):
            with pytest.raises(JournalWriteError, match="disk I/O error"):
                await asyncio.wait_for(service.runtime.pause(run.id), timeout=60)
        connection.error = None
        events = await check_end(service, run, RunStatus.FINISHED)
        assert not [each for each in events if isinstance(each, ev.RunPaused)]


async def test_a_fault_of_ours_meanwhile_fails_the_run_once_it_can_be_written(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with working() as (service, run):
        connection = failing(service)
        connection.error = "disk I/O error"
        await in_trouble(service)

        def broken(*_: object) -> None:
            raise RuntimeError("no such thing")

        monkeypatch.setattr("mend.server.runtime.run.Run._reported", broken)
        connection.error = None
        await check_end(service, run, RunStatus.FAILED)


async def test_the_service_stops_while_its_journal_cannot_be_written() -> None:
    async with asyncio.timeout(60):
        async with working() as (service, _):
            failing(service).error = "disk I/O error"
            await in_trouble(service)
