"""A run's inbox: what it has to do, in turn, and who waits for what comes of it."""

import asyncio
import logging
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field

from mend.errors import ConflictError

log = logging.getLogger(__name__)

Task = Callable[[], Awaitable[object]]


@dataclass(slots=True)
class Item:
    """`asked_for`: somebody waits for what comes of it, and is told if it is refused.

    `patient`: it is not refused because the journal cannot be written, but waits until it can be.
    """

    task: Task
    asked_for: bool
    patient: bool = True
    done: asyncio.Future[object] = field(default_factory=asyncio.Future)

    def succeed(self, result: object) -> None:
        """Tell whoever waits what came of it."""
        if not self.done.done():
            self.done.set_result(result)

    def fail(self, error: Exception) -> None:
        """Tell whoever waits that nothing came of it."""
        if not self.done.done():
            self.done.set_exception(error)


class Inbox:
    """Items in the order in which they came."""

    def __init__(self) -> None:
        self._items: asyncio.Queue[Item] = asyncio.Queue()

    def tell(self, task: Task) -> None:
        """Have something done in turn; nobody waits for it."""
        item = Item(task, asked_for=False)
        item.done.add_done_callback(log_failure)
        self._items.put_nowait(item)

    def ask(self, task: Task, *, patient: bool) -> asyncio.Future[object]:
        """Have something done in turn; the future has what comes of it, or what that raises."""
        item = Item(task, asked_for=True, patient=patient)
        self._items.put_nowait(item)
        return item.done

    async def next(self, timeout_s: float | None) -> Item | None:
        """The next item, at once if there is one; None if none comes in time."""
        if not self._items.empty():
            return self._items.get_nowait()
        try:
            # Not `wait_for`: in Python 3.11 that swallows a cancellation that comes with an item.
            async with asyncio.timeout(timeout_s):
                return await self._items.get()
        except TimeoutError:
            return None

    def refuse_all(self, error: ConflictError) -> None:
        """Tell everybody who still waits that it comes to nothing."""
        while not self._items.empty():
            self._items.get_nowait().fail(error)

    def refuse_impatient(self, error: Exception) -> None:
        """Tell those who would not wait for a journal that it comes to nothing."""
        waiting = [self._items.get_nowait() for _ in range(self._items.qsize())]
        for item in waiting:
            if item.patient:
                self._items.put_nowait(item)
            else:
                item.fail(error)


def log_failure(done: asyncio.Future[object]) -> None:
    """Log what became of something that nobody waits for, if that is a fault of ours."""
    error = None if done.cancelled() else done.exception()
    if error is not None and not isinstance(error, ConflictError):
        log.error("a run could not take a robot's news", exc_info=error)
