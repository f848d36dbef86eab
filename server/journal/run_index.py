"""The index of runs and dialogues: a row for each, changed in the transaction of its events."""

import json
import sqlite3
from collections.abc import Awaitable, Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any, Literal
from uuid import UUID

from mend.server.journal import events as ev

UNREADABLE = "unreadable"
"""The status of a run whose events cannot be read; every other one is that of its events."""

ENDINGS = {"run_finished": "finished", "run_failed": "failed", "run_aborted": "aborted"}
CHANGES = {"run_paused": "paused", "run_resumed": "running"}
STATUSES = {"running", "paused", *ENDINGS.values(), UNREADABLE}
INDEXED_TYPES = ("run_started", *CHANGES, *ENDINGS, "dialogue_opened", "dialogue_closed")
"""The types of events that change the index."""

COLUMNS = "run, begun, ended, status, time, started, ended_at, tree, world, scenario, seed, speed, robots, ending, why"  # noqa: E501

BY_END = " INDEXED BY runs_by_end"
"""Few runs have not ended, or only since; SQLite might rather go through all in their order."""


@dataclass(frozen=True, slots=True)
class IndexedRun:
    """A run as the index has it.

    `begun` and `ended` are the `seq` of its first event and of the one that ended it, `time` that
    of the latter on the run's clock. `ending` is the JSON of the event that ended it; `why` says
    why a run is unreadable.
    """

    run: UUID
    begun: int
    ended: int | None
    status: str
    time: float
    started: datetime
    ended_at: datetime | None
    tree: str
    world: str
    scenario: str | None
    seed: int
    speed: float | Literal["max"]
    robots: Sequence[str]
    ending: str | None
    why: str | None


@dataclass(frozen=True, slots=True)
class IndexedDialogue:
    """A dialogue as the index has it; `opened` is the `seq` of its first event."""

    dialogue: UUID
    run: UUID
    opened: int


@dataclass(frozen=True, slots=True)
class RunPage:
    """Which runs are wanted, newest first: those for which all holds that is given.

    `text` is contained in what the task tree, the world, the scenario or a robot is called,
    whether in capitals or not. `since` <= started < `until`; they began before the run `before`.
    """

    statuses: Sequence[str] | None = None
    limit: int = 100
    offset: int = 0
    before: UUID | None = None
    text: str | None = None
    tree: str | None = None
    robot: str | None = None
    since: datetime | None = None
    until: datetime | None = None


Select = Callable[[str, Any], Awaitable[list[Any]]]
"""Runs a statement that reads, with its parameters."""


