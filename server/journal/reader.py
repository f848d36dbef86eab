"""Reading a journal that somebody else may be writing: its runs, events and pictures."""

import sqlite3
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from types import TracebackType
from typing import Self
from uuid import UUID

from pydantic import ValidationError

from server.journal.events import Event, any_event
from server.journal.migrations import MIGRATIONS, JournalSchemaError
from server.journal.upgrades import upgrade_text


class UnreadableEventError(Exception):
    """An event is not what any Mend writes; the message says which."""


class JournalReader:
    """A journal opened for reading only, without its lock.

    Raises `JournalSchemaError` for a file that is no journal, or one of a newer Mend, and
    `FileNotFoundError`.
    """

    def __init__(self, path: Path) -> None:
        if not path.is_file():
            raise FileNotFoundError(2, "there is no such journal", str(path))
        self._path = path
        self._connection = sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)
        try:
            self._check_schema(path)
        except BaseException:
            self._connection.close()
            raise

    def _check_schema(self, path: Path) -> None:
        try:
            row = self._connection.execute("SELECT max(version) FROM schema_version").fetchone()
        except sqlite3.DatabaseError as error:
            raise JournalSchemaError(f"'{path}' is not a journal ({error})") from error
        if (row[0] or 0) > len(MIGRATIONS):
            raise JournalSchemaError(
                f"'{path}' has schema version {row[0]}, this Mend knows up to {len(MIGRATIONS)}: "
                "use the newer Mend that wrote it"
            )

    def runs(self) -> list[UUID]:
        """Every run, in the order in which they began."""
        rows = self._connection.execute(
            "SELECT run FROM events WHERE type = 'run_started' ORDER BY seq"
        )
        return [UUID(run) for (run,) in rows]

    def events(self, run: UUID) -> list[Event]:
        """Every event of a run, in order.

        Raises `UnknownEventVersionError` or `UnreadableEventError`.
        """
        rows = self._connection.execute(
            "SELECT seq, body, version FROM events WHERE run = ? ORDER BY seq", (str(run),)
        )
        return [self._event(seq, upgrade_text(body, version)) for seq, body, version in rows]

    def of_types(self, types: Sequence[str]) -> Iterator[Event]:
        """Every event of some types, in order, also those of no run. Raises as `events` does."""
        marks = ", ".join("?" * len(types))
        rows = self._connection.execute(
            f"SELECT seq, body, version FROM events WHERE type IN ({marks}) ORDER BY seq",
            tuple(types),
        )
        return (self._event(seq, upgrade_text(body, version)) for seq, body, version in rows)

    def _event(self, seq: int, text: str) -> Event:
        try:
            event: Event = any_event.validate_json(text)
        except ValidationError as error:
            first = error.errors(include_url=False, include_input=False, include_context=False)[0]
            where = ".".join(str(each) for each in first["loc"])
            raise UnreadableEventError(
                f"event {seq} of '{self._path}' cannot be read: {where}: {first['msg']}"
            ) from error
        return event

    def pictures(self, pictures: Iterable[UUID]) -> dict[UUID, bytes]:
        """Those of the pictures (JPEG) that the journal has."""
        found = {}
        for picture in pictures:
            row = self._connection.execute(
                "SELECT jpeg FROM pictures WHERE id = ?", (str(picture),)
            ).fetchone()
            if row is not None:
                found[picture] = bytes(row[0])
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
