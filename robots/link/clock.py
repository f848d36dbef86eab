"""The clock by which the link paces, beats and waits; it is passed in."""

import asyncio
import time
from typing import Protocol


class Clock(Protocol):
    """Seconds of some monotonic clock, and waiting on it."""

    def now(self) -> float:
        """Seconds; may be asked in any thread."""
        ...

    async def wait(self, event: asyncio.Event, timeout_s: float) -> None:
        """Return when `event` is set or `timeout_s` have passed, whichever is first."""
        ...


class LoopClock:
    """This machine's clock, and waiting in the running event loop."""

    def now(self) -> float:
        return time.monotonic()

    async def wait(self, event: asyncio.Event, timeout_s: float) -> None:
        try:
            async with asyncio.timeout(timeout_s):
                await event.wait()
        except TimeoutError:
            return
