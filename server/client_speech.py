"""A helper's microphone on the service: conversations about one question each."""

import json
from collections.abc import AsyncIterator
from uuid import UUID

from websockets.asyncio.client import ClientConnection
from websockets.exceptions import ConnectionClosed

from mend.server.api.speech_messages import AnySpeechServerMessage, speech_server_message
from mend.server.client_connection import check_not_turned_away, readable
from mend.server.client_errors import ConnectionLostError


class SpeechStream:
    """A connection that sends sound and tells what the service makes of it.

    An asynchronous iterator over the service's messages, which ends with the connection. Raises
    `StreamRefusedError` and `ConnectionLostError`.
    """

    def __init__(self, socket: ClientConnection) -> None:
        self._socket = socket

    async def __aiter__(self) -> AsyncIterator[AnySpeechServerMessage]:
        try:
            async for text in self._socket:
                with readable():
                    message = speech_server_message.validate_json(text)
                yield message
        except ConnectionClosed as error:
            check_not_turned_away(self._socket)
            raise _lost(error) from error

    async def listen(self, dialogue: UUID, prompt: UUID) -> None:
        """Begin a conversation about an open question."""
        await self._send(
            json.dumps({"type": "listen", "dialogue": str(dialogue), "prompt": str(prompt)})
        )

    async def spoken(self) -> None:
        """Say that what was to be said has been played."""
        await self._send('{"type": "spoken"}')

    async def sound(self, pcm: bytes) -> None:
        """Send sound: PCM16, mono, 16 kHz; empty where some is missing."""
        await self._send(pcm)

    async def _send(self, message: str | bytes) -> None:
        try:
            await self._socket.send(message)
        except ConnectionClosed as error:
            raise _lost(error) from error


def _lost(error: ConnectionClosed) -> ConnectionLostError:
    return ConnectionLostError(f"the connection was lost: {error}")