class RunIndex:
    """Reads the index: pages of it with `select`, one row with `look_up`."""

    def __init__(self, select: Select, look_up: Select) -> None:
        self._select = select
        self._look_up = look_up

    async def page(self, page: RunPage) -> list[IndexedRun]:
        """A page of runs, newest first."""
        conditions, values = [], list[Any]()
        for condition, given in _conditions(page):
            conditions.append(condition)
            values += given
        where = f" WHERE {' AND '.join(conditions)}" if conditions else ""
        return await self._runs(
            f"{where} ORDER BY begun DESC LIMIT ? OFFSET ?", (*values, page.limit, page.offset)
        )

    async def find(self, run: UUID) -> IndexedRun | None:
        """A run; None if there is none."""
        rows = await self._look_up(f"SELECT {COLUMNS} FROM runs WHERE run = ?", (str(run),))
        return _indexed(rows[0]) if rows else None

    async def going_on(self) -> list[IndexedRun]:
        """The runs that have not ended, in the order in which they began."""
        return await self._runs(f"{BY_END} WHERE ended IS NULL ORDER BY begun", ())

    async def open_at(self, seq: int) -> list[UUID]:
        """The runs that had begun and not ended after an event, in the order they began.

        Without those that cannot be read.
        """
        rows = await self._select(
            f"SELECT run, begun, status FROM runs{BY_END} WHERE ended IS NULL AND begun <= :seq"
            f" UNION SELECT run, begun, status FROM runs{BY_END}"
            " WHERE ended > :seq AND begun <= :seq ORDER BY begun",
            {"seq": seq},
        )
        return [run for text, _, status in rows if status != UNREADABLE and (run := _id(text))]

    async def counts(self) -> Mapping[str, int]:
        """How many runs there are of each status."""
        return dict(await self._select("SELECT status, count(*) FROM runs GROUP BY status", ()))

    async def count_unreadable(self) -> int:
        rows = await self._select("SELECT count(*) FROM runs WHERE status = ?", (UNREADABLE,))
        return int(rows[0][0])

    async def run_of(self, dialogue: UUID) -> UUID | None:
        """The run of a dialogue."""
        rows = await self._look_up("SELECT run FROM dialogues WHERE dialogue = ?", (str(dialogue),))
        return _id(rows[0][0]) if rows else None

    async def dialogues(
        self, status: Literal["closed"] | None, limit: int, offset: int
    ) -> list[IndexedDialogue]:
        """Dialogues, oldest first, without those of runs that cannot be read."""
        closed = "" if status is None else " AND closed IS NOT NULL"
        rest = f"{closed} ORDER BY opened LIMIT ? OFFSET ?"
        return await self._dialogues(self._select, rest, (limit, offset))

    async def dialogue(self, dialogue: UUID) -> IndexedDialogue | None:
        """One of them; None if there is none."""
        found = await self._dialogues(self._look_up, " AND dialogue = ?", (str(dialogue),))
        return found[0] if found else None

    async def _dialogues(
        self, select: Select, rest: str, values: Sequence[Any]
    ) -> list[IndexedDialogue]:
        rows = await select(
            "SELECT dialogue, run, opened FROM dialogues"
            f" WHERE run NOT IN (SELECT run FROM runs WHERE status = ?){rest}",
            (UNREADABLE, *values),
        )
        found = [(_id(dialogue), _id(run), opened) for dialogue, run, opened in rows]
        return [
            IndexedDialogue(each, run, opened)
            for each, run, opened in found
            if each and run and isinstance(opened, int)
        ]

    async def raised_before(self, dialogue: IndexedDialogue) -> int:
        """The `seq` of the issue that a dialogue is about: the last one before it opened."""
        # Backwards from the dialogue, which it is not far from.
        rows = await self._look_up(
            "SELECT seq FROM events WHERE run = ? AND seq < ? AND type = 'issue_raised'"
            " ORDER BY seq DESC LIMIT 1",
            (str(dialogue.run), dialogue.opened),
        )
        return int(rows[0][0]) if rows else dialogue.opened

    async def about_dialogues(
        self, run: UUID, after: int, limit: int
    ) -> list[tuple[int, int, str]]:
        """Up to `limit` events of a run's dialogues and the issues that it raised, in order.

        Each with its `seq` > `after`, the version that it was written in, and its JSON.
        """
        # In a string the quotes would be escaped.
        return await self._select(
            "SELECT seq, version, body FROM events WHERE run = ? AND seq > ?"
            """ AND (type = 'issue_raised' OR instr(body, '"dialogue":"')) ORDER BY seq LIMIT ?""",
            (str(run), after, limit),
        )

    async def _runs(self, rest: str, values: Sequence[Any]) -> list[IndexedRun]:
        rows = await self._select(f"SELECT {COLUMNS} FROM runs{rest}", values)
        return [run for row in rows if (run := _indexed(row)) is not None]


def _conditions(page: RunPage) -> Iterator[tuple[str, Sequence[Any]]]:
    if page.statuses is not None:
        yield f"status IN ({', '.join('?' * len(page.statuses))})", page.statuses
    if page.before is not None:
        yield "begun < (SELECT begun FROM runs WHERE run = ?)", [str(page.before)]
    if page.text:
        searched = "tree || char(10) || world || char(10) || coalesce(scenario, '') || robots"
        yield contains(searched, page.text)
    if page.tree is not None:
        yield "tree = ?", [page.tree]
    if page.robot is not None:
        # Of a damaged row nobody knows which robots it has.
        known = "iif(json_valid(robots), robots, '[]')"
        yield f"EXISTS (SELECT 1 FROM json_each({known}) WHERE value = ?)", [page.robot]
    if page.since is not None:
        yield "started >= ?", [page.since.timestamp()]
    if page.until is not None:
        yield "started < ?", [page.until.timestamp()]


def contains(searched: str, text: str) -> tuple[str, Sequence[Any]]:
    """The condition that an SQL expression contains a text, and its values.

    People type blanks where names have underscores, and no capitals.
    """
    plain, typed = (f"replace(lower({each}), '_', ' ')" for each in (searched, "?"))
    return f"instr({plain}, {typed}) > 0", [text.strip()]


