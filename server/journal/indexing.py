"""Making the indexes and the chain of a journal that an older Mend wrote without them."""

import logging
import sqlite3
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from uuid import UUID

from pydantic import ValidationError

from mend.server.journal import events as ev
from mend.server.journal import issue_index, run_index, work_index
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


def index_work(connection: sqlite3.Connection) -> None:
    """Index the picks and questions of a journal's runs, within the caller's transaction."""
    objects: dict[UUID, dict[str, str]] = {}
    for row in _rows(connection, ("run_started", *work_index.INDEXED_TYPES), _MAY_BE_WORK):
        event = row.event
        if isinstance(event, ev.RunStarted):
            objects[event.run] = _objects_of(event.tree)
        elif isinstance(event, ev.StepStarted) and event.object is None:
            handled = objects.get(event.run, {}).get(event.node)
            work_index.note_work(connection, event.model_copy(update={"object": handled}))
        elif event is not None:
            work_index.note_work(connection, event)


_MAY_BE_WORK = (
    " AND (type != 'step_started'"
    f" OR instr(body, '{work_index.GRASP}') OR instr(body, '{work_index.GRASP_STEP}'))"
)
"""Most steps are none, and take longer to be read than to be looked through."""


def _objects_of(tree: Mapping[str, Any]) -> dict[str, str]:
    """What the leaves of a tree handle, by their paths; nothing of one that is not as now."""
    objects: dict[str, str] = {}
    paths: list[str] = []
    children: Counter[int] = Counter()
    try:
        for node in tree["nodes"]:
            parent = node["parent"]
            if parent is None:
                paths.append("")
                continue
            paths.append(f"{paths[parent]}/{children[parent]}")
            children[parent] += 1
            handled = node.get("parameters", {}).get("object")
            if handled is not None:
                objects[paths[-1]] = handled
    except (KeyError, TypeError, IndexError, AttributeError):
        return {}
    return objects


def _rows(connection: sqlite3.Connection, types: Sequence[str], more: str = "") -> Iterator[_Row]:
    """The events of some types, in order, for which `more` holds."""
    rows = connection.execute(
        "SELECT seq, run, type, version, body FROM events"
        f" WHERE type IN ({', '.join('?' * len(types))}){more} ORDER BY seq",
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
