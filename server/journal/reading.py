"""Reading a journal beside its writer, in a thread that whoever reads waits in line for."""

import asyncio
import sqlite3
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

from mend.server.journal.journal import JournalClosedError, JournalReadError
from mend.server.journal.sqlite_errors import SQLITE_ERRORS

T = TypeVar("T")


class ReadingThread:
    """Queries one connection in a thread of its own, one query after the other.

    `lock` is held meanwhile: in memory the writer has the same connection.
    """

    def __init__(self, connection: sqlite3.Connection, lock: threading.Lock, name: str) -> None:
        self._connection = connection
        self._lock = lock
        self._closed = False
        self._thread = ThreadPoolExecutor(max_workers=1, thread_name_prefix=name)

    async def query(self, query: Callable[[sqlite3.Connection], T]) -> T:
        """What a query finds. Raises `JournalReadError`, and `JournalClosedError` after `close`."""
        if self._closed:
            raise JournalClosedError("the journal is closed")
        return await asyncio.get_running_loop().run_in_executor(self._thread, self._read, query)

    async def select(self, statement: str, parameters: Any) -> list[Any]:
        """The rows that a statement finds. Raises as `query` does."""
        return await self.query(
            lambda connection: connection.execute(statement, parameters).fetchall()
        )

    def _read(self, query: Callable[[sqlite3.Connection], T]) -> T:
        try:
            with self._lock:
                return query(self._connection)
        except SQLITE_ERRORS as error:
            raise JournalReadError(f"the journal could not be read: {error}") from error

    def end(self) -> None:
        """Answer those who wait, then end the thread; the connection may be another's as well."""
        self._closed = True
        self._thread.shutdown()

    def close(self) -> None:
        """Close the connection, once every thread that reads from it has ended."""
        self._connection.close()
