"""How fast a robot from outside is listened to: one that floods waits, and nobody else does."""

import asyncio
from collections.abc import Awaitable, Callable

from robots.link.channel import Channel

CHARS_OF_ONE = 4096
"""A longer message counts as one for each such part."""

BURST_S = 4.0
"""What was not said for so long may come at once."""


class Pace:
    """Lets through `per_s` messages a second; `now` is any monotonic clock in seconds."""

    def __init__(self, per_s: float, now: Callable[[], float]) -> None:
        self._per_s = per_s
        self._now = now
        self._left = per_s * BURST_S
        self._at = now()

    def take(self, messages: int) -> float:
        """Note that so many came; returns for how many seconds nothing more is to be read."""
        now = self._now()
        self._left = min(self._per_s * BURST_S, self._left + (now - self._at) * self._per_s)
        self._at = now
        self._left -= messages
        return max(0.0, -self._left / self._per_s)


class PacedChannel:
    """A robot's channel on which no more is read than its pace allows; the rest waits at its end.

    `held_back` is called for each message that had to wait.
    """

    def __init__(
        self,
        channel: Channel,
        pace: Pace,
        held_back: Callable[[], None],
        sleep: Callable[[float], Awaitable[None]] = asyncio.sleep,
    ) -> None:
        self._channel = channel
        self._pace = pace
        self._held_back = held_back
        self._sleep = sleep

    async def send(self, text: str) -> None:
        await self._channel.send(text)

    async def receive(self) -> str:
        text = await self._channel.receive()
        wait_s = self._pace.take(1 + len(text) // CHARS_OF_ONE)
        if wait_s > 0.0:
            self._held_back()
            await self._sleep(wait_s)
        return text

    async def close(self) -> None:
        await self._channel.close()
