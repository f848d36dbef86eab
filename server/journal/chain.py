"""The chain over committed batches: a changed, removed or inserted event breaks it.

Each batch (what one transaction committed) has a digest of its events, and a link, which is a
digest of the link before it and of this digest. Pruning takes events out of batches without
touching a link: the digest of what is left is kept beside the one that was written.
"""

import hashlib
import sqlite3
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from mend.server.journal.events import NO_RUN
from mend.server.journal.sqlite_errors import SQLITE_ERRORS

DIGEST_BYTES = 16
FIRST_LINK = bytes(DIGEST_BYTES)
DAMAGED = b""
"""In place of the digest of what is left of a batch that was damaged before it was pruned."""

Row = tuple[int, str, str, float, int, str]
"""The columns of an event as they are in the journal: seq, run, type, time, version, body."""

SELECT_ROWS = "SELECT seq, run, type, time, version, body FROM events"


@dataclass(frozen=True, slots=True)
class Batch:
    """A row of the chain.

    `written` is None where several batches without any events left were joined; `kept` is None
    while nothing was pruned.
    """

    first: int
    last: int
    written: bytes | None
    kept: bytes | None
    link: bytes

    @property
    def expected(self) -> bytes | None:
        """The digest that its events must have now."""
        return self.written if self.kept is None else self.kept


@dataclass(frozen=True, slots=True)
class Break:
    """Where the chain does not hold: from event `first` to `last`, of which `runs` have events."""

    first: int
    last: int
    sentence: str
    runs: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class Seal:
    """What the chain says of an event: the digest and the link of its batch, as they were written.

    `wrong`: why the event may not be what was committed; None where they hold.
    """

    digest: bytes | None
    link: bytes | None
    wrong: str | None


class Chain:
    """What the journal's writer adds to the chain; used by its thread alone."""

    def __init__(self, connection: sqlite3.Connection) -> None:
        row = connection.execute("SELECT link FROM batches ORDER BY last DESC LIMIT 1").fetchone()
        self._link: bytes = FIRST_LINK if row is None else row[0]
        self._sealed: bytes | None = None
        self._rows: list[Row] = []

    def begin(self) -> None:
        """A batch begins; the one before it was committed unless `forget` was called."""
        if self._sealed is not None:
            self._link = self._sealed
        self.forget()

    def forget(self) -> None:
        """Nothing of the batch was committed."""
        self._sealed = None
        self._rows = []

    def add(self, rows: Sequence[Row]) -> None:
        """Take events into the batch."""
        self._rows += rows

    def seal(self, connection: sqlite3.Connection) -> None:
        """Write the batch's row, right before it is committed."""
        if self._rows:
            digest = digest_of(self._rows)
            self._sealed = _linked(self._link, digest)
            connection.execute(
                "INSERT INTO batches (last, first, written, kept, link) VALUES (?, ?, ?, NULL, ?)",
                (self._rows[-1][0], self._rows[0][0], digest, self._sealed),
            )


def digest_of(rows: Iterable[Row]) -> bytes:
    """The digest of a batch's events."""
    # In one go, for which hashlib lets other threads run. SQLite keeps no negative zero.
    lines = [
        f"{seq} {run} {kind} {time + 0.0!r} {version} {body}\n"
        for seq, run, kind, time, version, body in rows
    ]
    return hashlib.sha256("".join(lines).encode()).digest()[:DIGEST_BYTES]


NOTHING_LEFT = digest_of(())


def _linked(link: bytes, digest: bytes) -> bytes:
    return hashlib.sha256(link + digest).digest()[:DIGEST_BYTES]


def chain_anew(connection: sqlite3.Connection, batch_events: int = 1000) -> None:
    """Make the chain of a journal that has none, over the events as they are."""
    rows = connection.execute(f"{SELECT_ROWS} ORDER BY seq")
    first, link = 1, FIRST_LINK
    while page := rows.fetchmany(batch_events):
        digest = digest_of(page)
        link = _linked(link, digest)
        connection.execute(
            "INSERT INTO batches (last, first, written, kept, link) VALUES (?, ?, ?, NULL, ?)",
            (page[-1][0], first, digest, link),
        )
        first = page[-1][0] + 1


def batches(connection: sqlite3.Connection, after: int = 0) -> Iterator[Batch]:
    """The batches that end after an event, in order."""
    found = connection.execute(
        "SELECT first, last, written, kept, link FROM batches WHERE last > ? ORDER BY last",
        (after,),
    )
    return (Batch(*row) for row in found)


def batch_of(connection: sqlite3.Connection, seq: int) -> Batch | None:
    """The batch that an event was committed with."""
    found = next(batches(connection, seq - 1), None)
    return found if found is not None and found.first <= seq else None


def rows_of(connection: sqlite3.Connection, first: int, last: int) -> list[Row]:
    """The events of a span as they are in the journal."""
    found = connection.execute(
        f"{SELECT_ROWS} WHERE seq BETWEEN ? AND ? ORDER BY seq", (first, last)
    )
    return found.fetchall()


