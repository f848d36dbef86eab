"""A helper's microphone on the service: conversations about one question each."""

from collections.abc import AsyncIterator
from types import TracebackType
from typing import Self
from urllib.parse import quote
from uuid import UUID

from pydantic import ValidationError
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidStatus

from server.api.speech_messages import AnySpeechServerMessage, speech_server_message


class SpeechRefusedError(Exception):
    """The service takes no speech from this client, or cannot be reached."""


class SpeechStream:
    """A connection that sends sound and tells what the service makes of it.

    An asynchronous context manager and iterator over the service's messages; it ends with the
    connection. Raises `SpeechRefusedError`.
    """

    def __init__(self, url: str, headers: dict[str, str], helper: str) -> None:
        self._address = url.replace("http", "ws", 1) + f"/ws/speech?helper={quote(helper)}"
        self._headers = headers
        self._socket: ClientConnection | None = None

    async def __aenter__(self) -> Self:
        try:
            self._socket = await connect(
                self._address, additional_headers=self._headers, compression=None
            )
        except InvalidStatus as error:
            status = error.response.status_code
            raise SpeechRefusedError(
                f"the service refused the connection ({status}): check the token and the address"
            ) from error
        except (OSError, InvalidHandshake, TimeoutError) as error:
            raise SpeechRefusedError(f"no service answers at {self._address}: {error}") from error
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        await self._connected.close()

    async def __aiter__(self) -> AsyncIterator[AnySpeechServerMessage]:
        try:
            async for text in self._connected:
                yield speech_server_message.validate_json(text)
        except ConnectionClosed as error:
            raise SpeechRefusedError(f"the connection was lost: {error}") from error
        except ValidationError as error:
            raise SpeechRefusedError(
                "the service sent what this client cannot read; is it of another version? "
                f"({error})"
            ) from error

    async def listen(self, dialogue: UUID, prompt: UUID) -> None:
        """Begin a conversation about an open question."""
        await self._send(f'{{"type": "listen", "dialogue": "{dialogue}", "prompt": "{prompt}"}}')

    async def spoken(self) -> None:
        """Say that what was to be said has been played."""
        await self._send('{"type": "spoken"}')

    async def sound(self, pcm: bytes) -> None:
        """Send sound: PCM16, mono, 16 kHz."""
        await self._send(pcm)

    async def _send(self, message: str | bytes) -> None:
        try:
            await self._connected.send(message)
        except ConnectionClosed as error:
            raise SpeechRefusedError(f"the connection was lost: {error}") from error

    @property
    def _connected(self) -> ClientConnection:
        assert self._socket is not None, "entered before"
        return self._socket
