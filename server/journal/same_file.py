"""Noticing that a journal's file is deleted, moved or replaced while it is open."""

import os
from pathlib import Path

from mend.errors import MendError


class FileGoneError(MendError):
    """What would be written now would not be in the journal's file."""


class SameFile:
    """The files of one open journal: the database, and its write-ahead log once there is one.

    SQLite goes on writing to a file that has no name any more, and nobody would ever read it.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._log = path.with_name(path.name + "-wal")
        self._identities = {path: _identity(path)}

    def check(self) -> None:
        """Raises `FileGoneError`."""
        if self._log not in self._identities and (found := _identity(self._log)) is not None:
            self._identities[self._log] = found
        for path, identity in self._identities.items():
            found = _identity(path)
            if found is None:
                raise FileGoneError(
                    f"its file '{path}' was deleted or moved: put it back, or stop the service "
                    "and restore a backup"
                )
            if found != identity:
                raise FileGoneError(
                    f"its file '{path}' was replaced by another one: put the first one back, or "
                    "start the service again to use this one"
                )


def _identity(path: Path) -> tuple[int, int] | None:
    try:
        found = os.stat(path)  # noqa: PTH116 - before each commit: half the time of Path.stat
    except OSError:
        return None
    return found.st_dev, found.st_ino
