"""Making the indexes and the chain of a journal that an older Mend wrote without them."""

import logging
import sqlite3
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from pydantic import ValidationError

from mend.server.journal import issue_index, run_index
from mend.server.journal.chain import chain_anew
from mend.server.journal.events import Event, any_event
from mend.server.journal.upgrades import UnknownEventVersionError, upgrade_text

log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class _Row:
    """A row of the events; `event` is None where it cannot be read."""

    seq: int
    run: str
    kind: str
    text: str
    event: Event | None


def index_events(connection: sqlite3.Connection) -> None:
    """Index every run of a journal and chain its events, within the caller's transaction."""
    for row in _rows(connection, run_index.INDEXED_TYPES):
        if row.event is not None:
            run_index.note(connection, row.event, row.text)
        elif row.kind == "run_started":
            why = f"event {row.seq}, its first, cannot be read"
            run_index.insert_unreadable(connection, row.run, row.seq, why)
    chain_anew(connection)


def index_issues(connection: sqlite3.Connection) -> None:
    """Index every issue of a journal's runs, within the caller's transaction."""
    for row in _rows(connection, issue_index.INDEXED_TYPES):
        if row.event is not None:
            issue_index.note_issue(connection, row.event)


def _rows(connection: sqlite3.Connection, types: Sequence[str]) -> Iterator[_Row]:
    """The events of some types, in order."""
    rows = connection.execute(
        "SELECT seq, run, type, version, body FROM events"
        f" WHERE type IN ({', '.join('?' * len(types))}) ORDER BY seq",
        types,
    )
    for seq, run, kind, version, body in rows:
        text, event = body, None
        try:
            text = upgrade_text(body, version)
            event = any_event.validate_json(text)
        except (ValidationError, ValueError, UnknownEventVersionError):
            log.error("event %d (%s) of run %s cannot be read", seq, kind, run)
        yield _Row(seq, run, kind, text, event)
