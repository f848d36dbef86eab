"""A robot from outside is listened to at its pace: one that floods waits, and nobody else does."""

import asyncio
from collections.abc import Awaitable, Callable

from robots.link.channel import Channel
from server.pace import Pace


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
        wait_s = self._pace.take(len(text))
        if wait_s > 0.0:
            self._held_back()
            await self._sleep(wait_s)
        return text

    async def close(self) -> None:
        await self._channel.close()