def _indexed(row: Sequence[Any]) -> IndexedRun | None:
    """A row of the index; of one that is damaged what can be read, None without its id."""
    run = _id(row[0])
    if run is None:
        return None
    try:
        if row[3] not in STATUSES:
            raise ValueError(f"it has the status '{row[3]}'")
        robots = json.loads(row[12])
        return IndexedRun(
            run, int(row[1]), row[2], row[3], float(row[4]), _moment(row[5]),
            None if row[6] is None else _moment(row[6]), row[7], row[8], row[9], int(row[10]),
            "max" if row[11] == "max" else float(row[11]), [str(each) for each in robots],
            row[13], row[14],
        )  # fmt: skip
    except (ValueError, TypeError, OverflowError, OSError) as error:
        why = f"its row in the index is damaged ({error})"
        return _without_start(run, int(row[1]), why)


def _without_start(run: UUID, begun: int, why: str) -> IndexedRun:
    start = datetime.fromtimestamp(0, UTC)
    return IndexedRun(
        run, begun, None, UNREADABLE, 0.0, start, None, "?", "?", None, 0, 1.0, (), None, why
    )


def _id(text: Any) -> UUID | None:
    try:
        return UUID(text)
    except (ValueError, TypeError, AttributeError):
        return None


def _moment(seconds: float) -> datetime:
    return datetime.fromtimestamp(seconds, UTC)


# --- Writing ------------------------------------------------------------------------------------

INSERT_RUN = f"INSERT OR IGNORE INTO runs ({COLUMNS}) VALUES ({', '.join('?' * 15)})"


def note(connection: sqlite3.Connection, event: ev.Event, text: str) -> None:
    """Change the index as an event says; `text` is its JSON."""
    change = _NOTES.get(type(event))
    if change is not None:
        change(connection, event, text)


def note_unreadable(connection: sqlite3.Connection, run: UUID, why: str) -> None:
    """Say in the index that a run's events cannot be read."""
    connection.execute(
        "UPDATE runs SET status = ?, why = ? WHERE run = ?", (UNREADABLE, why, str(run))
    )


def note_readable(connection: sqlite3.Connection, run: UUID, status: str) -> None:
    """Take back what `note_unreadable` said: the run has a status again."""
    connection.execute("UPDATE runs SET status = ?, why = NULL WHERE run = ?", (status, str(run)))


def insert_unreadable(connection: sqlite3.Connection, run: str, begun: int, why: str) -> None:
    """Add a run of which not even the first event can be read."""
    values = (run, begun, None, UNREADABLE, 0.0, 0.0, None, "?", "?", None, 0, "1.0", "[]", None)
    connection.execute(INSERT_RUN, (*values, why))


def _begin(connection: sqlite3.Connection, event: ev.RunStarted, _: str) -> None:
    connection.execute(
        INSERT_RUN,
        (
            str(event.run), event.seq, None, "running", event.time, event.wall_time.timestamp(),
            None, event.tree_name, event.world, event.scenario, event.seed, str(event.speed),
            json.dumps(event.robots), None, None,
        ),
    )  # fmt: skip


def _change(connection: sqlite3.Connection, event: ev.Event, _: str) -> None:
    status = CHANGES[_type(event)]
    connection.execute("UPDATE runs SET status = ? WHERE run = ?", (status, str(event.run)))


def _end(connection: sqlite3.Connection, event: ev.Event, text: str) -> None:
    connection.execute(
        "UPDATE runs SET ended = ?, status = ?, time = ?, ended_at = ?, ending = ? WHERE run = ?",
        (
            event.seq, ENDINGS[_type(event)], event.time, event.wall_time.timestamp(), text,
            str(event.run),
        ),
    )  # fmt: skip


def _open_dialogue(connection: sqlite3.Connection, event: ev.DialogueOpened, _: str) -> None:
    connection.execute(
        "INSERT OR IGNORE INTO dialogues (dialogue, run, opened) VALUES (?, ?, ?)",
        (str(event.dialogue), str(event.run), event.seq),
    )


def _close_dialogue(connection: sqlite3.Connection, event: ev.DialogueClosed, _: str) -> None:
    connection.execute(
        "UPDATE dialogues SET closed = ? WHERE dialogue = ?", (event.seq, str(event.dialogue))
    )


def _type(event: ev.Event) -> str:
    return str(vars(event)["type"])


_NOTES: Mapping[type[ev.Event], Callable[[sqlite3.Connection, Any, str], None]] = {
    ev.RunStarted: _begin,
    ev.RunPaused: _change,
    ev.RunResumed: _change,
    ev.RunFinished: _end,
    ev.RunFailed: _end,
    ev.RunAborted: _end,
    ev.DialogueOpened: _open_dialogue,
    ev.DialogueClosed: _close_dialogue,
}
