"""The WebSocket of those who watch a run: layouts as text, poses as binary frames."""

from uuid import UUID

from fastapi import APIRouter
from starlette.websockets import WebSocket

from mend.errors import NotFoundError, UnreadableError
from mend.server.api.helper_connection import (
    GOING_AWAY,
    THE_END,
    HelperConnection,
    HelperQuery,
    until_one_ends,
)
from mend.server.api.problem import problem
from mend.server.api.problems import problem_of
from mend.server.poses.feed import RunPoses
from mend.server.poses.layout import Layout

router = APIRouter()

LIVE_PATH = "/ws/live"
MAX_MESSAGE_CHARS = 4096


class LiveQuery(HelperQuery):
    """The address's parameters: which run, and who watches."""

    run: UUID


@router.websocket(LIVE_PATH)
async def live_socket(websocket: WebSocket) -> None:
    """Show one helper where everything is, until the run ends or they have seen enough."""
    await LiveSocket(websocket).run()


class LiveSocket(HelperConnection[LiveQuery]):
    """One watcher's connection."""

    def __init__(self, websocket: WebSocket) -> None:
        super().__init__(LIVE_PATH, websocket, LiveQuery, MAX_MESSAGE_CHARS)

    async def _serve(self, query: LiveQuery, helper: str) -> None:  # noqa: ARG002
        """Send what there is to see, until one of the two ends."""
        try:
            await self._parts.runs.run_summary(query.run)
        except (NotFoundError, UnreadableError) as error:
            await self._turn_away(problem_of(error) or problem(500, str(error)))
        else:
            await until_one_ends(self._show(query.run), self._wait_for_leave())

    async def _show(self, run: UUID) -> None:
        poses = self._parts.poses.of(run)
        if poses is None:
            await self._show_last(run)
        else:
            await self._follow(poses)
        if (await self._parts.runs.run_summary(run)).status.ended:
            await self._websocket.close(THE_END, "the run has ended")
        else:
            await self._websocket.close(GOING_AWAY, "the service stops")

    async def _follow(self, poses: RunPoses) -> None:
        with poses.watched() as watcher:
            while (news := await watcher.next()) is not None:
                if isinstance(news, Layout):
                    await self._send(news)
                else:
                    await self._websocket.send_bytes(news)

    async def _show_last(self, run: UUID) -> None:
        """What is left of a run that has ended."""
        layout = await self._parts.poses.layout(run)
        if layout is None:
            return
        await self._send(layout)
        frame = await self._parts.poses.last(run)
        if frame is not None:
            await self._websocket.send_bytes(frame)

    async def _wait_for_leave(self) -> None:
        while True:
            await self._receive()
