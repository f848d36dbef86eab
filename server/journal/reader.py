"""Reading a journal that somebody else may be writing: its runs, events and pictures."""

import sqlite3
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any, Self
from uuid import UUID

from mend.server.journal.chain import Seals, at_one_moment, breaks
from mend.server.journal.events import Event
from mend.server.journal.journal import JournalReadError, UnreadableEvent
from mend.server.journal.migrations import MIGRATIONS, WITH_CHAIN, JournalSchemaError
from mend.server.journal.readable import event_of
from mend.server.journal.sqlite_errors import SQLITE_ERRORS, text_or_marks
from mend.server.journal.stored_event import current_text, read_event
from mend.server.journal.subscriptions import Record


class JournalReader:
    """A journal opened for reading only, without its lock.

    With `marks` text that is none is read, with a mark in its place, for those who look at the
    chain, which tells of it; else it is a `JournalReadError`. Raises `JournalSchemaError` for a
    file that is no journal, or one of a newer Mend, and `FileNotFoundError`.
    """

    def __init__(self, path: Path, *, marks: bool = False) -> None:
        if not path.is_file():
            raise FileNotFoundError(2, "there is no such journal", str(path))
        self._path = path
        self._connection = sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)
        if marks:
            self._connection.text_factory = text_or_marks
        try:
            self._check_schema(path)
        except BaseException:
            self._connection.close()
            raise

    def _check_schema(self, path: Path) -> None:
        try:
            row = self._connection.execute("SELECT max(version) FROM schema_version").fetchone()
            version = int(row[0] or 0)
        except (*SQLITE_ERRORS, ValueError, TypeError) as error:
            raise JournalSchemaError(f"'{path}' is not a journal ({error})") from error
        self._version = version
        if version > len(MIGRATIONS):
            raise JournalSchemaError(
                f"'{path}' has schema version {version}, this Mend knows up to {len(MIGRATIONS)}: "
                "use the newer Mend that wrote it"
            )

    def _select(self, statement: str, parameters: Sequence[Any] = ()) -> list[Any]:
        try:
            return self._connection.execute(statement, parameters).fetchall()
        except SQLITE_ERRORS as error:
            raise JournalReadError(f"'{self._path}' could not be read: {error}") from error

    def runs(self) -> list[UUID]:
        """Every run, in the order in which they began. Raises `JournalReadError`."""
        rows = self._select("SELECT run FROM events WHERE type = 'run_started' ORDER BY seq")
        try:
            return [UUID(run) for (run,) in rows]
        except (ValueError, TypeError, AttributeError) as error:
            raise JournalReadError(
                f"'{self._path}' could not be read: a run has no id any more"
            ) from error

    def events(self, run: UUID) -> list[Event]:
        """Every event of a run, in order.

        Raises `JournalReadError`.
        """
        rows = self._select(
            "SELECT seq, body, version FROM events WHERE run = ? ORDER BY seq", (str(run),)
        )
        where = f" of '{self._path}'"
        return [read_event(seq, body, version, where) for seq, body, version in rows]

    def records(self, run: UUID) -> Iterator[Record]:
        """The JSON of every event of a run, in order, one at a time.

        Raises `JournalReadError`.
        """
        where = f" of '{self._path}'"
        try:
            rows = self._connection.execute(
                "SELECT seq, body, version FROM events WHERE run = ? ORDER BY seq", (str(run),)
            )
            for seq, body, version in rows:
                yield Record(seq, current_text(seq, body, version, where))
        except SQLITE_ERRORS as error:
            raise JournalReadError(f"'{self._path}' could not be read: {error}") from error

    def of_types(self, types: Sequence[str]) -> Iterator[Event | UnreadableEvent]:
        """Every event of some types, in order, also those of no run and those that are unreadable.

        Raises `JournalReadError`.
        """
        marks = ", ".join("?" * len(types))
        rows = self._select(
            f"SELECT seq, run, body, version FROM events WHERE type IN ({marks}) ORDER BY seq",
            tuple(types),
        )
        return (event_of(seq, run, body, version) for seq, run, body, version in rows)

    @contextmanager
    def at_one_moment(self) -> Iterator[None]:
        """All that is read meanwhile is as it was when the first of it was read."""
        with at_one_moment(self._connection):
            yield

    def seals(self) -> Seals | None:
        """What the chain says of events; None for a journal of an older Mend, without a chain."""
        return Seals(self._connection) if self._version >= WITH_CHAIN else None

    def damage(self) -> list[str]:
        """A sentence for each place where the chain does not hold, in its whole length."""
        if self._version < WITH_CHAIN:
            return []
        found: list[str] = []
        try:
            found += (each.sentence for each in breaks(self._connection))
        except (*SQLITE_ERRORS, ValueError, TypeError) as error:
            found.append(f"a part of the journal cannot be read at all: {error}")
        return found

    def pictures(self, pictures: Iterable[UUID]) -> dict[UUID, bytes]:
        """Those of the pictures (JPEG) that the journal has."""
        found = {}
        for picture in pictures:
            rows = self._select("SELECT jpeg FROM pictures WHERE id = ?", (str(picture),))
            if rows:
                found[picture] = bytes(rows[0][0])
        return found

    def close(self) -> None:
        self._connection.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
