"""Whatever keeps the journal from being written: those who wait are told, and none waits on."""

import asyncio
import sqlite3
from collections.abc import Iterator

import pytest
from full_disk import Never, Passing, failing
from sample_events import paused

from mend.server.journal.events import Event
from mend.server.journal.journal import (
    DuplicateReceiptError,
    Entry,
    JournalWriteError,
    Receipt,
)
from mend.server.journal.keyed_request import FirstAnswer, KeyedRequest
from mend.server.journal.sqlite import PROVEN_S, SqliteJournal

IN_TIME_S = 60.0


@pytest.fixture
def journal() -> Iterator[SqliteJournal]:
    journal = SqliteJournal(":memory:", sleep=Never())
    yield journal
    journal.close()


@pytest.mark.parametrize("at", ["BEGIN", "SAVEPOINT", "INSERT", "INSERT INTO batches", "COMMIT"])
@pytest.mark.parametrize(
    ("error", "told"),
    [
        (MemoryError(), "out of memory"),
        (sqlite3.DatabaseError("database disk image is malformed"), "malformed"),
        (sqlite3.InternalError("what nobody knows"), "what nobody knows"),
    ],
)
async def test_whatever_fails_those_who_wait_are_told_and_the_next_can_be_written(
    journal: SqliteJournal, at: str, error: Exception, told: str
) -> None:
    connection = failing(journal, at)
    connection.error = error
    appends = (journal.append(Entry(events=[paused(float(i))])) for i in range(3))
    outcomes = await asyncio.wait_for(
        asyncio.gather(*appends, return_exceptions=True), timeout=IN_TIME_S
    )
    for each in outcomes:
        assert isinstance(each, JournalWriteError)
        assert told in str(each)
    assert told in str(journal.trouble.reason)
    assert journal.head == 0
    connection.error = None
    (event,) = await asyncio.wait_for(journal.append(Entry(events=[paused()])), timeout=IN_TIME_S)
    assert event.seq == 1
    assert journal.trouble.reason is None


async def test_a_fault_of_the_writer_itself_leaves_it_writing(journal: SqliteJournal) -> None:
    failing(journal, "COMMIT").error = RuntimeError("a fault of ours")
    with pytest.raises(JournalWriteError, match="a fault of ours"):
        await asyncio.wait_for(journal.append(Entry(events=[paused()])), timeout=IN_TIME_S)
    failing(journal)
    await asyncio.wait_for(journal.append(Entry(events=[paused()])), timeout=IN_TIME_S)


async def test_who_is_patient_waits_for_a_damaged_page_too() -> None:
    class UntilRepaired(Passing):
        async def __call__(self, delay: float, /) -> None:
            await super().__call__(delay)
            connection.error = None

    journal = SqliteJournal(":memory:", sleep=UntilRepaired())
    connection = failing(journal, "INSERT INTO events")
    connection.error = sqlite3.DatabaseError("database disk image is malformed")
    (event,) = await asyncio.wait_for(
        journal.append(Entry(events=[paused()]), patient=True), timeout=IN_TIME_S
    )
    assert event.seq == 1
    journal.close()


async def test_what_breaks_a_rule_of_the_tables_is_refused_alone(journal: SqliteJournal) -> None:
    bad, good = await asyncio.gather(
        journal._writer.submit(lambda c: c.execute("INSERT INTO worlds (run) VALUES ('a')")),
        journal.append(Entry(events=[paused()])),
        return_exceptions=True,
    )
    assert isinstance(bad, sqlite3.IntegrityError)
    assert not isinstance(good, BaseException)
    assert journal.trouble.reason is None


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
async def test_a_writer_that_has_ended_is_noticed(journal: SqliteJournal) -> None:
    def end(_: sqlite3.Connection) -> None:
        raise SystemExit

    await journal.look()
    assert journal.trouble.reason is None
    waiting = journal._writer.submit(end)
    await asyncio.to_thread(journal._writer._thread.join, IN_TIME_S)
    await journal.look()
    assert "its thread has ended" in str(journal.trouble.reason)
    assert not waiting.done()


async def test_a_disk_that_is_full_is_noticed_before_anybody_has_something_to_write() -> None:
    now = 0.0
    journal = SqliteJournal(":memory:", sleep=Never(), clock=lambda: now)
    connection = failing(journal, "INSERT")
    await journal.append(Entry(events=[paused()]))
    connection.error = "database or disk is full"
    now += PROVEN_S
    await journal.look()
    assert journal.trouble.reason is None, "what was just written proves that more can be"
    now += 0.001
    await journal.look()
    assert "database or disk is full" in str(journal.trouble.reason)
    connection.error = None
    await journal.append(Entry(events=[paused()]))
    assert journal.trouble.reason is None
    journal.close()


async def test_a_commit_that_wrote_nothing_does_not_end_the_trouble(journal: SqliteJournal) -> None:
    receipt = Receipt("arm", "boot", 1)
    await journal.append(Entry(receipt=receipt))
    connection = failing(journal, "INSERT")
    connection.error = "database or disk is full"
    with pytest.raises(JournalWriteError):
        await journal.append(Entry(events=[paused()]))
    with pytest.raises(DuplicateReceiptError):
        await journal.append(Entry(events=[paused()], receipt=receipt))
    assert journal.trouble.reason is not None
    request, answer = KeyedRequest("ann", "key", b""), FirstAnswer(409, (), b"")
    await journal.keep_answer(request, answer, 10, 0.0)
    assert journal.trouble.reason is not None
    connection.error = None
    await journal.append(Entry(events=[paused()]))
    assert journal.trouble.reason is None


async def test_a_fold_that_fails_fails_its_owner_and_nobody_else(journal: SqliteJournal) -> None:
    def fail(_: list[Event]) -> None:
        raise ValueError("these events make no sense")

    folded: list[int] = []

    def fold(events: list[Event]) -> None:
        folded.extend(event.seq for event in events)

    with journal.subscribe(after=0) as subscription:
        bad, good, quiet = await asyncio.wait_for(
            asyncio.gather(
                journal.append(Entry(events=[paused(1.0)]), fail),
                journal.append(Entry(events=[paused(2.0)]), fold),
                journal.append(Entry(events=[paused(3.0)])),
                return_exceptions=True,
            ),
            timeout=IN_TIME_S,
        )
        assert isinstance(bad, ValueError)
        assert not isinstance(good, BaseException)
        assert not isinstance(quiet, BaseException)
        assert folded == [2]
        assert journal.head == 3
        assert [record.seq for record in await subscription.take()]
