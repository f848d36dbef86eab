"""The clock by which the link paces, beats and waits; it is passed in."""

import asyncio
from typing import Protocol


class Clock(Protocol):
    """Seconds of some monotonic clock, and waiting on it."""

    def now(self) -> float: ...

    async def wait(self, event: asyncio.Event, timeout_s: float) -> None:
        """Return when `event` is set or `timeout_s` have passed, whichever is first."""
        ...


class LoopClock:
    """The running event loop's clock."""

    def now(self) -> float:
        return asyncio.get_running_loop().time()

    async def wait(self, event: asyncio.Event, timeout_s: float) -> None:
        try:
            async with asyncio.timeout(timeout_s):
                await event.wait()
        except TimeoutError:
            return
