"""The journal in SQLite: WAL, `synchronous=FULL`, one writer thread with group commit."""

import asyncio
import json
import logging
import sqlite3
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Any, NoReturn
from uuid import UUID

from mend.server.journal.chain import Break, Row, Seal, Seals, at_one_moment, is_whole
from mend.server.journal.events import Event
from mend.server.journal.issue_index import IssueIndex, note_issue
from mend.server.journal.journal import (
    Document,
    DuplicateReceiptError,
    Entry,
    Fold,
    JournalClosedError,
    JournalWriteError,
    Receipt,
    UnreadableEvent,
)
from mend.server.journal.keyed_request import (
    FirstAnswer,
    KeptRequest,
    KeyedRequest,
    find_request,
    forget_requests,
    keep_answer,
    note_request,
)
from mend.server.journal.opening import IN_MEMORY, open_journal
from mend.server.journal.pages import page_of
from mend.server.journal.pruning import Keep, Pruned, prune, pruned_through
from mend.server.journal.readable import read_readable
from mend.server.journal.reading import ReadingThread
from mend.server.journal.run_index import RunIndex, note, note_readable, note_unreadable
from mend.server.journal.run_statistics import RunStatisticsIndex
from mend.server.journal.same_file import FileGoneError
from mend.server.journal.stored_event import current_text, read_event
from mend.server.journal.subscriptions import DEFAULT_CAPACITY, Record, Subscribers, Subscription
from mend.server.journal.trouble import Sleep, Trouble
from mend.server.journal.upgrades import current_version
from mend.server.journal.work_index import note_work
from mend.server.journal.writer import CommitStatistics, Done, GroupCommitWriter

__all__ = ["IN_MEMORY", "SqliteJournal"]

log = logging.getLogger(__name__)

PROVEN_S = 5.0
"""For so long after something was written it is taken for granted that more can be."""

PROBE = "probe"
PROBE_BYTES = 64 * 1024
"""Room for so much is room for most of what waits to be written."""

SEALS_AT_ONCE = 50
"""Of so many events the batches are looked at in one go."""

EMPTY_TREE = '"tree":{}'
"""How an event's JSON has a tree that was left empty, before any other object."""

INSERT_EVENT = "INSERT INTO events (seq, run, type, time, version, body) VALUES (?, ?, ?, ?, ?, ?)"


@dataclass(frozen=True, slots=True)
class _Committed:
    """An entry's events with their numbers, and their JSON."""

    events: list[Event]
    records: list[Record]
    fold: Fold | None


