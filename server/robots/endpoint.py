"""The WebSocket route on which robots connect: `/ws/robot`."""

from collections.abc import Collection

from fastapi import FastAPI
from starlette.responses import Response
from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from robots.link.channel import ChannelClosedError
from server.api.access import Access
from server.api.problems import problem, problem_response
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
    access: Access,
    *,
    allowed_origins: Collection[str] = (),
) -> None:
    """Serve `/ws/robot`.

    Where `access` requires a token, a robot has to present it as a bearer token (else HTTP status
    401, or 429 while its address has to wait). A request with an `Origin` comes from a browser and
    is refused (403) unless that origin is allowed.
    """

    async def connect(websocket: WebSocket) -> None:
        refusal = _refusal(websocket, access, allowed_origins)
        if refusal is not None:
            await websocket.send_denial_response(refusal)
            return
        await websocket.accept()
        await registry.serve(StarletteChannel(websocket))

    app.add_api_websocket_route(ROBOT_PATH, connect)


def _refusal(
    websocket: WebSocket, access: Access, allowed_origins: Collection[str]
) -> Response | None:
    origin = websocket.headers.get("origin")
    if origin is not None and origin not in allowed_origins:
        return problem_response(problem(403, "robots connect without an Origin header"))
    admission = access.by_bearer(websocket)
    if admission.wait_s:
        return problem_response(problem(429, admission.too_many), admission.retry_after)
    if not admission.admitted:
        detail = "a robot has to present the service's token: 'Authorization: Bearer <token>'"
        return problem_response(problem(401, detail), {"WWW-Authenticate": "Bearer"})
    return None
