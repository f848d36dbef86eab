"""The WebSocket route on which robots connect: `/ws/robot`."""

import secrets
from collections.abc import Collection

from fastapi import FastAPI
from starlette.responses import PlainTextResponse
from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from robots.link.channel import ChannelClosedError
from server.api.access import welcome
from server.robots.registry import RobotRegistry

ROBOT_PATH = "/ws/robot"

MAX_MESSAGE_BYTES = 1 << 20

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


def add_robot_route(
    app: FastAPI,
    registry: RobotRegistry,
    token: str | None,
    *,
    allowed_origins: Collection[str] = (),
) -> None:
    """Serve `/ws/robot`.

    With a `token`, a robot has to present it as a bearer token (else HTTP status 401). A request
    with an `Origin` comes from a browser and is refused (403) unless that origin is allowed.
    """

    async def connect(websocket: WebSocket) -> None:
        refusal = _refusal(websocket, token, allowed_origins)
        if refusal is not None:
            await websocket.send_denial_response(refusal)
            return
        welcome(websocket)
        await websocket.accept()
        await registry.serve(StarletteChannel(websocket))

    app.add_api_websocket_route(ROBOT_PATH, connect)


def _refusal(
    websocket: WebSocket, token: str | None, allowed_origins: Collection[str]
) -> PlainTextResponse | None:
    origin = websocket.headers.get("origin")
    if origin is not None and origin not in allowed_origins:
        return PlainTextResponse("robots connect without an Origin header", status_code=403)
    if token is not None and not _presents(websocket, token):
        return PlainTextResponse(
            "a robot has to present the service's token: 'Authorization: Bearer <token>'",
            status_code=401,
            headers={"WWW-Authenticate": "Bearer"},
        )
    return None


def _presents(websocket: WebSocket, token: str) -> bool:
    scheme, _, presented = websocket.headers.get("authorization", "").partition(" ")
    right = secrets.compare_digest(presented.strip().encode(), token.encode())
    return right and scheme.lower() == "bearer"
