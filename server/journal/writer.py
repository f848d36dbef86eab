"""The one thread that writes a journal: whatever is waiting shares one durable commit."""

import asyncio
import contextlib
import queue
import sqlite3
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from mend.server.journal.journal import JournalClosedError, JournalWriteError

MAX_BATCH = 1000

COMMIT_BUCKETS_S = (0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5)

Work = Callable[[sqlite3.Connection], Any]
"""Writes something within the transaction; if it raises, nothing of it remains."""

OF_WHAT_IS_WRITTEN = (
    sqlite3.IntegrityError,
    sqlite3.DataError,
    sqlite3.InterfaceError,
    sqlite3.ProgrammingError,
)
"""What SQLite has against a row or a value. Whatever else it raises is the file's fault."""


@dataclass(frozen=True, slots=True)
class Done:
    """What a committed piece of work returned, for whoever waits for it.

    `wrote`: whether it has changed any row.
    """

    future: "asyncio.Future[Any]"
    result: Any
    wrote: bool


@dataclass(frozen=True, slots=True)
class CommitStatistics:
    """`buckets`: how many commits took at most so many seconds, cumulative."""

    commits: int
    failures: int
    seconds: float
    buckets: tuple[tuple[float, int], ...]


class GroupCommitWriter:
    """Runs work in one thread on one connection, as many pieces per transaction as are waiting.

    `on_begin`, `before_work`, `before_commit` and `on_rollback` are called in the writer's thread,
    the second and third within the transaction; nothing is committed if one of the first three
    raises. In the event loop of those who wait, in the order of
    the commits, `on_commit` is called with what was committed, and `on_failure` with why nothing
    could be.
    """

    def __init__(
        self,
        connection: sqlite3.Connection,
        lock: threading.Lock,
        *,
        on_begin: Callable[[], None],
        before_work: Callable[[], None],
        before_commit: Callable[[sqlite3.Connection], None],
        on_rollback: Callable[[], None],
        on_commit: Callable[[list[Done]], None],
        on_failure: Callable[[str], None],
    ) -> None:
        self._connection = connection
        self._lock = lock
        self._on_begin = on_begin
        self._before_work = before_work
        self._before_commit = before_commit
        self._on_rollback = on_rollback
        self._on_commit = on_commit
        self._on_failure = on_failure
        self._waiting: queue.SimpleQueue[tuple[Work, asyncio.Future[Any]] | None] = (
            queue.SimpleQueue()
        )
        self._closed = False
        self._commits = 0
        self._failures = 0
        self._seconds = 0.0
        self._at_most = [0] * len(COMMIT_BUCKETS_S)
        self._thread = threading.Thread(target=self._run, name="journal-writer", daemon=True)
        self._thread.start()

    def submit(self, work: Work) -> "asyncio.Future[Any]":
        """Queue a piece of work; the future has its result once it is durable."""
        if self._closed:
            raise JournalClosedError("the journal is closed")
        future: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
        self._waiting.put((work, future))
        return future

    @property
    def lives(self) -> bool:
        """Whether anything can still be written; False also once it is closed."""
        return self._thread.is_alive()

    def statistics(self) -> CommitStatistics:
        return CommitStatistics(
            self._commits,
            self._failures,
            self._seconds,
            tuple(zip(COMMIT_BUCKETS_S, self._at_most, strict=True)),
        )

    def close(self) -> None:
        """Write what is waiting, then end the thread."""
        if not self._closed:
            self._closed = True
            self._waiting.put(None)
            self._thread.join()

    def _run(self) -> None:
        while batch := self._next_batch():
            self._commit(batch)

    def _next_batch(self) -> list[tuple[Work, "asyncio.Future[Any]"]]:
        """Wait for work and take all there is; empty when the journal is to close."""
        first = self._waiting.get()
        if first is None:
            return []
        batch = [first]
        with contextlib.suppress(queue.Empty):
            while len(batch) < MAX_BATCH:
                item = self._waiting.get_nowait()
                if item is None:
                    self._waiting.put(None)
                    break
                batch.append(item)
        return batch

    def _commit(self, batch: list[tuple[Work, "asyncio.Future[Any]"]]) -> None:
        began = time.perf_counter()
        done: list[Done] = []
        refused: list[tuple[asyncio.Future[Any], Exception]] = []
        failure: JournalWriteError | None = None
        try:
            with self._lock:
                self._on_begin()
                self._connection.execute("BEGIN IMMEDIATE")
                self._before_work()
                for work, future in batch:
                    try:
                        done.append(self._do(work, future))
                    except Exception as error:
                        if not _is_of_the_piece(error):
                            raise
                        refused.append((future, error))
                self._before_commit(self._connection)
                self._connection.execute("COMMIT")
        except Exception as error:
            # Whatever it is: this thread is the only one that writes, and everybody waits for it.
            self._roll_back()
            self._failures += 1
            failure = JournalWriteError(f"the journal could not be written: {_why(error)}")
            refused = [(future, failure) for _, future in batch]
            done = []
        else:
            self._measure(time.perf_counter() - began)
        self._deliver(batch[0][1].get_loop(), done, refused, failure)

    def _do(self, work: Work, future: "asyncio.Future[Any]") -> Done:
        """Do one piece; the others of the batch stand if it is refused."""
        self._connection.execute("SAVEPOINT piece")
        before = self._connection.total_changes
        try:
            result = work(self._connection)
        except Exception as error:
            # SQLite itself may have rolled back everything where the fault is not the piece's.
            if _is_of_the_piece(error):
                self._connection.execute("ROLLBACK TO piece")
                self._connection.execute("RELEASE piece")
            raise
        self._connection.execute("RELEASE piece")
        return Done(future, result, self._connection.total_changes > before)

    def _roll_back(self) -> None:
        with self._lock, contextlib.suppress(Exception):
            if self._connection.in_transaction:
                self._connection.execute("ROLLBACK")
        self._on_rollback()

    def _measure(self, seconds: float) -> None:
        self._commits += 1
        self._seconds += seconds
        for index, limit in enumerate(COMMIT_BUCKETS_S):
            self._at_most[index] += seconds <= limit

    def _deliver(
        self,
        loop: asyncio.AbstractEventLoop,
        done: list[Done],
        refused: list[tuple["asyncio.Future[Any]", Exception]],
        failure: JournalWriteError | None,
    ) -> None:
        def settle() -> None:
            try:
                if failure is None:
                    self._on_commit(done)
                else:
                    self._on_failure(str(failure))
            finally:
                for each in done:
                    if not each.future.done():
                        each.future.set_result(each.result)
                for future, error in refused:
                    if not future.done():
                        future.set_exception(error)

        # A loop that has ended has nobody left who waits.
        with contextlib.suppress(RuntimeError):
            loop.call_soon_threadsafe(settle)


def _is_of_the_piece(error: Exception) -> bool:
    """Whether a piece of work failed for what it is, so that others can still be written."""
    if isinstance(error, sqlite3.Error):
        return isinstance(error, OF_WHAT_IS_WRITTEN)
    return not isinstance(error, MemoryError)


def _why(error: Exception) -> str:
    return str(error) or ("out of memory" if isinstance(error, MemoryError) else repr(error))
