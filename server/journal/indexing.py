"""Making the index and the chain of a journal that an older Mend wrote without them."""

import logging
import sqlite3

from pydantic import ValidationError

from mend.server.journal.chain import chain_anew
from mend.server.journal.events import Event, any_event
from mend.server.journal.run_index import INDEXED_TYPES, insert_unreadable, note
from mend.server.journal.upgrades import UnknownEventVersionError, upgrade_text

log = logging.getLogger(__name__)


def index_events(connection: sqlite3.Connection) -> None:
    """Index every run of a journal and chain its events, within the caller's transaction."""
    rows = connection.execute(
        "SELECT seq, run, type, version, body FROM events"
        f" WHERE type IN ({', '.join('?' * len(INDEXED_TYPES))}) ORDER BY seq",
        INDEXED_TYPES,
    )
    for seq, run, kind, version, body in rows:
        try:
            text = upgrade_text(body, version)
            event: Event = any_event.validate_json(text)
        except (ValidationError, ValueError, UnknownEventVersionError):
            log.error("event %d (%s) of run %s cannot be read", seq, kind, run)
            if kind == "run_started":
                insert_unreadable(connection, run, seq, f"event {seq}, its first, cannot be read")
            continue
        note(connection, event, text)
    chain_anew(connection)
