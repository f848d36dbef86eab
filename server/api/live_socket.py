"""The WebSocket of those who watch a run: layouts as text, poses as binary frames."""

import asyncio
from typing import Any
from uuid import UUID

from fastapi import APIRouter
from pydantic import BaseModel, ConfigDict, ValidationError
from starlette.websockets import WebSocket, WebSocketDisconnect

from server.api.admission import POLICY_VIOLATION, admit
from server.api.helper_messages import Auth, Error, client_message
from server.api.helper_socket import GOING_AWAY
from server.api.parts import HelperName, Parts, parts_of
from server.api.problems import problem, validation_sentences
from server.errors import NotFoundError
from server.poses.feed import RunPoses
from server.poses.layout import Layout

router = APIRouter()

THE_END = 1000
MAX_MESSAGE_CHARS = 4096


class LiveQuery(BaseModel):
    """The address's parameters: which run, and who watches."""

    model_config = ConfigDict(extra="ignore", frozen=True)

    run: UUID
    helper: HelperName


@router.websocket("/ws/live")
async def live_socket(websocket: WebSocket) -> None:
    """Show one helper where everything is, until the run ends or they have seen enough."""
    socket = LiveSocket(websocket, parts_of(websocket))
    try:
        run = await socket.admitted()
        if run is not None:
            await socket.serve(run)
    except WebSocketDisconnect:
        pass


class LiveSocket:
    """One watcher's connection."""

    def __init__(self, websocket: WebSocket, parts: Parts) -> None:
        self._websocket = websocket
        self._parts = parts

    async def admitted(self) -> UUID | None:
        """Let the watcher in; the run to watch, or None where there is nothing to see."""
        if not await admit(self._websocket, self._parts.access, self._first_token):
            return None
        try:
            query = LiveQuery.model_validate(dict(self._websocket.query_params))
            self._parts.runs.run(query.run)
        except ValidationError as error:
            sentences = validation_sentences(error.errors())
            await self._refuse(422, "the address is wrong", sentences)
        except NotFoundError as error:
            await self._refuse(404, str(error))
        else:
            return query.run
        return None

    async def serve(self, run: UUID) -> None:
        """Send what there is to see, until one of the two ends."""
        sending = asyncio.create_task(self._send(run))
        leaving = asyncio.create_task(self._wait_for_leave())
        await asyncio.wait((sending, leaving), return_when=asyncio.FIRST_COMPLETED)
        sending.cancel()
        leaving.cancel()
        for outcome in await asyncio.gather(sending, leaving, return_exceptions=True):
            if isinstance(outcome, Exception):
                raise outcome

    async def _send(self, run: UUID) -> None:
        poses = self._parts.poses.of(run)
        if poses is None:
            await self._show_last(run)
        else:
            await self._follow(poses)
        if self._parts.runs.run(run).status.ended:
            await self._websocket.close(THE_END, "the run has ended")
        else:
            await self._websocket.close(GOING_AWAY, "the service stops")

    async def _follow(self, poses: RunPoses) -> None:
        with poses.watched() as watcher:
            while (news := await watcher.next()) is not None:
                if isinstance(news, Layout):
                    await self._websocket.send_text(news.model_dump_json())
                else:
                    await self._websocket.send_bytes(news)

    async def _show_last(self, run: UUID) -> None:
        """What is left of a run that has ended."""
        layout = await self._parts.poses.layout(run)
        if layout is None:
            return
        await self._websocket.send_text(layout.model_dump_json())
        frame = await self._parts.poses.last(run)
        if frame is not None:
            await self._websocket.send_bytes(frame)

    async def _wait_for_leave(self) -> None:
        while True:
            frame = await self._websocket.receive()
            if frame["type"] == "websocket.disconnect":
                raise WebSocketDisconnect(frame.get("code", THE_END))

    async def _first_token(self) -> str | None:
        frame: Any = await self._websocket.receive()
        if frame["type"] == "websocket.disconnect":
            raise WebSocketDisconnect(frame.get("code", THE_END))
        text = frame.get("text") or ""
        try:
            message = client_message.validate_json(text[:MAX_MESSAGE_CHARS])
        except ValidationError:
            return None
        return message.token if isinstance(message, Auth) else None

    async def _refuse(self, status: int, detail: str, errors: list[str] | None = None) -> None:
        title = problem(status, detail).title
        error = Error(status=status, title=title, detail=detail, errors=errors)
        await self._websocket.send_text(error.model_dump_json())
        await self._websocket.close(POLICY_VIOLATION, detail[:100])
