import asyncio
import math
import sqlite3
from collections.abc import Iterator
from pathlib import Path
from uuid import UUID, uuid4

import pytest
from full_disk import FailingConnection, Passing, failing
from sample_events import RUN, paused, started

from mend.errors import UnavailableError
from mend.server.journal.file_lock import JournalLockedError
from mend.server.journal.journal import (
    Document,
    DuplicateReceiptError,
    Entry,
    JournalClosedError,
    JournalWriteError,
    Receipt,
)
from mend.server.journal.migrations import JournalSchemaError
from mend.server.journal.sqlite import SqliteJournal


@pytest.fixture(params=["file", "memory"])
def journal(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[SqliteJournal]:
    journal = SqliteJournal(tmp_path / "journal.db" if request.param == "file" else ":memory:")
    yield journal
    journal.close()


async def test_events_are_numbered_from_one_without_gaps(journal: SqliteJournal) -> None:
    assert journal.head == 0
    first = await journal.append(Entry(events=[started(), paused()]))
    second = await journal.append(Entry(events=[paused(2.0)]))
    assert [event.seq for event in first + second] == [1, 2, 3]
    assert journal.head == 3
    assert await journal.read(0, 10) == first + second
    assert await journal.read(1, 1) == first[1:]


async def test_concurrent_producers_share_one_sequence(journal: SqliteJournal) -> None:
    async def produce(run: UUID) -> list[int]:
        return [
            event.seq
            for _ in range(20)
            for event in await journal.append(Entry(events=[paused(run=run), paused(run=run)]))
        ]

    runs = [uuid4() for _ in range(16)]
    numbers = await asyncio.gather(*(produce(run) for run in runs))
    assert sorted(seq for each in numbers for seq in each) == list(range(1, 641))
    for run, mine in zip(runs, numbers, strict=True):
        assert [event.seq for event in await journal.read(0, 1000, run)] == mine


async def test_duplicate_receipt_commits_nothing_and_leaves_no_gap(journal: SqliteJournal) -> None:
    receipt = Receipt("arm", "boot", 1)
    await journal.append(Entry(events=[paused()], receipt=receipt))
    picture = uuid4()
    outcomes = await asyncio.gather(
        journal.append(Entry(events=[paused(5.0)])),
        journal.append(Entry(events=[paused(6.0)], receipt=receipt, pictures={picture: b"x"})),
        journal.append(Entry(events=[paused(7.0)])),
        return_exceptions=True,
    )
    assert isinstance(outcomes[1], DuplicateReceiptError)
    assert [event.time for event in await journal.read(0, 10)] == [1.0, 5.0, 7.0]
    assert journal.head == 3
    assert await journal.picture(picture) is None


async def test_receipts_are_kept_per_boot(journal: SqliteJournal) -> None:
    await journal.append(Entry(receipt=Receipt("arm", "first", 4)))
    await journal.append(Entry(receipt=Receipt("arm", "second", 1)))
    assert await journal.received("arm", "first") == 4
    assert await journal.received("arm", "second") == 1
    assert await journal.received("other", "first") == 0


async def test_latest_world_replaces_the_one_before(journal: SqliteJournal) -> None:
    await journal.append(Entry(world_run=RUN, world={"clock": 1.0}))
    await journal.append(Entry(world_run=RUN, world={"clock": 2.0}))
    assert await journal.world(RUN) == {"clock": 2.0}
    assert await journal.world(uuid4()) is None


async def test_pictures_and_trees_are_kept(journal: SqliteJournal) -> None:
    picture = uuid4()
    await journal.append(Entry(pictures={picture: b"\xff\xd8jpeg"}))
    for text in ("then: []", "and: []"):
        await journal.append(Entry(document=Document("tree", "mine", text)))
    assert await journal.picture(picture) == b"\xff\xd8jpeg"
    assert await journal.documents("tree") == {"mine": "and: []"}
    await journal.append(Entry(document=Document("tree", "mine", None)))
    assert await journal.documents("tree") == {}


async def test_runs_are_listed_in_the_order_in_which_they_began(journal: SqliteJournal) -> None:
    runs = [uuid4() for _ in range(5)]
    for run in runs:
        await journal.append(Entry(events=[started(run), paused(run=run)]))
    assert [each.run for each in await journal.index.going_on()] == runs


async def test_entry_that_cannot_be_written_is_refused_alone(journal: SqliteJournal) -> None:
    outcomes = await asyncio.gather(
        journal.append(Entry(events=[paused(1.0)])),
        journal.append(Entry(events=[paused(2.0), paused(math.nan)])),
        journal.append(Entry(events=[paused(3.0)], world_run=RUN, world={"bad": math.inf})),
        journal.append(Entry(events=[paused(4.0)])),
        return_exceptions=True,
    )
    assert isinstance(outcomes[1], ValueError)
    assert isinstance(outcomes[2], ValueError)
    assert [event.time for event in await journal.read(0, 10)] == [1.0, 4.0]
    assert journal.head == 2


async def test_cancelled_caller_does_not_take_its_entry_back(journal: SqliteJournal) -> None:
    append = asyncio.ensure_future(journal.append(Entry(events=[paused()])))
    await asyncio.sleep(0)
    append.cancel()
    await journal.append(Entry(events=[paused(2.0)]))
    assert [event.time for event in await journal.read(0, 10)] == [1.0, 2.0]


async def test_closed_journal_takes_nothing(journal: SqliteJournal) -> None:
    journal.close()
    journal.close()
    with pytest.raises(JournalClosedError):
        await journal.append(Entry(events=[paused()]))
    with pytest.raises(JournalClosedError):
        await journal.read(0, 1)


async def test_reopened_journal_goes_on_where_it_was(tmp_path: Path) -> None:
    first = SqliteJournal(tmp_path / "journal.db")
    written = await first.append(Entry(events=[started(), paused()]))
    first.close()
    second = SqliteJournal(tmp_path / "journal.db")
    assert second.head == 2
    assert await second.read(0, 10) == written
    assert (await second.append(Entry(events=[paused()])))[0].seq == 3
    second.close()


async def test_close_writes_what_was_waiting(tmp_path: Path) -> None:
    journal = SqliteJournal(tmp_path / "journal.db")
    appends = [
        asyncio.ensure_future(journal.append(Entry(events=[paused(float(n))]))) for n in range(50)
    ]
    await asyncio.sleep(0)
    journal.close()
    await asyncio.gather(*appends)
    again = SqliteJournal(tmp_path / "journal.db")
    assert again.head == 50
    again.close()


async def test_failed_write_fails_its_callers_and_publishes_nothing(tmp_path: Path) -> None:
    journal = SqliteJournal(tmp_path / "journal.db", busy_timeout_s=0.0)
    await journal.append(Entry(events=[paused()]))
    with journal.subscribe(after=1) as subscription:
        blocker = sqlite3.connect(tmp_path / "journal.db", isolation_level=None)
        blocker.execute("BEGIN IMMEDIATE")
        outcomes = await asyncio.gather(
            *(journal.append(Entry(events=[paused()])) for _ in range(3)), return_exceptions=True
        )
        assert all(isinstance(each, JournalWriteError) for each in outcomes)
        assert "could not be written" in str(outcomes[0])
        assert journal.head == 1
        blocker.execute("ROLLBACK")
        blocker.close()
        (event,) = await journal.append(Entry(events=[paused(9.0)]))
        assert event.seq == 2
        assert [record.seq for record in await subscription.take()] == [2]
    journal.close()


def test_second_writer_of_one_journal_is_refused(tmp_path: Path) -> None:
    first = SqliteJournal(tmp_path / "journal.db")
    with pytest.raises(JournalLockedError, match="in use by another process"):
        SqliteJournal(tmp_path / "journal.db")
    first.close()
    SqliteJournal(tmp_path / "journal.db").close()


def test_file_that_is_no_journal_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "notes.txt"
    path.write_text("not a database" * 200)
    with pytest.raises(JournalSchemaError, match="not a journal"):
        SqliteJournal(path)


def test_only_its_owner_can_read_a_journal(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "journal.db"
    journal = SqliteJournal(path)
    modes = {each.name: each.stat().st_mode & 0o777 for each in path.parent.iterdir()}
    journal.close()
    assert {"journal.db", "journal.db-wal", "journal.db.lock"} <= modes.keys()
    assert set(modes.values()) == {0o600}
    assert path.parent.stat().st_mode & 0o777 == 0o700
    path.chmod(0o644)
    SqliteJournal(path).close()
    assert path.stat().st_mode & 0o777 == 0o600


def test_a_journal_that_is_a_folder_is_refused_with_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(UnavailableError, match="cannot be opened: Is a directory"):
        SqliteJournal(tmp_path)


def test_a_disk_that_fails_as_a_journal_is_opened_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(_: object) -> None:
        raise sqlite3.OperationalError("disk I/O error")

    monkeypatch.setattr("mend.server.journal.opening.migrate", fail)
    with pytest.raises(UnavailableError, match=r"journal\.db' cannot be opened: disk I/O error"):
        SqliteJournal(tmp_path / "journal.db")


def test_journal_of_a_newer_mend_is_refused(tmp_path: Path) -> None:
    SqliteJournal(tmp_path / "journal.db").close()
    connection = sqlite3.connect(tmp_path / "journal.db")
    connection.execute("INSERT INTO schema_version VALUES (99, '')")
    connection.commit()
    connection.close()
    with pytest.raises(JournalSchemaError, match="version 99"):
        SqliteJournal(tmp_path / "journal.db")


@pytest.mark.parametrize("time", [math.inf, -math.inf, math.nan])
async def test_an_event_with_a_number_that_is_none_is_refused_alone(
    journal: SqliteJournal, time: float
) -> None:
    bad, good = await asyncio.gather(
        journal.append(Entry(events=[paused(time)])),
        journal.append(Entry(events=[paused(2.0)])),
        return_exceptions=True,
    )
    assert isinstance(bad, ValueError)
    assert "run_paused" in str(bad)
    assert [each.time for each in await journal.read(0, 10)] == [2.0]
    assert not isinstance(good, BaseException)


async def test_the_names_of_such_numbers_may_stand_in_a_text(journal: SqliteJournal) -> None:
    called = started().model_copy(update={"tree_name": "NaN and Infinity"})
    await journal.append(Entry(events=[called]))
    (kept,) = await journal.read(0, 10)
    assert kept == called.model_copy(update={"seq": 1})


# --- A journal that cannot be written -----------------------------------------------------------


class PassingUntilGood(Passing):
    """After so many pauses the journal can be written again."""

    def __init__(self, tries: int) -> None:
        super().__init__()
        self.tries = tries
        self.connection: FailingConnection | None = None

    async def __call__(self, delay: float, /) -> None:
        await super().__call__(delay)
        if len(self.pauses) == self.tries and self.connection is not None:
            self.connection.error = None


async def test_who_is_patient_waits_until_the_journal_can_be_written(tmp_path: Path) -> None:
    sleep = PassingUntilGood(9)
    journal = SqliteJournal(tmp_path / "journal.db", sleep=sleep)
    sleep.connection = failing(journal)
    sleep.connection.error = "disk I/O error"
    entries = [journal.append(Entry(events=[paused(float(i))]), patient=True) for i in range(3)]
    refused = journal.append(Entry(events=[paused(9.0)]))
    *kept, refusal = await asyncio.wait_for(
        asyncio.gather(*entries, refused, return_exceptions=True), timeout=60
    )
    assert isinstance(refusal, JournalWriteError)
    assert not [each for each in kept if isinstance(each, BaseException)]
    assert [(each.seq, each.time) for each in await journal.read(0, 10)] == [
        (1, 0.0), (2, 1.0), (3, 2.0),
    ]  # fmt: skip
    assert sleep.pauses == [0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 5.0, 5.0, 5.0]
    assert await journal.picture(UUID(int=0)) is None
    journal.close()


async def test_who_watches_is_told_when_trouble_begins_and_ends() -> None:
    sleep = PassingUntilGood(2)
    journal = SqliteJournal(":memory:", sleep=sleep)
    told: list[str | None] = []
    over = asyncio.Event()

    def tell(reason: str | None) -> None:
        told.append(reason)
        if reason is None:
            over.set()

    journal.trouble.watch(tell)
    sleep.connection = failing(journal)
    sleep.connection.error = "disk I/O error"
    with pytest.raises(JournalWriteError):
        await journal.append(Entry(events=[paused()]))
    await asyncio.wait_for(over.wait(), timeout=60)
    assert told == ["the journal could not be written: disk I/O error", None]
    journal.close()


async def test_that_a_probe_could_be_written_ends_no_trouble_of_who_waits() -> None:
    sleep = PassingUntilGood(12)
    journal = SqliteJournal(":memory:", sleep=sleep)
    told: list[str | None] = []
    journal.trouble.watch(told.append)
    # As on a damaged page: everything else can be written all the time.
    sleep.connection = failing(journal, "INSERT INTO events")
    sleep.connection.error = sqlite3.DatabaseError("database disk image is malformed")
    entries = [journal.append(Entry(events=[paused(float(i))]), patient=True) for i in range(3)]
    await asyncio.wait_for(asyncio.gather(*entries), timeout=60)
    assert told == ["the journal could not be written: database disk image is malformed", None]
    assert len(sleep.pauses) == 12
    journal.close()


async def test_who_stops_waiting_keeps_nobody_else_from_trying() -> None:
    sleep = PassingUntilGood(5)
    journal = SqliteJournal(":memory:", sleep=sleep)
    sleep.connection = failing(journal)
    sleep.connection.error = "disk I/O error"
    first, second = (
        asyncio.create_task(journal.append(Entry(events=[paused(time)]), patient=True))
        for time in (1.0, 2.0)
    )
    await asyncio.wait_for(journal.trouble.begun(), timeout=60)
    first.cancel()
    (event,) = await asyncio.wait_for(second, timeout=60)
    assert event.time == 2.0
    journal.close()


async def test_a_journal_that_is_closed_in_trouble_lets_nobody_wait_for_ever() -> None:
    journal = SqliteJournal(":memory:")
    failing(journal).error = "disk I/O error"
    waiting = asyncio.create_task(journal.append(Entry(events=[paused()]), patient=True))
    await asyncio.wait_for(journal.trouble.begun(), timeout=60)
    journal.close()
    with pytest.raises(JournalClosedError):
        await asyncio.wait_for(waiting, timeout=60)
