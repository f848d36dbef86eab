"""The lock that keeps a second process from writing the same journal."""

import fcntl
from pathlib import Path
from typing import IO

from mend.errors import MendError
from mend.server.journal.file_mode import keep_to_owner

MADE = "made\n"

HELD_HERE: set[tuple[int, int]] = set()
"""The files (device and inode) that this process has locked.

To close any descriptor of a database is to lose SQLite's own locks of it in this process, so one
that is in use is not opened only to find that out.
"""


class JournalLockedError(MendError):
    """Another process has the journal open."""


class FileLock:
    """Exclusive locks of a journal, which the kernel frees when the process dies.

    One beside the journal, which is there before it is, and one of its file, which is the same
    whatever the file is called and whatever becomes of the other one. SQLite's own locks are of
    another sort (`fcntl`), and neither sees the other.
    Raises `JournalLockedError` while somebody else has one of them, or `OSError`.
    """

    def __init__(self, journal: Path) -> None:
        self._journal = journal
        # Whatever it is called by: another name of the file must not have a lock of its own.
        self._path = journal.resolve()
        self._file: IO[bytes] | None = None
        self._identity: tuple[int, int] | None = None
        beside = self._path.with_name(self._path.name + ".lock")
        keep_to_owner(beside)
        self._beside = beside.open("a+")
        try:
            self._lock(self._beside)
            if self._path.is_file():
                self.lock_file()
        except BaseException:
            self.release()
            raise

    def lock_file(self) -> None:
        """Lock the journal's file itself, once there is one. Raises as the class does."""
        if self._file is not None:
            return
        found = self._path.stat()
        identity = found.st_dev, found.st_ino
        if identity in HELD_HERE:
            raise self._locked()
        self._file = self._path.open("rb")
        self._lock(self._file)
        self._identity = identity
        HELD_HERE.add(identity)

    def _lock(self, file: IO[bytes] | IO[str]) -> None:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise self._locked() from None

    def _locked(self) -> JournalLockedError:
        return JournalLockedError(
            f"the journal {self._journal} is in use by another process: stop that one first, or "
            "choose another journal"
        )

    @property
    def journal_was_made(self) -> bool:
        """Whether the journal beside it was ever opened to its end."""
        self._beside.seek(0)
        return self._beside.read() == MADE

    def say_made(self) -> None:
        """The journal is there: if its file is empty one day, it was damaged."""
        if not self.journal_was_made:
            self._beside.write(MADE)
            self._beside.flush()

    def release(self) -> None:
        """Free the journal, to which no connection is open any more."""
        if self._identity is not None:
            HELD_HERE.discard(self._identity)
        for file in (self._file, self._beside):
            if file is not None:
                file.close()
