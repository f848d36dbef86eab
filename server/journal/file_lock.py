"""The lock that keeps a second process from writing the same journal."""

import fcntl
from pathlib import Path

from server.journal.file_mode import keep_to_owner


class JournalLockedError(Exception):
    """Another process has the journal open."""


class FileLock:
    """An exclusive lock beside the journal, which the kernel frees when the process dies."""

    def __init__(self, journal: Path) -> None:
        path = journal.with_name(journal.name + ".lock")
        keep_to_owner(path)
        self._file = path.open("w")
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            self._file.close()
            raise JournalLockedError(
                f"the journal {journal} is in use by another process: stop that one first, or "
                "choose another journal"
            ) from error

    def release(self) -> None:
        self._file.close()
