"""Reading past events that cannot be read: what is beside damage is not lost."""

import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import suppress
from uuid import UUID

from mend.server.journal.events import NO_RUN, Event
from mend.server.journal.journal import UnreadableEvent
from mend.server.journal.pages import page_of
from mend.server.journal.sqlite_errors import SQLITE_ERRORS
from mend.server.journal.stored_event import UnreadableEventError, read_event

COLUMNS = "SELECT seq, run, body, version FROM events"


def read_readable(
    connection: sqlite3.Connection, after: int, limit: int, run: UUID | None = None
) -> list[Event | UnreadableEvent]:
    """A page of events with `seq` > `after`; in the place of one that cannot be read, why.

    Raises `sqlite3.Error` where not even the numbers of the events can be read.
    """
    where = "" if run is None else "run = :run AND "
    wanted = f"WHERE {where}seq > :after ORDER BY seq LIMIT :limit"
    values = {"run": str(run), "after": after, "limit": limit}
    try:
        rows = page_of(connection.execute(f"{COLUMNS} {wanted}", values), body=2)
    except SQLITE_ERRORS:
        # The numbers stand in the index over the runs, which may be whole where a row is not.
        seqs = connection.execute(f"SELECT seq FROM events {wanted}", values).fetchall()
        return list(_one_by_one(connection, [seq for (seq,) in seqs], run))
    return [event_of(*row) for row in rows]


def _one_by_one(
    connection: sqlite3.Connection, seqs: Sequence[int], run: UUID | None
) -> Iterator[Event | UnreadableEvent]:
    for seq in seqs:
        try:
            row = connection.execute(f"{COLUMNS} WHERE seq = ?", (seq,)).fetchone()
        except SQLITE_ERRORS as error:
            yield UnreadableEvent(seq, f"event {seq} cannot be read: {error}", _run(run))
            continue
        if row is None:
            yield UnreadableEvent(seq, f"event {seq} cannot be read: it is not there", _run(run))
        else:
            yield event_of(*row)


def event_of(seq: int, run: str, body: str, version: int) -> Event | UnreadableEvent:
    """A row of the journal as an event, or why it cannot be read."""
    try:
        return read_event(seq, body, version)
    except UnreadableEventError as error:
        return UnreadableEvent(seq, str(error), _run(run))


def _run(run: UUID | str | None) -> UUID | None:
    found = None
    with suppress(ValueError):
        found = UUID(str(run))
    return None if found == NO_RUN else found