def is_whole(connection: sqlite3.Connection, run: str) -> bool:
    """Whether all batches that have events of a run are as they were committed."""
    seqs = connection.execute("SELECT seq FROM events WHERE run = ? ORDER BY seq", (run,))
    batch: Batch | None = None
    for (seq,) in seqs.fetchall():
        if batch is not None and seq <= batch.last:
            continue
        batch = batch_of(connection, seq)
        if batch is None:
            return False
        if digest_of(rows_of(connection, batch.first, batch.last)) != batch.expected:
            return False
    return True


class Seals:
    """Looks at the batches of events that are asked for, which is quick where they are in order.

    Of other batches only the links beside them are read.
    """

    def __init__(self, connection: sqlite3.Connection) -> None:
        self._connection = connection
        self._batch: Batch | None = None
        self._seal = Seal(None, None, None)

    def of(self, seq: int) -> Seal:
        """What the chain says of an event that is in the journal."""
        if self._batch is None or not self._batch.first <= seq <= self._batch.last:
            self._batch = None
            try:
                self._seal = self._look(seq)
            except (*SQLITE_ERRORS, ValueError, TypeError) as error:
                return Seal(None, None, f"the batch of event {seq} cannot be read: {error}")
        return self._seal

    def _look(self, seq: int) -> Seal:
        batch = batch_of(self._connection, seq)
        if batch is None:
            return Seal(None, None, f"event {seq} belongs to no batch")
        broken = next(_breaks_of(self._connection, batch, self._link_before(batch)), None)
        after = next(batches(self._connection, batch.last), None)
        wrong = None
        if broken is not None:
            wrong = broken.sentence
        elif after is not None and not _follows(after, batch.link):
            # Where digest and link were made anew for one batch alone the next one tells it.
            wrong = f"the chain is broken after event {batch.last}: a batch was removed or changed"
        self._batch = batch
        return Seal(batch.written, batch.link, wrong)

    def _link_before(self, batch: Batch) -> bytes:
        row = self._connection.execute(
            "SELECT link FROM batches WHERE last < ? ORDER BY last DESC LIMIT 1", (batch.first,)
        ).fetchone()
        return FIRST_LINK if row is None else row[0]


@contextmanager
def at_one_moment(connection: sqlite3.Connection) -> Iterator[None]:
    """Read everything as it was when the first of it was read, whatever others write."""
    connection.execute("BEGIN")
    try:
        yield
    finally:
        if connection.in_transaction:
            connection.execute("ROLLBACK")


def breaks(connection: sqlite3.Connection, last_batches: int | None = None) -> Iterator[Break]:
    """Where the chain does not hold, in its whole length or in so many of its last batches."""
    before: Batch | None = None
    after = 0
    if last_batches is not None:
        before = _before_the_last(connection, last_batches)
        after = 0 if before is None else before.last
    for batch in batches(connection, after):
        link = FIRST_LINK if before is None else before.link
        yield from _breaks_between(connection, 0 if before is None else before.last, batch.first)
        yield from _breaks_of(connection, batch, link)
        before = batch
    yield from _after_the_end(connection, 0 if before is None else before.last)


def _breaks_of(connection: sqlite3.Connection, batch: Batch, before: bytes) -> Iterator[Break]:
    """Where a batch does not hold: its link after that of the one `before`, and its digest."""
    if not _follows(batch, before):
        yield Break(
            batch.first, batch.last,
            f"the chain is broken before event {batch.first}: a batch was removed or changed",
        )  # fmt: skip
    rows = rows_of(connection, batch.first, batch.last)
    if digest_of(rows) != batch.expected:
        yield Break(batch.first, batch.last, _changed(batch), _runs_of(rows))


def _follows(batch: Batch, before: bytes) -> bool:
    return batch.written is None or batch.link == _linked(before, batch.written)


def _before_the_last(connection: sqlite3.Connection, count: int) -> Batch | None:
    row = connection.execute(
        "SELECT first, last, written, kept, link FROM batches ORDER BY last DESC LIMIT 1 OFFSET ?",
        (count,),
    ).fetchone()
    return None if row is None else Batch(*row)


def _changed(batch: Batch) -> str:
    span = f"event {batch.first}"
    if batch.first != batch.last:
        span = f"the events {batch.first} to {batch.last}"
    if batch.kept == DAMAGED:
        return f"{span}: some were damaged before others were pruned"
    return f"{span}: not what was committed (something was changed, removed or inserted)"


def _breaks_between(connection: sqlite3.Connection, last: int, first: int) -> Iterator[Break]:
    if first != last + 1:
        rows = rows_of(connection, last + 1, first - 1)
        yield Break(
            last + 1, first - 1,
            f"the events {last + 1} to {first - 1} belong to no batch: one was removed",
            _runs_of(rows),
        )  # fmt: skip


def _after_the_end(connection: sqlite3.Connection, last: int) -> Iterator[Break]:
    rows = connection.execute(f"{SELECT_ROWS} WHERE seq > ? ORDER BY seq", (last,)).fetchall()
    if rows:
        runs = _runs_of(rows)
        sentence = f"the events from {rows[0][0]} on were never committed by Mend"
        yield Break(rows[0][0], rows[-1][0], sentence, runs)


def _runs_of(rows: Iterable[Row]) -> frozenset[str]:
    return frozenset(str(row[1]) for row in rows) - {str(NO_RUN)}
