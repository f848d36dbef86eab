"""Following the events over a WebSocket, across lost connections, and answering on the way."""

import asyncio
import contextlib
import itertools
import json
from collections.abc import AsyncIterator
from types import TracebackType
from typing import Any, Literal, Self
from uuid import UUID

from websockets.asyncio.client import ClientConnection
from websockets.exceptions import ConnectionClosed

from mend.server.api.helper_messages import Error
from mend.server.client_connection import HelperEndpoint, check_not_turned_away, readable
from mend.server.client_errors import CommandRefusedError, ConnectionLostError, UnreachableError
from mend.server.journal.events import Event, any_event
from mend.server.runtime.views import Snapshot

FIRST_PAUSE_S = 0.1
LONGEST_PAUSE_S = 5.0


class EventStream:
    """A snapshot, then every event after it, in order, none missing and none twice.

    An asynchronous context manager and iterator. A lost connection is made again from the last
    event seen; a second snapshot comes only if the service has lost that event. What nobody has
    taken yet waits here, without limit.
    """

    def __init__(self, door: HelperEndpoint, after: int | None = None) -> None:
        self._door = door
        self._seen = after
        self._snapshot_wanted = True
        self._socket: ClientConnection | None = None
        self._ids = itertools.count(1)
        self._waiting: dict[int, asyncio.Future[dict[str, Any]]] = {}
        self._reader: asyncio.Task[None] | None = None
        self._queue: asyncio.Queue[Snapshot | Event | Exception] = asyncio.Queue()

    @property
    def seen(self) -> int | None:
        """The `seq` of the last event that came, to go on from with `after`."""
        return self._seen

    async def __aenter__(self) -> Self:
        self._reader = asyncio.create_task(self._read())
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        assert self._reader is not None, "entered before"
        self._reader.cancel()
        await asyncio.gather(self._reader, return_exceptions=True)

    def __aiter__(self) -> AsyncIterator[Snapshot | Event]:
        return self._taken()

    async def _taken(self) -> AsyncIterator[Snapshot | Event]:
        while True:
            message = await self._queue.get()
            if isinstance(message, Exception):
                raise message
            yield message

    # --- the connection -----------------------------------------------------------------------

    async def _read(self) -> None:
        """Read for ever, so that commands get their results whatever the iterating side does."""
        pause_s = FIRST_PAUSE_S
        while True:
            before = self._seen
            try:
                with readable(), contextlib.suppress(UnreachableError):
                    await self._read_connection()
            except Exception as error:
                # Also one that is no refusal: whoever follows must not wait for ever.
                self._queue.put_nowait(error)
                return
            finally:
                self._socket = None
                self._forget_commands()
            pause_s = FIRST_PAUSE_S if self._seen != before else min(LONGEST_PAUSE_S, pause_s * 2)
            await asyncio.sleep(pause_s)

    async def _read_connection(self) -> None:
        """Read one connection to its end."""
        async with self._door.connected(after=self._seen) as socket:
            self._socket = socket
            async for message in self._messages(socket):
                self._queue.put_nowait(message)

    async def _messages(self, socket: ClientConnection) -> AsyncIterator[Snapshot | Event]:
        with contextlib.suppress(ConnectionClosed):
            async for text in socket:
                message = json.loads(text)
                if message["type"] == "snapshot":
                    snapshot = self._take_snapshot(message)
                    if snapshot is not None:
                        yield snapshot
                elif message["type"] in ("result", "error"):
                    self._settle(message)
                elif message["type"] == "trouble":
                    continue  # Nothing follows from it: the service goes on by itself.
                else:
                    # From the text: strict models take a list for a tuple in JSON only.
                    event: Event = any_event.validate_json(text)
                    self._seen = event.seq
                    yield event
        check_not_turned_away(socket)

    def _take_snapshot(self, message: dict[str, Any]) -> Snapshot | None:
        """The snapshot, unless it only repeats what was seen before the connection was lost."""
        wanted = self._snapshot_wanted or message["seq"] != self._seen
        self._snapshot_wanted = False
        self._seen = message["seq"]
        del message["type"]
        return Snapshot.model_validate_json(json.dumps(message)) if wanted else None

    # --- commands -----------------------------------------------------------------------------

    async def answer(
        self, dialogue: UUID, prompt: UUID, answer: Literal["yes", "no"]
    ) -> dict[str, Any]:
        """Answer a prompt; returns the `answered` event.

        Raises `CommandRefusedError` (`error.answered_by` if another was first) or
        `ConnectionLostError`.
        """
        return await self._command(
            type="answer", dialogue=str(dialogue), prompt=str(prompt), answer=answer
        )

    async def choose(self, dialogue: UUID, prompt: UUID, way: str) -> dict[str, Any]:
        """Choose one of a prompt's `ways`; returns and raises as `answer` does."""
        return await self._command(
            type="choose", dialogue=str(dialogue), prompt=str(prompt), way=way
        )

    async def extend(self, dialogue: UUID, prompt: UUID) -> dict[str, Any]:
        """Give the open question more time; raises as `answer` does."""
        return await self._command(type="extend", dialogue=str(dialogue), prompt=str(prompt))

    async def said_done(self, dialogue: UUID) -> dict[str, Any]:
        """Say that the awaited help is done; raises as `answer` does."""
        return await self._command(type="done", dialogue=str(dialogue))

    async def take_back(self, dialogue: UUID) -> dict[str, Any]:
        """Take back your promise to help; raises as `answer` does."""
        return await self._command(type="take_back", dialogue=str(dialogue))

    async def claim(self, dialogue: UUID, *, take_over: bool = False) -> dict[str, Any]:
        """Show the others that you are on it; raises as `answer` does."""
        return await self._command(type="claim", dialogue=str(dialogue), take_over=take_over)

    async def release(self, dialogue: UUID) -> dict[str, Any]:
        """Give up your claim; raises as `answer` does."""
        return await self._command(type="release", dialogue=str(dialogue))

    async def _command(self, **message: str | bool) -> dict[str, Any]:
        socket = self._socket
        if socket is None:
            raise ConnectionLostError("there is no connection to the service at the moment")
        number = next(self._ids)
        future: asyncio.Future[dict[str, Any]] = asyncio.get_running_loop().create_future()
        self._waiting[number] = future
        try:
            await socket.send(json.dumps({**message, "id": number}))
            return await future
        except ConnectionClosed as error:
            raise ConnectionLostError("the connection was lost before a result came") from error
        finally:
            self._waiting.pop(number, None)

    def _settle(self, message: dict[str, Any]) -> None:
        future = self._waiting.get(message["id"])
        if future is None or future.done():
            return
        if message["type"] == "result":
            future.set_result(message["result"])
        else:
            future.set_exception(CommandRefusedError(Error.model_validate(message)))

    def _forget_commands(self) -> None:
        for future in self._waiting.values():
            if not future.done():
                future.set_exception(
                    ConnectionLostError("the connection was lost before a result came")
                )
