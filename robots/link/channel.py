"""A channel: an ordered, two-way stream of text messages, over a WebSocket or in memory."""

import asyncio
from typing import Protocol

from mend.errors import MendError


class ChannelClosedError(MendError):
    """The other end is gone; raised by `send` and `receive`."""


class LinkRefusedError(MendError):
    """The service does not want this robot; the message says why. Trying again will not help."""


class Channel(Protocol):
    """One end of a connection between a robot and the service."""

    async def send(self, text: str) -> None:
        """Send one message. Raises `ChannelClosedError`."""
        ...

    async def receive(self) -> str:
        """Wait for the next message. Raises `ChannelClosedError`."""
        ...

    async def close(self) -> None: ...


class MemoryChannel:
    """One end of a channel within one process."""

    def __init__(
        self, incoming: "asyncio.Queue[str | None]", outgoing: "asyncio.Queue[str | None]"
    ) -> None:
        self._incoming = incoming
        self._outgoing = outgoing
        self._closed = False

    async def send(self, text: str) -> None:
        if self._closed:
            raise ChannelClosedError
        self._outgoing.put_nowait(text)

    async def receive(self) -> str:
        if self._closed:
            raise ChannelClosedError
        text = await self._incoming.get()
        if text is None:
            self._closed = True
            raise ChannelClosedError
        return text

    async def close(self) -> None:
        if not self._closed:
            self._closed = True
            self._outgoing.put_nowait(None)
            self._incoming.put_nowait(None)


def memory_channel() -> tuple[MemoryChannel, MemoryChannel]:
    """A connected pair of ends."""
    a: asyncio.Queue[str | None] = asyncio.Queue()
    b: asyncio.Queue[str | None] = asyncio.Queue()
    return MemoryChannel(a, b), MemoryChannel(b, a)
