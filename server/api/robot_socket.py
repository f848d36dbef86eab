"""The WebSocket route on which robots connect: `/ws/robot`."""

import asyncio
from contextlib import suppress
from dataclasses import dataclass

from fastapi import FastAPI
from starlette.responses import Response
from starlette.types import Message
from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from mend.robots.link.channel import ChannelClosedError
from mend.robots.link.messages import LinkError
from mend.server.access.access import Access
from mend.server.access.principal import Caller
from mend.server.api.problem import problem
from mend.server.api.problems import problem_response
from mend.server.robots.address import ROBOT_PATH
from mend.server.robots.passes import Pass
from mend.server.robots.registry import RobotRegistry
from mend.server.robots.session import LAST_WORD_S

DEAF = "nothing more of it is listened to"
REVOKED = "this credential is good no longer: enrol the robot again"
NO_CREDENTIAL = (
    "a robot has to present its credential, or the service's token: 'Authorization: Bearer ...'"
)

CLOSED_NORMALLY = 1000


class StarletteChannel:
    """The service's end of an accepted WebSocket."""

    def __init__(self, websocket: WebSocket) -> None:
        self._websocket = websocket
        self._deaf = False
        self._patience: asyncio.Timeout | None = None

    def go_deaf(self) -> None:
        """Let nothing more be received, whatever has come already."""
        self._deaf = True
        if self._patience is not None:
            self._patience.reschedule(asyncio.get_running_loop().time())

    async def send(self, text: str) -> None:
        try:
            await self._websocket.send_text(text)
        except (WebSocketDisconnect, RuntimeError) as error:
            # Starlette raises a bare RuntimeError when the socket was closed on this side.
            raise ChannelClosedError(str(error)) from error

    async def receive(self) -> str:
        if self._websocket.client_state is not WebSocketState.CONNECTED:
            raise ChannelClosedError("the connection is closed")
        message = await self._next_message()
        if message["type"] == "websocket.disconnect":
            raise ChannelClosedError(f"closed with code {message.get('code', CLOSED_NORMALLY)}")
        text = message.get("text")
        # A binary frame is a mistake like any other: it is read, not understood, and answered.
        content: str = text if text is not None else message["bytes"].decode(errors="replace")
        return content

    async def _next_message(self) -> Message:
        if self._deaf:
            raise ChannelClosedError(DEAF)
        try:
            async with asyncio.timeout(None) as self._patience:
                return await self._websocket.receive()
        except TimeoutError:
            raise ChannelClosedError(DEAF) from None
        finally:
            self._patience = None

    async def close(self) -> None:
        if self._websocket.application_state is not WebSocketState.CONNECTED:
            return
        if self._websocket.client_state is WebSocketState.CONNECTED:
            try:
                await self._websocket.close(CLOSED_NORMALLY)
            except (WebSocketDisconnect, RuntimeError) as error:
                raise ChannelClosedError(str(error)) from error


def add_robot_route(app: FastAPI, registry: RobotRegistry, access: Access) -> None:
    """Serve `/ws/robot`.

    A robot has to present its credential as a bearer token, or the service's own token where there
    is one (else HTTP status 401, or 429 while it or its address has to wait). A request with an
    `Origin` comes from a browser and is refused (403).
    """

    async def connect(websocket: WebSocket) -> None:
        await access.look()
        shown = await _shown(websocket, access)
        if isinstance(shown, Response):
            await websocket.send_denial_response(shown)
            return
        await websocket.accept()
        channel = StarletteChannel(websocket)
        if shown.caller is None:
            await registry.serve(channel, shown.robot)
            return
        with access.watched(shown.caller) as gone:
            revoking = asyncio.create_task(_end_when(gone, channel))
            try:
                await registry.serve_stranger(channel, shown.robot)
            finally:
                revoking.cancel()

    app.add_api_websocket_route(ROBOT_PATH, connect)


async def _end_when(gone: asyncio.Event, channel: StarletteChannel) -> None:
    await gone.wait()
    # First: what it wants to be told may take as long as it likes to read it.
    channel.go_deaf()
    with suppress(ChannelClosedError, TimeoutError):
        async with asyncio.timeout(LAST_WORD_S):
            await channel.send(LinkError(detail=REVOKED).model_dump_json())
            await channel.close()


@dataclass(frozen=True, slots=True)
class _ShownRobot:
    """As which robot a connection may say hello; `caller` None: a process of this service's."""

    robot: Pass
    caller: Caller | None


async def _shown(websocket: WebSocket, access: Access) -> _ShownRobot | Response:
    if "origin" in websocket.headers:
        return problem_response(problem(403, "robots connect without an Origin header"))
    own = access.own_robot(websocket)
    if own is not None:
        return _ShownRobot(own, None)
    admission = await access.in_time(access.by_bearer(websocket))
    if admission.wait_s:
        return problem_response(problem(429, admission.too_many), admission.retry_after)
    robot = None if admission.caller is None else access.robot_pass(admission.caller)
    if robot is None:
        return problem_response(problem(401, NO_CREDENTIAL), {"WWW-Authenticate": "Bearer"})
    return _ShownRobot(robot, admission.caller)
