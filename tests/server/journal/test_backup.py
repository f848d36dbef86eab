"""Backups: whole while the journal is written, and put back as they were made."""

import asyncio
import json
import sqlite3
from collections.abc import AsyncIterator, Callable
from contextlib import closing
from pathlib import Path

import pytest
from checked_journal import checked, truncated
from forked_mend import FORKED
from made_up_history import write_history
from sample_events import paused
from service_process import service_process
from two_boxes import BENCH, BOTH
from typer.testing import CliRunner

from mend.errors import MendError
from mend.server.cli import app
from mend.server.client import MendClient
from mend.server.client_stream import EventStream
from mend.server.journal.backup import back_up, restore
from mend.server.journal.events import Event
from mend.server.journal.file_lock import JournalLockedError
from mend.server.journal.journal import Entry
from mend.server.journal.migrations import JournalSchemaError
from mend.server.journal.sqlite import SqliteJournal
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import Snapshot


def contents(path: Path) -> list[str]:
    with closing(sqlite3.connect(path)) as connection:
        return list(connection.iterdump())


async def test_a_copy_made_while_the_journal_is_written_is_whole(tmp_path: Path) -> None:
    path, target = tmp_path / "journal.db", tmp_path / "copy.db"
    write_history(path, 20)
    journal = SqliteJournal(path)
    stop = asyncio.Event()

    async def write() -> int:
        count = 0
        while not stop.is_set():
            await journal.append(Entry(events=[paused(float(count))]))
            count += 1
        return count

    writing = asyncio.create_task(write())
    for _ in range(5):
        await asyncio.to_thread(back_up, path, target, force=True)
        broken = [
            e for e in checked(target).findings if "chain" in e.sentence or "commit" in e.sentence
        ]
        assert broken == []
    stop.set()
    assert await writing > 0
    journal.close()


def test_a_restored_journal_is_the_one_that_was_backed_up(tmp_path: Path) -> None:
    path, target = tmp_path / "journal.db", tmp_path / "copy.db"
    write_history(path, 3)
    before = contents(path)
    back_up(path, target)
    write_history(path, 2, first=3)
    assert contents(path) != before
    restore(target, path, force=True)
    assert contents(path) == before
    assert sorted(each.name for each in tmp_path.iterdir()) == [
        "copy.db", "journal.db", "journal.db.lock",
    ]  # fmt: skip


async def test_what_the_log_of_the_old_journal_holds_does_not_spoil_the_restored_one(
    tmp_path: Path,
) -> None:
    path, target = tmp_path / "journal.db", tmp_path / "copy.db"
    write_history(path, 3)
    back_up(path, target)
    before = contents(target)
    journal = SqliteJournal(path)
    for number in range(200):
        await journal.append(Entry(events=[paused(float(number))]))
    log = path.with_name("journal.db-wal").read_bytes()
    journal.close()
    # As a kill leaves it.
    path.with_name("journal.db-wal").write_bytes(log)
    restore(target, path, force=True)
    assert contents(path) == before


def test_a_file_that_is_there_is_replaced_only_by_force(tmp_path: Path) -> None:
    path, target = tmp_path / "journal.db", tmp_path / "copy.db"
    write_history(path, 1)
    target.write_text("precious")
    with pytest.raises(MendError, match="is there already: give --force"):
        back_up(path, target)
    assert target.read_text() == "precious"
    back_up(path, target, force=True)
    with pytest.raises(MendError, match="is there already"):
        restore(target, path)
    with pytest.raises(MendError, match="is the journal itself"):
        back_up(path, path, force=True)
    with pytest.raises(MendError, match="is a directory"):
        back_up(path, tmp_path)


def test_a_damaged_backup_replaces_nothing(tmp_path: Path) -> None:
    path, target = tmp_path / "journal.db", tmp_path / "copy.db"
    write_history(path, 30, pictures=True)
    back_up(path, target)
    before = contents(path)
    truncated(target)
    with pytest.raises((MendError, JournalSchemaError)):
        restore(target, path, force=True)
    assert contents(path) == before


def test_a_journal_in_use_is_not_replaced(tmp_path: Path) -> None:
    path, target = tmp_path / "journal.db", tmp_path / "copy.db"
    write_history(path, 1)
    back_up(path, target)
    journal = SqliteJournal(path)
    with pytest.raises(JournalLockedError):
        restore(target, path, force=True)
    journal.close()


