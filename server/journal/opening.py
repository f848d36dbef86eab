"""Opening a journal's file: locked, brought to the newest version, and looked over."""

import sqlite3
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from mend.errors import UnavailableError, UnreadableError
from mend.server.journal.chain import Break, Chain
from mend.server.journal.file_lock import FileLock
from mend.server.journal.file_mode import OWNERS_FOLDER, keep_to_owner
from mend.server.journal.migrations import migrate
from mend.server.journal.other_writers import OtherWriters
from mend.server.journal.quick_check import DamagedPagesError, quick_check
from mend.server.journal.same_file import SameFile
from mend.server.journal.sqlite_errors import SQLITE_ERRORS

IN_MEMORY = ":memory:"


@dataclass(frozen=True, slots=True)
class OpenJournal:
    """Three connections to a journal (the same one in memory), and what was found on opening.

    `head` is the last `seq` ever given, also where its event was pruned.
    """

    write: sqlite3.Connection
    read: sqlite3.Connection
    look_up: sqlite3.Connection
    head: int
    chain: Chain
    damage: Sequence[Break]
    file: SameFile | None
    lock: FileLock | None
    others: OtherWriters


def open_journal(path: Path | str, busy_timeout_s: float, check_s: float) -> OpenJournal:
    """Open a journal, or begin one.

    Raises `JournalLockedError`, `JournalSchemaError`, `UnreadableError` or `UnavailableError`.
    """
    if str(path) == IN_MEMORY:
        return _connected(IN_MEMORY, busy_timeout_s, check_s, None, None)
    path = Path(path)
    try:
        path.parent.mkdir(mode=OWNERS_FOLDER, parents=True, exist_ok=True)
        lock = FileLock(path)
    except OSError as error:
        raise _cannot_open(path, error.strerror or str(error)) from error
    try:
        return _open_file(path, busy_timeout_s, check_s, lock)
    except BaseException:
        lock.release()
        raise


def _open_file(path: Path, busy_timeout_s: float, check_s: float, lock: FileLock) -> OpenJournal:
    try:
        _refuse_emptied(path, lock)
        keep_to_owner(path)
        lock.lock_file()
        _refuse_second_name(path)
        opened = _connected(str(path), busy_timeout_s, check_s, SameFile(path), lock)
        lock.say_made()
    except (sqlite3.OperationalError, OSError) as error:
        why = error.strerror if isinstance(error, OSError) else str(error)
        raise _cannot_open(path, str(why)) from error
    except (*SQLITE_ERRORS, DamagedPagesError) as error:
        raise _damaged(path, str(error)) from error
    return opened


def _refuse_emptied(path: Path, lock: FileLock) -> None:
    """A journal that was once made and has no bytes now would look like a new one."""
    if lock.journal_was_made and path.is_file() and path.stat().st_size == 0:
        raise UnreadableError(
            f"the journal '{path}' is empty, though it was not: put a backup in its place with "
            "'mend journal restore', or delete the file to begin a new journal"
        )


def _refuse_second_name(path: Path) -> None:
    """Beside each name of a file SQLite keeps another log of what is not in the file yet."""
    if path.stat().st_nlink > 1:
        raise _cannot_open(
            path,
            "its file has another name, too (a hard link), under which it would have another "
            "history: remove one of the names, or copy the file with 'mend journal backup'",
        )


def _cannot_open(path: Path, why: str) -> UnavailableError:
    return UnavailableError(f"the journal '{path}' cannot be opened: {why}")


def _damaged(path: Path, why: str) -> UnreadableError:
    return UnreadableError(
        f"the journal '{path}' is damaged ({why}): 'mend journal check' tells more, and 'mend "
        "journal restore' puts a backup in its place"
    )


def _connected(
    path: str, busy_timeout_s: float, check_s: float, file: SameFile | None, lock: FileLock | None
) -> OpenJournal:
    connect = partial(
        sqlite3.connect, path, timeout=busy_timeout_s, isolation_level=None,
        check_same_thread=False,
    )  # fmt: skip
    write = connect()
    try:
        migrate(write)
        write.execute("PRAGMA journal_mode=WAL")
        write.execute("PRAGMA synchronous=FULL")
        # Before anything is read of it: what comes later is somebody else's.
        others = OtherWriters(write)
        damage, chain = quick_check(write, check_s), Chain(write)
        (head,) = write.execute(
            "SELECT max((SELECT coalesce(max(seq), 0) FROM events),"
            " (SELECT coalesce(max(last), 0) FROM batches),"
            " (SELECT coalesce(max(through), 0) FROM pruned))"
        ).fetchone()
        read, look_up = (write, write) if path == IN_MEMORY else (connect(), connect())
    except BaseException:
        write.close()
        raise
    return OpenJournal(write, read, look_up, int(head), chain, damage, file, lock, others)
