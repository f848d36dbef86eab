"""Whether a journal can be written, and trying again until it can."""

import asyncio
import logging
from collections.abc import Awaitable, Callable
from typing import Protocol

log = logging.getLogger(__name__)

FIRST_PAUSE_S = 0.1
LONGEST_PAUSE_S = 5.0

Watcher = Callable[[str | None], None]
"""Told why the journal cannot be written from now on, and None once it can be again."""


class Sleep(Protocol):
    """Lets so many seconds pass."""

    def __call__(self, delay: float, /) -> Awaitable[None]: ...


class Trouble:
    """Begins when a commit fails; ends when one succeeds, for which `probe` is tried.

    The pauses between two tries grow until something else than a probe was committed: room for a
    probe need not be room for what waits. Belongs to one event loop.
    """

    def __init__(self, probe: Callable[[], Awaitable[None]], sleep: Sleep) -> None:
        self.reason: str | None = None
        self._probe = probe
        self._sleep = sleep
        self._pause_s = FIRST_PAUSE_S
        self._watchers: list[Watcher] = []
        self._over = asyncio.Event()
        self._begun = asyncio.Event()
        self._trying: asyncio.Task[None] | None = None
        self._closed = False

    def watch(self, watcher: Watcher) -> None:
        """Tell somebody of every change from now on."""
        self._watchers.append(watcher)

    def unwatch(self, watcher: Watcher) -> None:
        self._watchers.remove(watcher)

    def began(self, reason: str) -> None:
        """A commit has failed."""
        if self.reason is not None or self._closed:
            return
        if self._trying is not None:
            self._trying.cancel()
        log.error("%s; trying again until it can be", reason)
        self._over.clear()
        self._begun.set()
        self._change(reason)
        self._trying = asyncio.create_task(self._try_again(), name="journal-trouble")

    def ended(self, *, probed: bool) -> None:
        """A commit has succeeded, of nothing but a probe if `probed`."""
        if not probed:
            self._pause_s = FIRST_PAUSE_S
        if self.reason is not None:
            log.warning("the journal can be written again")
            self._begun.clear()
            self._change(None)
            self._over.set()

    async def begun(self) -> None:
        """Wait until the journal cannot be written."""
        await self._begun.wait()

    async def over(self) -> None:
        """Wait until the journal can be written, or is closed."""
        if self.reason is not None:
            await self._over.wait()

    def close(self) -> None:
        """Try no more."""
        self._closed = True
        self._over.set()
        if self._trying is not None:
            self._trying.cancel()

    def _change(self, reason: str | None) -> None:
        self.reason = reason
        for watcher in tuple(self._watchers):
            watcher(reason)

    async def _try_again(self) -> None:
        while self.reason is not None:
            pause_s = self._pause_s
            self._pause_s = min(LONGEST_PAUSE_S, pause_s * 2)
            await self._sleep(pause_s)
            await self._probe()
