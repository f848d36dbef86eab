"""A robot from outside is listened to at its pace: one that floods waits, and nobody else does."""

from mend.robots.link.channel import Channel
from mend.server.pace import Pace


class PacedChannel:
    """A robot's channel on which no more is read than its pace allows."""

    def __init__(self, channel: Channel, pace: Pace) -> None:
        self._channel = channel
        self._pace = pace

    async def send(self, text: str) -> None:
        await self._channel.send(text)

    async def receive(self) -> str:
        text = await self._channel.receive()
        await self._pace.keep(len(text))
        return text

    async def close(self) -> None:
        await self._channel.close()
