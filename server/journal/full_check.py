"""Checking a whole journal: its pages, its chain, every event, the index, and that runs fold."""

import sqlite3
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from uuid import UUID

from mend.errors import RefusalError
from mend.server.journal import events as ev
from mend.server.journal.chain import SELECT_ROWS, Row, breaks
from mend.server.journal.journal import JournalReadError
from mend.server.journal.migrations import MIGRATIONS, WITH_CHAIN
from mend.server.journal.run_index import ENDINGS, UNREADABLE
from mend.server.journal.sqlite_errors import text_or_marks
from mend.server.journal.stored_event import read_event

MOST_PAGE_FINDINGS = 20
FoldRun = Callable[[UUID, Iterable[ev.Event]], None]
"""Folds all events of a run. Raises a `RefusalError` where that cannot be done."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that is wrong, and the runs that it concerns, where that is known."""

    sentence: str
    runs: frozenset[str] = frozenset()


@dataclass(slots=True)
class JournalCheck:
    """What was looked at, and what was found."""

    runs: int = 0
    events: int = 0
    findings: list[Finding] = field(default_factory=list)


def check_journal(path: Path, fold: FoldRun) -> JournalCheck:
    """Check a journal that somebody else may be writing; changes nothing.

    Raises `FileNotFoundError` where there is none. Damage is never raised, but found.
    """
    if not path.exists():
        raise FileNotFoundError(2, "there is no such journal", str(path))
    if not path.is_file():
        return JournalCheck(findings=[Finding(f"'{path}' is no file, and so no journal")])
    connection = sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)
    connection.text_factory = text_or_marks
    try:
        return _Check(connection).done(fold)
    finally:
        connection.close()


class _Check:
    def __init__(self, connection: sqlite3.Connection) -> None:
        self._connection = connection
        self._check = JournalCheck()
        self._unreadable: set[str] = set()

    def done(self, fold: FoldRun) -> JournalCheck:
        version = self._schema_version()
        if version is None:
            return self._check
        looks: list[Callable[[], None]] = [self._pages, self._events]
        if version >= WITH_CHAIN:
            looks += [self._chain, self._index]
        looks.append(partial(self._runs, fold))
        for look in looks:
            try:
                look()
            except (sqlite3.Error, ValueError, TypeError) as error:
                self._find(f"a part of the journal cannot be read at all: {error}")
        return self._check

    def _find(self, sentence: str, runs: Iterable[str | None] = ()) -> None:
        # A damaged row may have no text where its run should be.
        named = frozenset(run for run in runs if isinstance(run, str))
        # What SQLite says may have the text of a table in it, on several lines.
        finding = Finding(" ".join(sentence.split()), named)
        if finding not in self._check.findings:
            self._check.findings.append(finding)

    def _schema_version(self) -> int | None:
        try:
            row = self._connection.execute("SELECT max(version) FROM schema_version").fetchone()
            version = int(row[0] or 0)
        except (sqlite3.Error, ValueError, TypeError) as error:
            self._find(f"the file is not a journal, or nothing of it can be read ({error})")
            return None
        if version > len(MIGRATIONS):
            self._find(
                f"it has schema version {version}, this Mend knows up to {len(MIGRATIONS)}: use "
                "the newer Mend that wrote it"
            )
            return None
        return version

    def _pages(self) -> None:
        found = self._connection.execute(f"PRAGMA integrity_check({MOST_PAGE_FINDINGS})")
        for (text,) in found:
            if text != "ok":
                self._find(f"SQLite's own check: {text}")

    def _chain(self) -> None:
        for each in breaks(self._connection):
            self._find(each.sentence, each.runs)

    def _events(self) -> None:
        for row in self._connection.execute(f"{SELECT_ROWS} ORDER BY seq"):
            self._check.events += 1
            wrong = _what_is_wrong(row)
            if wrong is not None:
                self._unreadable.add(row[1])
                self._find(wrong, [row[1]])

    def _index(self) -> None:
        """The index says of each run what its events say."""
        told = {
            run: (begun, ended, status)
            for run, begun, ended, status in self._connection.execute(
                "SELECT run, begun, ended, status FROM runs"
            )
        }
        going = {run for (run,) in self._connection.execute("SELECT run FROM pruning")}
        for run, begun, ended, kind in self._ends():
            if run in going:
                continue
            if run not in told:
                self._find(f"run {run} has events, but is not in the index", [run])
                continue
            told_begun, told_ended, status = told.pop(run)
            status_is_right = status == UNREADABLE or kind is None or status == ENDINGS[kind]
            if (told_begun, told_ended) != (begun, ended) or not status_is_right:
                self._find(f"the index says of run {run} what its events do not", [run])
        for run in told:
            self._find(f"run {run} is in the index, but has no events", [run])

    def _ends(self) -> Iterator[tuple[str, int | None, int | None, str | None]]:
        """Each run with the numbers of its first event and of the one that ended it."""
        kinds = ", ".join(f"'{each}'" for each in ENDINGS)
        rows = self._connection.execute(
            "SELECT run, min(seq) FILTER (WHERE type = 'run_started'),"
            f" max(seq) FILTER (WHERE type IN ({kinds})) FROM events WHERE run != ? GROUP BY run",
            (str(ev.NO_RUN),),
        )
        for run, begun, ended in rows.fetchall():
            row = self._connection.execute(
                "SELECT type FROM events WHERE seq = ?", (ended,)
            ).fetchone()
            yield run, begun, ended, None if row is None else row[0]

    def _runs(self, fold: FoldRun) -> None:
        runs = self._connection.execute(
            "SELECT run, min(seq) AS begun FROM events WHERE run != ? GROUP BY run ORDER BY begun",
            (str(ev.NO_RUN),),
        ).fetchall()
        going = self._being_pruned()
        for run, _ in runs:
            if run in going:
                continue
            self._check.runs += 1
            if run not in self._unreadable:
                self._fold(run, fold)

    def _being_pruned(self) -> set[str]:
        try:
            return {run for (run,) in self._connection.execute("SELECT run FROM pruning")}
        except sqlite3.OperationalError:
            return set()  # A journal of an older Mend.

    def _fold(self, run: str, fold: FoldRun) -> None:
        rows = self._connection.execute(f"{SELECT_ROWS} WHERE run = ? ORDER BY seq", (run,))
        try:
            fold(UUID(run), (read_event(row[0], row[5], row[4]) for row in rows))
        except (RefusalError, JournalReadError) as error:
            self._find(str(error), [run])


def _what_is_wrong(row: Row) -> str | None:
    """What is wrong with an event by itself; None if nothing is."""
    seq, run, kind, time, version, body = row
    try:
        event = read_event(seq, body, version)
    except JournalReadError as error:
        return str(error)
    said = (event.seq, str(event.run), vars(event)["type"], event.time)
    if said != (seq, run, kind, time):
        return f"event {seq} is kept as the number, run, type or time of another"
    return None
