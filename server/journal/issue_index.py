"""The index of issues: a row for each that was raised, changed in the transaction of its events."""

import sqlite3
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any
from uuid import UUID

from mend.dialogue.script import CloseReason
from mend.server.journal import events as ev
from mend.server.journal.run_index import UNREADABLE, Select, contains

INDEXED_TYPES = ("issue_raised", "dialogue_opened", "dialogue_closed")
"""The types of events that change the index."""

COLUMNS = "seq, run, issue, object, place, robot, name, node, step, time, raised, picture, dialogue, outcome"  # noqa: E501
_OF_ISSUE = ", ".join(f"issues.{each.strip()}" for each in COLUMNS.split(","))


@dataclass(frozen=True, slots=True)
class IndexedIssue:
    """An issue as the index has it.

    `seq` is that of the event that raised it, `time` on its run's clock, `raised` by the wall
    clock. `tree` is that of the run, `name` that of the leaf. `outcome` says how its dialogue
    ended, None while that goes on or where there was none.
    """

    seq: int
    run: UUID
    issue: str
    object: str | None
    place: str | None
    robot: str
    name: str
    node: str
    step: int
    time: float
    raised: datetime
    picture: UUID | None
    dialogue: UUID | None
    outcome: CloseReason | None
    tree: str
    world: str


@dataclass(frozen=True, slots=True)
class IssuePage:
    """Which issues are wanted, newest first: those for which all holds that is given.

    `text` is contained in what the issue, its part, place, robot, leaf or task tree is called,
    whether in capitals or not. `since` <= raised < `until`. `before` is the `seq` of the last
    issue of the page before.
    """

    text: str | None = None
    issues: Sequence[str] | None = None
    object: str | None = None
    robot: str | None = None
    tree: str | None = None
    outcomes: Sequence[str] | None = None
    run: UUID | None = None
    since: datetime | None = None
    until: datetime | None = None
    before: int | None = None
    limit: int = 100


class IssueIndex:
    """Reads the index."""

    def __init__(self, select: Select) -> None:
        self._select = select

    async def page(self, page: IssuePage) -> list[IndexedIssue]:
        """A page of issues, newest first, without those of runs that cannot be read."""
        conditions, values = ["runs.status != ?"], list[Any]([UNREADABLE])
        for condition, value in _conditions(page):
            conditions.append(condition)
            values += value
        rows = await self._select(
            f"SELECT {_OF_ISSUE}, runs.tree, runs.world FROM issues"
            " JOIN runs ON runs.run = issues.run"
            f" WHERE {' AND '.join(conditions)} ORDER BY issues.seq DESC LIMIT ?",
            (*values, page.limit),
        )
        return [issue for row in rows if (issue := _indexed(row)) is not None]

    async def kinds(self) -> Mapping[str, int]:
        """How often each kind of issue was raised."""
        return dict(
            await self._select(
                "SELECT issue, count(*) FROM issues GROUP BY issue ORDER BY issue", ()
            )
        )


_SEARCHED = " || char(10) || ".join(
    f"coalesce({each}, '')"
    for each in (
        "issues.issue", "issues.object", "issues.place", "issues.robot", "issues.name", "runs.tree"
    )
)  # fmt: skip


def _conditions(page: IssuePage) -> Iterator[tuple[str, Sequence[Any]]]:
    if page.text:
        yield contains(_SEARCHED, page.text)
    for column, wanted in (("issues.issue", page.issues), ("issues.outcome", page.outcomes)):
        if wanted is not None:
            yield f"{column} IN ({', '.join('?' * len(wanted))})", wanted
    exact = {
        "issues.object": page.object, "issues.robot": page.robot, "runs.tree": page.tree,
        "issues.run": None if page.run is None else str(page.run),
    }  # fmt: skip
    for column, value in exact.items():
        if value is not None:
            yield f"{column} = ?", [value]
    if page.since is not None:
        yield "issues.raised >= ?", [page.since.timestamp()]
    if page.until is not None:
        yield "issues.raised < ?", [page.until.timestamp()]
    if page.before is not None:
        yield "issues.seq < ?", [page.before]


def _indexed(row: Sequence[Any]) -> IndexedIssue | None:
    """A row of the index; None for one that is damaged."""
    try:
        return IndexedIssue(
            int(row[0]), UUID(row[1]), str(row[2]), row[3], row[4], str(row[5]), str(row[6]),
            str(row[7]), int(row[8]), float(row[9]), datetime.fromtimestamp(row[10], UTC),
            None if row[11] is None else UUID(row[11]),
            None if row[12] is None else UUID(row[12]),
            None if row[13] is None else CloseReason(row[13]), str(row[14]), str(row[15]),
        )  # fmt: skip
    except (ValueError, TypeError, AttributeError, OverflowError, OSError):
        return None


# --- Writing ------------------------------------------------------------------------------------


def note_issue(connection: sqlite3.Connection, event: ev.Event) -> None:
    """Change the index as an event says."""
    change = _NOTES.get(type(event))
    if change is not None:
        change(connection, event)


def forget_issues_of_run(connection: sqlite3.Connection, run: str) -> None:
    """Take a run's issues out of the index."""
    connection.execute("DELETE FROM issues WHERE run = ?", (run,))


def _raise(connection: sqlite3.Connection, event: ev.IssueRaised) -> None:
    connection.execute(
        f"INSERT OR IGNORE INTO issues ({COLUMNS}) VALUES ({', '.join('?' * 14)})",
        (
            event.seq, str(event.run), event.issue, event.object, event.place, event.robot,
            event.name, event.node, event.step, event.time, event.wall_time.timestamp(),
            None if event.picture is None else str(event.picture), None, None,
        ),
    )  # fmt: skip


def _open_dialogue(connection: sqlite3.Connection, event: ev.DialogueOpened) -> None:
    """It is about the last such issue before it."""
    connection.execute(
        "UPDATE issues SET dialogue = ? WHERE seq ="
        " (SELECT max(seq) FROM issues WHERE run = ? AND robot = ? AND issue = ?)",
        (str(event.dialogue), str(event.run), event.robot, event.issue),
    )


def _close_dialogue(connection: sqlite3.Connection, event: ev.DialogueClosed) -> None:
    connection.execute(
        "UPDATE issues SET outcome = ? WHERE run = ? AND dialogue = ?",
        (event.reason, str(event.run), str(event.dialogue)),
    )


_NOTES: Mapping[type[ev.Event], Callable[[sqlite3.Connection, Any], None]] = {
    ev.IssueRaised: _raise,
    ev.DialogueOpened: _open_dialogue,
    ev.DialogueClosed: _close_dialogue,
}
