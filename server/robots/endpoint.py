"""The WebSocket route on which robots connect: `/ws/robot`."""

import asyncio
from collections.abc import Collection
from contextlib import AbstractContextManager, suppress
from typing import Protocol

from fastapi import FastAPI
from starlette.requests import HTTPConnection
from starlette.responses import PlainTextResponse
from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from robots.link.channel import ChannelClosedError
from robots.link.messages import LinkError
from server.robots.passes import Pass
from server.robots.registry import RobotRegistry

ROBOT_PATH = "/ws/robot"

MAX_MESSAGE_BYTES = 1 << 20

REVOKED = "this credential is good no longer: enrol the robot again"
NO_BROWSERS = PlainTextResponse("robots connect without an Origin header", status_code=403)
NO_CREDENTIAL = PlainTextResponse(
    "a robot has to present its credential, or the service's token: 'Authorization: Bearer ...'",
    status_code=401,
    headers={"WWW-Authenticate": "Bearer"},
)

CLOSED_NORMALLY = 1000
MESSAGE_TOO_BIG = 1009


class StarletteChannel:
    """The service's end of an accepted WebSocket."""

    def __init__(self, websocket: WebSocket) -> None:
        self._websocket = websocket

    async def send(self, text: str) -> None:
        try:
            await self._websocket.send_text(text)
        except (WebSocketDisconnect, RuntimeError) as error:
            # Starlette raises a bare RuntimeError when the socket was closed on this side.
            raise ChannelClosedError(str(error)) from error

    async def receive(self) -> str:
        if self._websocket.client_state is not WebSocketState.CONNECTED:
            raise ChannelClosedError("the connection is closed")
        message = await self._websocket.receive()
        if message["type"] == "websocket.disconnect":
            raise ChannelClosedError(f"closed with code {message.get('code', CLOSED_NORMALLY)}")
        text = message.get("text")
        # A binary frame is a mistake like any other: it is read, not understood, and answered.
        content: str = text if text is not None else message["bytes"].decode(errors="replace")
        if len(content) > MAX_MESSAGE_BYTES:
            await self._close(MESSAGE_TOO_BIG)
            raise ChannelClosedError("a message was too big")
        return content

    async def close(self) -> None:
        await self._close(CLOSED_NORMALLY)

    async def _close(self, code: int) -> None:
        if self._websocket.application_state is not WebSocketState.CONNECTED:
            return
        if self._websocket.client_state is WebSocketState.CONNECTED:
            try:
                await self._websocket.close(code)
            except (WebSocketDisconnect, RuntimeError) as error:
                raise ChannelClosedError(str(error)) from error


class RobotAdmission(Protocol):
    """Who may connect as a robot."""

    def robot_pass(self, connection: HTTPConnection) -> Pass | None:
        """What a connection has shown; None if nothing that a robot may come in with."""
        ...

    def watched_robot(self, connection: HTTPConnection) -> AbstractContextManager[asyncio.Event]:
        """An event that is set once the connection may come in no longer."""
        ...

    def refused(self, connection: HTTPConnection) -> None:
        """Told of a connection that was refused for what it has shown."""
        ...


def add_robot_route(
    app: FastAPI,
    registry: RobotRegistry,
    admission: RobotAdmission,
    *,
    allowed_origins: Collection[str] = (),
) -> None:
    """Serve `/ws/robot`.

    A robot has to present its credential as a bearer token, or the service's own token where there
    is one (else HTTP status 401). A request with an `Origin` comes from a browser and is refused
    (403) unless that origin is allowed.
    """

    async def connect(websocket: WebSocket) -> None:
        origin = websocket.headers.get("origin")
        if origin is not None and origin not in allowed_origins:
            await websocket.send_denial_response(NO_BROWSERS)
            return
        shown = admission.robot_pass(websocket)
        if shown is None:
            admission.refused(websocket)
            await websocket.send_denial_response(NO_CREDENTIAL)
            return
        await websocket.accept()
        channel = StarletteChannel(websocket)
        with admission.watched_robot(websocket) as gone:
            revoking = asyncio.create_task(_end_when(gone, channel))
            try:
                await registry.serve(channel, shown)
            finally:
                revoking.cancel()

    app.add_api_websocket_route(ROBOT_PATH, connect)


async def _end_when(gone: asyncio.Event, channel: StarletteChannel) -> None:
    await gone.wait()
    with suppress(ChannelClosedError):
        await channel.send(LinkError(detail=REVOKED).model_dump_json())
        await channel.close()
