"""Work in the background that has no end: nobody waits for it, so nobody would see it fail."""

import asyncio
import logging
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from mend.server.rare_log import RareLog

log = logging.getLogger(__name__)


def log_failure(task: asyncio.Task[None]) -> None:
    """Log what a task that nobody waits for has failed with, once it is done, by its name."""
    if not task.cancelled() and (error := task.exception()) is not None:
        log.error("the %s has failed", task.get_name(), exc_info=error)


class Endless:
    """Work that is done pass by pass; one that fails is logged, and the next is made all the same.

    `what` is what the log calls it; `monotonic` is any such clock in seconds.
    """

    def __init__(self, what: str, monotonic: Callable[[], float] = time.monotonic) -> None:
        self._what = what
        self._rare_log = RareLog(log, monotonic)

    @contextmanager
    def one_pass(self) -> Iterator[None]:
        """Raises nothing that is raised within."""
        try:
            yield
        except Exception as error:
            kind = type(error).__name__
            self._rare_log.warn(
                kind, f"{self._what} has failed and goes on ({kind}: {error})", error
            )
