"""Who looks one thing up in the journal does not wait for those who read much of it."""

import asyncio
import sqlite3
import threading
from pathlib import Path
from uuid import uuid4

import pytest
from sample_events import RUN, paused, started

from mend.server.journal.journal import Entry, JournalClosedError, Receipt
from mend.server.journal.sqlite import SqliteJournal

IN_TIME_S = 60.0


async def test_look_ups_are_answered_while_somebody_reads_for_long(tmp_path: Path) -> None:
    journal = SqliteJournal(tmp_path / "journal.db")
    picture = uuid4()
    await journal.append(
        Entry(
            events=[started()],
            receipt=Receipt("arm", "boot", 4),
            world_run=RUN,
            world={"clock": 1.0},
            pictures={picture: b"jpeg"},
        )
    )
    read_enough = threading.Event()

    def read_for_long(connection: sqlite3.Connection) -> int:
        assert read_enough.wait(IN_TIME_S)
        return int(connection.execute("SELECT count(*) FROM events").fetchone()[0])

    reading = asyncio.create_task(journal._pages.query(read_for_long))
    async with asyncio.timeout(IN_TIME_S / 2):
        assert await journal.received("arm", "boot") == 4
        assert await journal.find_request("ann", "key", 0.0) is None
        assert await journal.world(RUN) == {"clock": 1.0}
        assert await journal.picture(picture) == b"jpeg"
        assert await journal.index.find(RUN) is not None
        assert await journal.index.run_of(uuid4()) is None
        assert await journal.pruned_through() == 0
        # What is committed meanwhile is found, too.
        await journal.append(Entry(receipt=Receipt("arm", "boot", 5)))
        assert await journal.received("arm", "boot") == 5
    assert not reading.done()
    read_enough.set()
    assert await reading == 1
    journal.close()


async def test_nothing_is_looked_up_in_a_closed_journal() -> None:
    journal = SqliteJournal(":memory:")
    await journal.append(Entry(events=[started(), paused()]))
    journal.close()
    with pytest.raises(JournalClosedError):
        await journal.received("arm", "boot")
    with pytest.raises(JournalClosedError):
        await journal.index.find(RUN)


async def test_a_journal_in_memory_is_closed_only_once_nobody_reads_it() -> None:
    journal = SqliteJournal(":memory:")
    begun, read_on = threading.Event(), threading.Event()

    def read_later(connection: sqlite3.Connection) -> int:
        begun.set()
        assert read_on.wait(IN_TIME_S)
        return int(connection.execute("SELECT count(*) FROM events").fetchone()[0])

    reading = asyncio.create_task(journal._look_ups.query(read_later))
    await asyncio.to_thread(begun.wait, IN_TIME_S)
    closing = asyncio.create_task(asyncio.to_thread(journal.close))
    await asyncio.wait([closing], timeout=0.1)
    read_on.set()
    assert await reading == 0
    await closing
