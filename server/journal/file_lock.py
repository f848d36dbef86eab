"""The lock that keeps a second process from writing the same journal."""

import fcntl
from pathlib import Path

from server.journal.file_mode import keep_to_owner

MADE = "made\n"


class JournalLockedError(Exception):
    """Another process has the journal open."""


class FileLock:
    """An exclusive lock beside the journal, which the kernel frees when the process dies."""

    def __init__(self, journal: Path) -> None:
        # Whatever it is called by: another name of the file must not have a lock of its own.
        file = journal.resolve()
        path = file.with_name(file.name + ".lock")
        keep_to_owner(path)
        self._file = path.open("a+")
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            self._file.close()
            raise JournalLockedError(
                f"the journal {journal} is in use by another process: stop that one first, or "
                "choose another journal"
            ) from error

    @property
    def journal_was_made(self) -> bool:
        """Whether the journal beside it was ever opened to its end."""
        self._file.seek(0)
        return self._file.read() == MADE

    def say_made(self) -> None:
        """The journal is there: if its file is empty one day, it was damaged."""
        if not self.journal_was_made:
            self._file.write(MADE)
            self._file.flush()

    def release(self) -> None:
        self._file.close()
