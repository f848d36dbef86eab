"""A channel whose connection drops after so many messages; what was on its way is lost."""

from mend.robots.link.channel import Channel, ChannelClosedError


class DroppingChannel:
    """Implements `mend.robots.link.channel.Channel`."""

    def __init__(self, channel: Channel, *, sends: int, receives: int) -> None:
        self._channel = channel
        self._sends = sends
        self._receives = receives

    async def send(self, text: str) -> None:
        if self._sends == 0:
            await self._drop()
        self._sends -= 1
        await self._channel.send(text)

    async def receive(self) -> str:
        text = await self._channel.receive()
        if self._receives == 0:
            await self._drop()
        self._receives -= 1
        return text

    async def close(self) -> None:
        await self._channel.close()

    async def _drop(self) -> None:
        await self._channel.close()
        raise ChannelClosedError("dropped")