def test_a_backup_does_not_replace_the_journal_of_another_service(tmp_path: Path) -> None:
    path, other = tmp_path / "journal.db", tmp_path / "other.db"
    write_history(path, 1)
    journal = SqliteJournal(other)
    with pytest.raises(JournalLockedError, match="in use by another process"):
        back_up(path, other, force=True)
    journal.close()
    back_up(path, other, force=True)
    assert contents(other) == contents(path)


@pytest.mark.parametrize("put", [restore, back_up])
async def test_a_journal_whose_log_cannot_be_emptied_is_not_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, put: Callable[..., None]
) -> None:
    monkeypatch.setattr("mend.server.journal.backup.BUSY_TIMEOUT_S", 0.0)
    path, source = tmp_path / "journal.db", tmp_path / "source.db"
    write_history(source, 1)
    write_history(path, 1)
    with closing(sqlite3.connect(path, isolation_level=None)) as reader:
        # Whose log holds what the file does not, as long as somebody reads from before that.
        reader.execute("BEGIN")
        reader.execute("SELECT count(*) FROM events").fetchone()
        journal = SqliteJournal(path)
        await journal.append(Entry(events=[paused(7.0)]))
        journal.close()
        with pytest.raises(MendError, match=r"log of .* could not be emptied"):
            put(source, path, force=True)
        reader.execute("ROLLBACK")
        (last,) = reader.execute("SELECT max(time) FROM events WHERE type = 'run_paused'")
        assert last == (7.0,)
    put(source, path, force=True)
    assert contents(path) == contents(source)


def test_a_journal_that_is_none_any_more_is_replaced_all_the_same(tmp_path: Path) -> None:
    path, target = tmp_path / "journal.db", tmp_path / "copy.db"
    write_history(path, 1)
    back_up(path, target)
    path.write_bytes(b"nothing that makes sense" * 1000)
    path.with_name("journal.db-wal").write_bytes(b"nor this")
    restore(target, path, force=True)
    assert contents(path) == contents(target)


async def aislice(stream: EventStream, count: int) -> AsyncIterator[Snapshot | Event]:
    async for message in stream:
        yield message
        count -= 1
        if count == 0:
            return


def mend(*arguments: str) -> tuple[int, str]:
    outcome = CliRunner().invoke(app, ["journal", *arguments])
    return outcome.exit_code, outcome.output + str(outcome.exception or "")


def test_all_of_it_from_the_command_line(tmp_path: Path) -> None:
    path, target = tmp_path / "journal.db", tmp_path / "copy.db"
    write_history(path, 5)
    assert mend("backup", str(target), "--journal", str(path))[0] == 0
    code, output = mend("prune", "--runs", "2", "--journal", str(path))
    assert (code, "3 runs" in output) == (0, True)
    assert mend("check", str(path)) == (0, f"{path}: 2 runs, {2 * 48} events, nothing is wrong\n")
    assert mend("restore", str(target), "--journal", str(path))[0] != 0
    assert mend("restore", str(target), "--journal", str(path), "--force")[0] == 0
    assert mend("check", str(path))[1].startswith(f"{path}: 5 runs")
    assert "--runs: " in mend("prune", "--runs", "0", "--journal", str(path))[1]


@pytest.mark.slow(2)
async def test_a_backup_of_a_killed_service_goes_on_where_it_was(tmp_path: Path) -> None:
    target = tmp_path / "copy.db"
    async with service_process(tmp_path, forked=FORKED) as service:
        async with MendClient(service.url) as client:
            await client.upload_scene(BENCH)
            await client.upload_tree(BOTH)
            run = await client.start_run(
                RunRequest(tree="both", world="tabletop", speed=5.0, answers=["yes"] * 9)
            )
            async with asyncio.timeout(60), client.follow("watcher", after=0) as stream:
                seen = [message async for message in aislice(stream, 6)]
            assert len(seen) == 6
            await asyncio.to_thread(back_up, service.journal, target)
            known = [each.seq for each in await client.events(run.id, limit=1000)]
        await service.kill()
        await asyncio.to_thread(restore, target, service.journal, force=True)
        await service.start()
        async with MendClient(service.url) as client:
            ended = await client.wait_for_end(run.id)
            after = [each.seq for each in await client.events(run.id, limit=1000)]
            ready = json.loads((await client._request("GET", "/readyz")).content)
    assert ended.status == "finished"
    assert known[:5] == after[:5]
    counts = {"unreadable_runs": 0, "unreadable_events": 0, "damaged": 0}
    assert ready == {"status": "ok", **counts, "damage": []}
