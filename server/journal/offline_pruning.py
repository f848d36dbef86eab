"""Pruning a journal from another process than its service, also while that goes on writing."""

import asyncio
import sqlite3
import time
from collections.abc import Callable
from contextlib import closing
from datetime import datetime
from pathlib import Path
from typing import Any
from uuid import UUID

from mend.errors import UnavailableError, UnreadableError
from mend.server.journal.file_lock import FileLock, JournalLockedError
from mend.server.journal.migrations import MIGRATIONS, migrate
from mend.server.journal.pruning import Keep, Pruned, prune
from mend.server.journal.reader import JournalReader

BUSY_TIMEOUT_S = 30.0
SHORTEST_PAUSE_S = 0.005


async def prune_file(
    path: Path,
    keep: Keep,
    now: datetime,
    forget: Callable[[UUID], None] = lambda _: None,
    *,
    compact: bool = False,
) -> Pruned:
    """Take out of a journal's file what is not kept; `forget` is told of each run that goes.

    `compact` gives the room back to the disk, for which no service may have the journal. Raises
    `FileNotFoundError`, `JournalSchemaError`, `UnavailableError`, and with `compact`
    `JournalLockedError`.
    """
    with JournalReader(path):
        lock = _lock(path, needed=compact)
    try:
        with closing(_connect(path)) as connection:
            if lock is not None:
                migrate(connection)
            _refuse_older(path, connection)
            pruned = await prune(_Transactions(connection), keep, now, forget)
            if compact:
                connection.execute("VACUUM")
    except sqlite3.OperationalError as error:
        raise UnavailableError(f"the journal '{path}' could not be pruned: {error}") from error
    except sqlite3.DatabaseError as error:
        raise UnreadableError(
            f"the journal '{path}' is damaged ({error}): 'mend journal check' tells more"
        ) from error
    finally:
        if lock is not None:
            lock.release()
    return pruned


class _Transactions:
    """A transaction for each piece of work; the service writes in between."""

    def __init__(self, connection: sqlite3.Connection) -> None:
        self._connection = connection

    async def __call__(self, work: Callable[[sqlite3.Connection], Any], /) -> Any:
        self._connection.execute("BEGIN IMMEDIATE")
        began = time.monotonic()
        try:
            result = work(self._connection)
            self._connection.execute("COMMIT")
        except BaseException:
            if self._connection.in_transaction:
                self._connection.execute("ROLLBACK")
            raise
        # As long again as it took: SQLite lets nobody queue for the file.
        await asyncio.sleep(max(SHORTEST_PAUSE_S, time.monotonic() - began))
        return result


def _lock(path: Path, *, needed: bool) -> FileLock | None:
    """The journal's lock; None while a service has it."""
    try:
        return FileLock(path)
    except JournalLockedError:
        if needed:
            raise
        return None


def _connect(path: Path) -> sqlite3.Connection:
    connection = sqlite3.connect(path, timeout=BUSY_TIMEOUT_S, isolation_level=None)
    connection.execute("PRAGMA synchronous=FULL")
    return connection


def _refuse_older(path: Path, connection: sqlite3.Connection) -> None:
    (version,) = connection.execute("SELECT max(version) FROM schema_version").fetchone()
    if version != len(MIGRATIONS):
        raise UnavailableError(
            f"the journal '{path}' is in use by another version of Mend: stop that service first"
        )
