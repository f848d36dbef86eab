"""A journal belongs to one service, by whatever name its file is opened."""

import asyncio
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from full_disk import Never
from sample_events import paused

from mend.errors import UnavailableError
from mend.server.journal.file_lock import JournalLockedError
from mend.server.journal.journal import Entry, JournalWriteError
from mend.server.journal.sqlite import SqliteJournal

OPENS = """
import sys
from mend.server.journal.sqlite import SqliteJournal
SqliteJournal(sys.argv[1])
"""


def linked(path: Path) -> Path:
    link = path.with_name("link.db")
    link.hardlink_to(path)
    return link


def unlocked(path: Path) -> Path:
    path.with_name(path.name + ".lock").unlink()
    return path


@pytest.mark.parametrize("other", [linked, unlocked])
def test_a_second_service_is_refused_however_it_comes_to_the_file(
    tmp_path: Path, other: Callable[[Path], Path]
) -> None:
    path = tmp_path / "journal.db"
    first = SqliteJournal(path)
    name = other(path)
    with pytest.raises(JournalLockedError, match="in use by another process"):
        SqliteJournal(name)
    second = subprocess.run(
        [sys.executable, "-c", OPENS, str(name)], capture_output=True, text=True, check=False
    )
    assert second.returncode != 0
    assert "in use by another process" in second.stderr
    first.close()
    if name != path:
        name.unlink()
    SqliteJournal(path).close()


async def test_who_is_refused_takes_no_lock_from_who_has_it(tmp_path: Path) -> None:
    path = tmp_path / "journal.db"
    first = SqliteJournal(path)
    await first.append(Entry(events=[paused()]))
    with pytest.raises(JournalLockedError):
        SqliteJournal(linked(path))
    # Of all connections SQLite's own lock tells that there are others.
    last = "import sqlite3, sys; sqlite3.connect(sys.argv[1]).execute('SELECT 1 FROM events')"
    other = await asyncio.create_subprocess_exec(sys.executable, "-c", last, str(path))
    assert await other.wait() == 0
    # The last one of all would have taken the log away.
    await first.append(Entry(events=[paused()]))
    first.close()


def added_by_another(path: Path) -> None:
    """What a program does that has never heard of the lock."""
    other = sqlite3.connect(path)
    other.execute(
        "INSERT INTO events SELECT seq + 1, run, type, time, version, body FROM events"
        " ORDER BY seq DESC LIMIT 1"
    )
    other.commit()
    other.close()


async def test_events_of_another_program_are_told_of_and_nothing_is_put_after_them(
    tmp_path: Path,
) -> None:
    path = tmp_path / "journal.db"
    journal = SqliteJournal(path, sleep=Never())
    await journal.append(Entry(events=[paused()]))
    added_by_another(path)
    with pytest.raises(JournalWriteError, match="another program writes to this journal"):
        await journal.append(Entry(events=[paused()]))
    assert journal.trouble.reason is not None
    await journal._probe()
    assert "another program writes to this journal" in str(journal.trouble.reason)
    journal.close()


async def test_what_another_program_changes_elsewhere_keeps_nobody_from_writing(
    tmp_path: Path,
) -> None:
    path = tmp_path / "journal.db"
    journal = SqliteJournal(path, sleep=Never())
    await journal.append(Entry(events=[paused()]))
    other = sqlite3.connect(path)
    other.execute("DELETE FROM pictures")
    other.execute("INSERT INTO documents (kind, name, text) VALUES ('tree', 'a', 'b')")
    other.commit()
    other.close()
    (event,) = await journal.append(Entry(events=[paused()]))
    assert event.seq == 2
    journal.close()


def test_a_file_with_two_names_is_not_opened_by_either(tmp_path: Path) -> None:
    """What is still in the log beside one name would not be there under the other."""
    path, other = tmp_path / "journal.db", tmp_path / "other" / "journal.db"
    SqliteJournal(path).close()
    other.parent.mkdir()
    other.hardlink_to(path)
    for name in (path, other):
        with pytest.raises(UnavailableError, match="has another name, too"):
            SqliteJournal(name)
    other.unlink()
    SqliteJournal(path).close()
