"""A journal whose file is deleted, moved or replaced while it is open."""

import asyncio
from collections.abc import Callable
from pathlib import Path

import pytest
from full_disk import Never, Passing
from sample_events import paused

from mend.server.journal.journal import Entry, JournalWriteError
from mend.server.journal.sqlite import SqliteJournal


def delete(path: Path) -> None:
    path.unlink()


def move(path: Path) -> None:
    path.rename(path.with_name("elsewhere.db"))


def replace(path: Path) -> None:
    copy = path.with_name("copy.db")
    copy.write_bytes(path.read_bytes())
    copy.replace(path)


def delete_log(path: Path) -> None:
    path.with_name(path.name + "-wal").unlink()


def put_back(path: Path) -> None:
    path.with_name("elsewhere.db").rename(path)


@pytest.mark.parametrize(
    ("harm", "told"),
    [
        (delete, "was deleted or moved"),
        (move, "was deleted or moved"),
        (replace, "was replaced by another one"),
        (delete_log, r"-wal' was deleted or moved"),
    ],
)
async def test_nothing_is_acknowledged_that_nobody_could_read_again(
    tmp_path: Path, harm: Callable[[Path], None], told: str
) -> None:
    path = tmp_path / "journal.db"
    journal = SqliteJournal(path, sleep=Never())
    await journal.append(Entry(events=[paused()]))
    harm(path)
    with pytest.raises(JournalWriteError, match=told):
        await journal.append(Entry(events=[paused()]))
    assert journal.head == 1
    assert journal.trouble.reason is not None
    journal.close()


async def test_a_file_that_is_put_back_is_written_again(tmp_path: Path) -> None:
    path = tmp_path / "journal.db"
    journal = SqliteJournal(path, sleep=Passing())
    await journal.append(Entry(events=[paused()]))
    move(path)
    waiting = asyncio.create_task(journal.append(Entry(events=[paused(2.0)]), patient=True))
    await asyncio.wait_for(journal.trouble.begun(), timeout=60)
    put_back(path)
    (event,) = await asyncio.wait_for(waiting, timeout=60)
    assert event.seq == 2
    journal.close()
    again = SqliteJournal(path)
    assert [each.time for each in await again.read(0, 10)] == [1.0, 2.0]
    assert again.damage == []
    again.close()


async def test_it_is_noticed_before_anything_is_to_be_written(tmp_path: Path) -> None:
    path = tmp_path / "journal.db"
    journal = SqliteJournal(path, sleep=Never())
    await journal.look()
    assert journal.trouble.reason is None
    delete(path)
    await journal.look()
    assert "was deleted or moved" in str(journal.trouble.reason)
    journal.close()