class SqliteJournal:
    """A journal in one file, or in memory for tests and runs that nobody needs afterwards.

    Implements `mend.server.journal.journal.Journal`. Raises `JournalLockedError` when another
    process has the file, `JournalSchemaError` when it is no journal that can be read,
    `UnreadableError` when it is one no longer, `UnavailableError` when the file cannot be
    opened or written. Only its owner can read the file. Belongs to one event loop at a time.
    `sleep` is what passes between two tries to write where that is not possible; the look at the
    pages on opening takes at most `check_s`. `wall_time_s` says when a receipt was given, in
    seconds of 1970; `clock` is any monotonic one in seconds.
    """

    def __init__(
        self,
        path: Path | str,
        *,
        busy_timeout_s: float = 5.0,
        check_s: float = 1.0,
        sleep: Sleep = asyncio.sleep,
        wall_time_s: Callable[[], float] = time.time,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._wall_time_s = wall_time_s
        self._clock = clock
        self._wrote_at = float("-inf")
        opened = open_journal(path, busy_timeout_s, check_s)
        self._lock = opened.lock
        self._file = opened.file
        self._write_connection = opened.write
        self._write_lock = threading.Lock()
        self._pages = self._reading(opened.read, "journal-reader")
        # A robot's hello must not wait for somebody who reads a whole run.
        self._look_ups = self._reading(opened.look_up, "journal-look-ups")
        self._damage = opened.damage
        self._head = opened.head
        self._next = self._batch_start = opened.head + 1
        self._chain = opened.chain
        self._index = RunIndex(self._pages.select, self._look_ups.select)
        self._issues = IssueIndex(self._pages.select)
        self._statistics = RunStatisticsIndex(self._pages.select)
        self._others = opened.others
        self._subscribers = Subscribers()
        self._version = current_version()
        self._closed = False
        self._writer = GroupCommitWriter(
            self._write_connection,
            self._write_lock,
            on_begin=self._begin,
            before_work=lambda: self._others.refuse(self._next),
            before_commit=self._seal,
            on_rollback=self._roll_back,
            on_commit=self._committed,
            on_failure=lambda reason: self._trouble.began(reason),
        )
        self._trouble = Trouble(self._probe, sleep)

    def _reading(self, connection: sqlite3.Connection, name: str) -> ReadingThread:
        shared = connection is self._write_connection
        return ReadingThread(connection, self._write_lock if shared else threading.Lock(), name)

    @property
    def head(self) -> int:
        """The `seq` of the last event that was committed and published."""
        return self._head

    @property
    def subscribers(self) -> Subscribers:
        return self._subscribers

    @property
    def trouble(self) -> Trouble:
        return self._trouble

    @property
    def index(self) -> RunIndex:
        return self._index

    @property
    def issues(self) -> IssueIndex:
        return self._issues

    @property
    def statistics(self) -> RunStatisticsIndex:
        return self._statistics

    @property
    def damage(self) -> Sequence[Break]:
        return self._damage

    async def look(self) -> None:
        """Notice now, rather than at the next commit, that nothing can be written any more."""
        self._look_at_file()
        if self._trouble.reason is None and self._clock() - self._wrote_at > PROVEN_S:
            await self._probe()

    def _look_at_file(self) -> None:
        try:
            if self._file is not None:
                self._file.check()
        except FileGoneError as error:
            self._trouble.began(f"the journal could not be written: {error}")
        if not (self._writer.lives or self._closed):
            self._trouble.began(
                "the journal could not be written: its thread has ended; start the service again"
            )

    def commit_statistics(self) -> CommitStatistics:
        return self._writer.statistics()

    # --- writing ------------------------------------------------------------------------------

    async def append(
        self, entry: Entry, fold: Fold | None = None, *, patient: bool = False
    ) -> list[Event]:
        work = partial(self._write_entry, entry, fold)
        try:
            return await self._commit(work)
        except JournalWriteError:
            if not patient:
                raise
        async with self._trouble.in_line() as turn:
            while True:
                await turn()
                with suppress(JournalWriteError):
                    return await self._commit(work)

    async def _commit(self, work: Callable[[sqlite3.Connection], _Committed]) -> list[Event]:
        committed: _Committed = await self._writer.submit(work)
        return committed.events

    async def keep_answer(
        self, request: KeyedRequest, answer: FirstAnswer | None, most: int, since: float
    ) -> int:
        def work(connection: sqlite3.Connection) -> int:
            if answer is not None:
                keep_answer(connection, request, answer)
            return forget_requests(connection, request.principal, most, since)

        return int(await self._writer.submit(work))

    async def mark_unreadable(self, run: UUID, why: str) -> None:
        await self._writer.submit(lambda connection: note_unreadable(connection, run, why))

    async def mark_readable(self, run: UUID, status: str) -> None:
        await self._writer.submit(lambda connection: note_readable(connection, run, status))

    async def prune(
        self, keep: Keep, now: datetime, forget: Callable[[UUID], None] = lambda _: None
    ) -> Pruned:
        """Take out what is not kept, while others go on writing.

        `forget` is told of each run that goes. Raises `JournalWriteError`.
        """
        return await prune(self._writer.submit, keep, now, forget)

    async def _probe(self) -> None:
        """Try to write something that needs room, and take it away again."""
        with suppress(JournalWriteError, JournalClosedError):
            await self._writer.submit(_write_probe)
            await self._writer.submit(_delete_probe)

    def _write_entry(
        self, entry: Entry, fold: Fold | None, connection: sqlite3.Connection
    ) -> _Committed:
        if entry.receipt is not None:
            _refuse_duplicate(entry.receipt, connection)
        committed = self._number(entry, fold)
        rows: list[Row] = []
        for event, record in zip(committed.events, committed.records, strict=True):
            rows.append(
                (event.seq, str(event.run), _type(event), event.time, self._version, record.text)
            )
            note(connection, event, record.text)
            note_issue(connection, event)
            note_work(connection, event)
        connection.executemany(INSERT_EVENT, rows)
        if entry.receipt is not None:
            connection.execute(
                "INSERT OR REPLACE INTO receipts (robot, boot, seq, time) VALUES (?, ?, ?, ?)",
                (
                    entry.receipt.robot, entry.receipt.boot, entry.receipt.seq,
                    self._wall_time_s(),
                ),
            )  # fmt: skip
        if entry.world is not None:
            connection.execute(
                "INSERT OR REPLACE INTO worlds (run, state) VALUES (?, ?)",
                (str(entry.world_run), json.dumps(entry.world, allow_nan=False)),
            )
        if entry.world_forgotten is not None:
            connection.execute("DELETE FROM worlds WHERE run = ?", (str(entry.world_forgotten),))
        connection.executemany(
            "INSERT OR REPLACE INTO pictures (id, jpeg) VALUES (?, ?)",
            [(str(picture), jpeg) for picture, jpeg in entry.pictures.items()],
        )
        if entry.document is not None:
            _write_document(entry.document, connection)
        note_request(connection, committed.events)
        self._chain.add(rows)
        self._next += len(committed.events)
        return committed

    def _number(self, entry: Entry, fold: Fold | None) -> _Committed:
        numbered = [
            event.model_copy(update={"seq": seq})
            for seq, event in enumerate(entry.events, self._next)
        ]
        records = [Record(event.seq, _text_of(event, entry.tree)) for event in numbered]
        return _Committed(numbered, records, fold)

    def _begin(self) -> None:
        self._batch_start = self._next
        self._chain.begin()

    def _seal(self, connection: sqlite3.Connection) -> None:
        self._chain.seal(connection)
        if self._file is not None:
            self._file.check()

    def _roll_back(self) -> None:
        self._next = self._batch_start
        self._chain.forget()

    def _committed(self, done: list[Done]) -> None:
        self._publish(done)
        # A commit of nothing succeeds also where there is no room for anything.
        wrote = [each.result for each in done if each.wrote]
        if wrote:
            self._wrote_at = self._clock()
            self._trouble.ended(probed=all(result == PROBE for result in wrote))

    def _publish(self, done: list[Done]) -> None:
        records: list[Record] = []
        for each in done:
            if isinstance(each.result, _Committed):
                _fold(each.result, each.future)
                records += each.result.records
        if records:
            self._head = records[-1].seq
            self._subscribers.publish(records)

    # --- reading ------------------------------------------------------------------------------

    def subscribe(self, after: int, capacity: int = DEFAULT_CAPACITY) -> Subscription:
        return Subscription(self, self._subscribers, after, capacity)

    async def read(self, after: int, limit: int, run: UUID | None = None) -> list[Event]:
        events: list[Event] = []
        while left := limit - len(events):
            records = await self.read_records(after, left, run)
            if not records:
                break
            events += [read_event(record.seq, record.text) for record in records]
            after = records[-1].seq
        return events

    async def read_records(self, after: int, limit: int, run: UUID | None = None) -> list[Record]:
        of_run = "" if run is None else "run = :run AND "
        statement = (
            f"SELECT seq, version, body FROM events WHERE {of_run}seq > :after"
            " ORDER BY seq LIMIT :limit"
        )
        values = {"run": str(run), "after": after, "limit": limit}
        rows = await self._pages.query(
            lambda connection: page_of(connection.execute(statement, values), body=2)
        )
        return [Record(seq, current_text(seq, body, version)) for seq, version, body in rows]

    async def read_readable(
        self, after: int, limit: int, run: UUID | None = None
    ) -> list[Event | UnreadableEvent]:
        query = partial(read_readable, after=after, limit=limit, run=run)
        return await self._pages.query(query)

    async def received(self, robot: str, boot: str) -> int:
        rows = await self._look_ups.select(
            "SELECT seq FROM receipts WHERE robot = ? AND boot = ?", (robot, boot)
        )
        return int(rows[0][0]) if rows else 0

    async def world(self, run: UUID) -> dict[str, Any] | None:
        rows = await self._look_ups.select("SELECT state FROM worlds WHERE run = ?", (str(run),))
        return json.loads(rows[0][0]) if rows else None

    async def picture(self, picture: UUID) -> bytes | None:
        rows = await self._look_ups.select(
            "SELECT jpeg FROM pictures WHERE id = ?", (str(picture),)
        )
        return rows[0][0] if rows else None

    async def is_whole(self, run: UUID) -> bool:
        return await self._pages.query(partial(is_whole, run=str(run)))

    async def seals(self, seqs: Sequence[int]) -> dict[int, Seal]:
        found: dict[int, Seal] = {}
        # In parts, as others wait for their pages meanwhile.
        for begin in range(0, len(seqs), SEALS_AT_ONCE):
            found |= await self._pages.query(
                partial(_seals, seqs=seqs[begin : begin + SEALS_AT_ONCE])
            )
        return found

    async def pruned_through(self) -> int:
        return await self._look_ups.query(pruned_through)

    async def find_request(self, principal: str, key: str, since: float) -> KeptRequest | None:
        query = partial(find_request, principal=principal, key=key, since=since)
        return await self._look_ups.query(query)

    async def documents(self, kind: str) -> dict[str, str]:
        statement = "SELECT name, text FROM documents WHERE kind = ? ORDER BY name"
        return dict(await self._pages.select(statement, (kind,)))

    def close(self) -> None:
        """Write what is waiting, end every subscription and free the file."""
        if self._closed:
            return
        self._closed = True
        self._trouble.close()
        self._writer.close()
        self._subscribers.close()
        # In memory all have one connection: closed under a query it takes the process with it.
        for reading in (self._pages, self._look_ups):
            reading.end()
        for reading in (self._pages, self._look_ups):
            reading.close()
        self._write_connection.close()
        if self._lock is not None:
            self._lock.release()


def _fold(committed: _Committed, waiting: "asyncio.Future[Any]") -> None:
    """Fold an entry. What that raises is its owner's alone: the others wait for their answers."""
    if committed.fold is None:
        return
    try:
        committed.fold(committed.events)
    except Exception as error:
        if waiting.done():
            log.exception("events that nobody waits for any more could not be folded")
        else:
            waiting.set_exception(error)


def _seals(connection: sqlite3.Connection, seqs: Sequence[int]) -> dict[int, Seal]:
    # What is pruned between two looks would seem to be missing.
    with at_one_moment(connection):
        seals = Seals(connection)
        return {seq: seals.of(seq) for seq in seqs}


def _write_document(document: Document, connection: sqlite3.Connection) -> None:
    if document.text is None:
        connection.execute(
            "DELETE FROM documents WHERE kind = ? AND name = ?", (document.kind, document.name)
        )
        return
    connection.execute(
        "INSERT OR REPLACE INTO documents (kind, name, text) VALUES (?, ?, ?)",
        (document.kind, document.name, document.text),
    )


def _write_probe(connection: sqlite3.Connection) -> str:
    connection.execute(
        "INSERT OR REPLACE INTO pictures (id, jpeg) VALUES (?, zeroblob(?))", (PROBE, PROBE_BYTES)
    )
    return PROBE


def _delete_probe(connection: sqlite3.Connection) -> str:
    connection.execute("DELETE FROM pictures WHERE id = ?", (PROBE,))
    return PROBE


def _type(event: Event) -> str:
    """The event's discriminator, which every event type declares for itself."""
    return str(vars(event)["type"])


def _text_of(event: Event, tree: str | None) -> str:
    """An event as JSON, with its tree. Raises `ValueError` for a number that JSON does not have."""
    text = event.model_dump_json()
    # The words may also stand in a string, which is why they are looked for before it is read.
    if "NaN" in text or "Infinity" in text:
        json.loads(text, parse_constant=partial(_refuse_number, event))
    return text if tree is None else text.replace(EMPTY_TREE, f'"tree":{tree}', 1)


def _refuse_number(event: Event, number: str) -> NoReturn:
    raise ValueError(f"an event '{_type(event)}' has a number that is none ({number})")


def _refuse_duplicate(receipt: Receipt, connection: sqlite3.Connection) -> None:
    row = connection.execute(
        "SELECT seq FROM receipts WHERE robot = ? AND boot = ?", (receipt.robot, receipt.boot)
    ).fetchone()
    if row is not None and receipt.seq <= row[0]:
        raise DuplicateReceiptError(
            f"report {receipt.seq} of robot {receipt.robot} was received before"
        )
