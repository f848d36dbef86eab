"""A look at a journal as it is opened, bounded in time: its pages, and the end of its chain."""

import itertools
import sqlite3
import time
from collections.abc import Callable

from mend.errors import MendError
from mend.server.journal.chain import Break, breaks

TAIL_BATCHES = 256
MOST_BREAKS = 20
STEPS_BETWEEN_LOOKS = 1000
"""Of SQLite's machine, between two looks at the clock."""


class DamagedPagesError(MendError):
    """SQLite cannot make sense of the file."""


def quick_check(
    connection: sqlite3.Connection,
    within_s: float,
    monotonic: Callable[[], float] = time.monotonic,
) -> list[Break]:
    """Where the end of the chain does not hold.

    SQLite's own check of the pages goes on for at most `within_s`, so that of a large journal it
    sees only a part. Raises `DamagedPagesError`.
    """
    _check_pages(connection, within_s, monotonic)
    return list(itertools.islice(breaks(connection, TAIL_BATCHES), MOST_BREAKS))


def _check_pages(
    connection: sqlite3.Connection, within_s: float, monotonic: Callable[[], float]
) -> None:
    until = monotonic() + within_s
    connection.set_progress_handler(lambda: monotonic() > until, STEPS_BETWEEN_LOOKS)
    try:
        (found,) = connection.execute("PRAGMA quick_check(1)").fetchone()
    except sqlite3.OperationalError as error:
        if error.sqlite_errorcode != sqlite3.SQLITE_INTERRUPT:
            raise
        return
    finally:
        connection.set_progress_handler(None, 0)
    if found != "ok":
        raise DamagedPagesError(" ".join(found.split()))
