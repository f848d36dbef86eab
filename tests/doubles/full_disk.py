"""Disks that are full, and connections that cannot write."""

import asyncio
import contextlib
import sqlite3
import subprocess
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from mend.server.journal.sqlite import SqliteJournal


class Passing:
    """Time that passes at the loop's next turn; `pauses` are those that were asked for."""

    def __init__(self) -> None:
        self.pauses: list[float] = []

    async def __call__(self, delay: float, /) -> None:
        self.pauses.append(delay)
        await asyncio.sleep(0)


class Never:
    """A pause that does not end."""

    async def __call__(self, _: float, /) -> None:
        await asyncio.Event().wait()


class SmallDisk:
    """A file system of its own, which can be filled to the last byte."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._ballast = folder / "ballast"

    def fill(self) -> None:
        with self._ballast.open("ab", buffering=0) as ballast:
            for size in (1 << 20, 1 << 16, 1 << 12, 1):
                self._append_until_full(ballast, bytes(size))

    def _append_until_full(self, ballast: Any, block: bytes) -> None:
        with contextlib.suppress(OSError):
            while ballast.write(block) == len(block):
                pass

    def free(self) -> None:
        self._ballast.unlink()


@contextmanager
def small_disk(folder: Path, size_mb: int = 2) -> Iterator[SmallDisk]:
    """A small disk; the test is skipped where this user may not mount one."""
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", f"size={size_mb}m", "none", str(folder)]
    with contextlib.suppress(FileNotFoundError):
        if subprocess.run(mount, capture_output=True, check=False).returncode == 0:
            try:
                yield SmallDisk(folder)
            finally:
                subprocess.run(["umount", "-l", str(folder)], check=True)
            return
    pytest.skip("a file system of its own needs the right to mount one")


class FailingConnection:
    """A connection on which a statement that begins with `at` fails while `error` is set."""

    def __init__(self, connection: sqlite3.Connection, at: str = "COMMIT") -> None:
        self._connection = connection
        self._at = at
        self.error: str | Exception | None = None

    def execute(self, statement: str, *parameters: Any) -> Any:
        self._may_fail(statement)
        return self._connection.execute(statement, *parameters)

    def executemany(self, statement: str, parameters: Iterable[Any]) -> Any:
        rows = list(parameters)
        if rows:
            self._may_fail(statement)
        return self._connection.executemany(statement, rows)

    def _may_fail(self, statement: str) -> None:
        if self.error is not None and statement.startswith(self._at):
            error = self.error
            raise sqlite3.OperationalError(error) if isinstance(error, str) else error

    def __getattr__(self, name: str) -> Any:
        return getattr(self._connection, name)


def failing(journal: SqliteJournal, at: str = "COMMIT") -> FailingConnection:
    """The connection on which the journal writes from now on."""
    connection = FailingConnection(journal._write_connection, at)
    journal._writer._connection = connection  # type: ignore[assignment]
    return connection
