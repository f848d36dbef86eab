"""Copies of a journal: made while it is written, and put back in its place."""

import os
import sqlite3
from contextlib import closing
from pathlib import Path

from mend.errors import MendError
from mend.server.journal.file_lock import FileLock
from mend.server.journal.file_mode import OWNERS_FOLDER, keep_to_owner
from mend.server.journal.reader import JournalReader
from mend.server.journal.sqlite_errors import SQLITE_ERRORS

BUSY_TIMEOUT_S = 5.0


def back_up(journal: Path, target: Path, *, force: bool = False) -> None:
    """Copy a journal as it is at one moment, also while a service writes to it.

    A target that is there is replaced only by `force`, and only once the copy is whole. Raises
    `JournalLockedError` while a service has the target, `MendError`, `JournalSchemaError` or
    `OSError`.
    """
    with JournalReader(journal):
        _refuse_same(journal, target)
        _refuse_existing(target, force)
        # What is to be replaced may be somebody's journal.
        lock = FileLock(target) if target.exists() else None
        try:
            _copy(journal, target)
        finally:
            if lock is not None:
                lock.release()


def restore(backup: Path, journal: Path, *, force: bool = False) -> None:
    """Put a backup in a journal's place. Raises `JournalLockedError` while a service has it.

    The journal that is there is replaced only by `force`. Raises `MendError` for a backup that is
    damaged, `JournalSchemaError` or `OSError`.
    """
    with JournalReader(backup):
        _refuse_same(backup, journal)
        journal.parent.mkdir(mode=OWNERS_FOLDER, parents=True, exist_ok=True)
        lock = FileLock(journal)
        try:
            _refuse_existing(journal, force)
            _copy(backup, journal)
            lock.say_made()
        finally:
            lock.release()


def _refuse_same(source: Path, target: Path) -> None:
    if target.exists() and target.samefile(source):
        raise MendError(f"'{target}' is the journal itself: choose another file")


def _refuse_existing(target: Path, force: bool) -> None:
    if target.is_dir():
        raise MendError(f"'{target}' is a directory: name a file in it")
    if target.exists() and not force:
        raise MendError(f"'{target}' is there already: give --force to replace it")


def _copy(source: Path, target: Path) -> None:
    draft = target.with_name(target.name + ".draft")
    draft.unlink(missing_ok=True)
    try:
        keep_to_owner(draft)
        _copy_pages(source, draft)
        _put_in_place(draft, target)
    except sqlite3.Error as error:
        raise MendError(f"'{source}' could not be copied to '{target}': {error}") from error
    finally:
        for left in (draft, *_logs(draft)):
            left.unlink(missing_ok=True)


def _copy_pages(source: Path, draft: Path) -> None:
    uri = f"{source.resolve().as_uri()}?mode=ro"
    with closing(sqlite3.connect(uri, uri=True)) as read, closing(sqlite3.connect(draft)) as write:
        # In one step: it would begin anew whenever somebody has written meanwhile. Who writes is
        # not kept waiting, as readers of a write-ahead log never do that.
        read.backup(write, pages=-1)
        # One file, which reading leaves alone; a service sets its journal to a log again.
        write.execute("PRAGMA journal_mode=DELETE")
        (found,) = write.execute("PRAGMA quick_check(1)").fetchone()
        if found != "ok":
            raise MendError(f"'{source}' is damaged ({found}): nothing was replaced")
    with draft.open("rb") as copied:
        os.fsync(copied.fileno())


def _put_in_place(draft: Path, target: Path) -> None:
    """Replace a journal. What its log still holds must go first: it would spoil the new one."""
    if target.exists():
        _empty_log(target)
    for log in _logs(target):
        log.unlink(missing_ok=True)
    draft.replace(target)
    folder = os.open(target.parent, os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)


def _empty_log(target: Path) -> None:
    """Whatever happens before the new journal is in place, the old one is whole.

    Raises `MendError` where its log has to stay.
    """
    try:
        with closing(sqlite3.connect(target, timeout=BUSY_TIMEOUT_S)) as old:
            (busy, _, _) = old.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()
            why = "somebody else is reading or writing it" if busy else None
    except sqlite3.OperationalError as error:
        why = str(error)
    except SQLITE_ERRORS:
        # It is no journal, or one no longer: there is nothing to keep whole.
        why = None
    if why is not None:
        raise MendError(
            f"the log of '{target}' could not be emptied ({why}): nothing was replaced; try again"
        )


def _logs(path: Path) -> tuple[Path, Path]:
    return path.with_name(path.name + "-wal"), path.with_name(path.name + "-shm")
