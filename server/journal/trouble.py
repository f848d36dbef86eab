"""Whether a journal can be written, and trying again until it can."""

import asyncio
import logging
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from typing import Protocol

log = logging.getLogger(__name__)

FIRST_PAUSE_S = 0.1
LONGEST_PAUSE_S = 5.0

Watcher = Callable[[str | None], None]
"""Told why the journal cannot be written from now on, and None once it can be again."""


Turn = Callable[[], Awaitable[None]]


class Sleep(Protocol):
    """Lets so many seconds pass."""

    def __call__(self, delay: float, /) -> Awaitable[None]: ...


class Trouble:
    """Begins when a commit fails; ends when one succeeds.

    After each pause the first of those who wait tries again, which proves more than what would be
    written only to see whether it can be; where nobody waits that is tried, with `probe`. The
    pauses grow until something else than a probe was committed. Belongs to one event loop.
    """

    def __init__(self, probe: Callable[[], Awaitable[None]], sleep: Sleep) -> None:
        self.reason: str | None = None
        self._probe = probe
        self._sleep = sleep
        self._pause_s = FIRST_PAUSE_S
        self._watchers: list[Watcher] = []
        self._line: list[asyncio.Event] = []
        self._trying_now: asyncio.Event | None = None
        self._tried = asyncio.Event()
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
            self._let_all_try()

    async def begun(self) -> None:
        """Wait until the journal cannot be written."""
        await self._begun.wait()

    @asynccontextmanager
    async def in_line(self) -> AsyncIterator[Turn]:
        """Wait with others, in this order: what it yields waits until it is worth trying again.

        That is once the trouble is over or the journal closed, and after each pause for the first
        in line. Nobody else tries before that one waits again or has left.
        """
        place = asyncio.Event()
        self._line.append(place)

        async def turn() -> None:
            self._end_try(place)
            place.clear()
            if self.reason is not None and not self._closed:
                await place.wait()

        try:
            yield turn
        finally:
            self._line.remove(place)
            self._end_try(place)

    def _end_try(self, place: asyncio.Event) -> None:
        if self._trying_now is place:
            self._trying_now = None
            self._tried.set()

    def close(self) -> None:
        """Try no more."""
        self._closed = True
        self._let_all_try()
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
            if self._line:
                self._tried.clear()
                self._trying_now = self._line[0]
                self._trying_now.set()
                await self._tried.wait()
            else:
                await self._probe()

    def _let_all_try(self) -> None:
        for place in self._line:
            place.set()
