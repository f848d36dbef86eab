"""A typed client of the service, for users, the command line, the demo and tests."""

import asyncio
import contextlib
from collections.abc import AsyncIterator
from uuid import UUID

from mend.server.client_access import AccessCalls
from mend.server.client_connection import HelperEndpoint
from mend.server.client_dialogues import DialogueCalls
from mend.server.client_documents import DocumentCalls
from mend.server.client_errors import RefusedError, UnreachableError
from mend.server.client_models import ModelCalls
from mend.server.client_runs import RunCalls
from mend.server.client_sites import SiteCalls
from mend.server.client_speech import SpeechStream
from mend.server.client_stream import EventStream
from mend.server.journal.events import (
    RunAborted,
    RunFailed,
    RunFinished,
)
from mend.server.journal.trouble import Sleep
from mend.server.runtime.views import (
    RobotView,
    RunView,
    Snapshot,
)
from mend.server.speech.views import SpeechView

DEFAULT_URL = "http://127.0.0.1:8080"
READY_PAUSE_S = 0.1

ENDS = (RunFinished, RunFailed, RunAborted)


class MendClient(DocumentCalls, RunCalls, DialogueCalls, SiteCalls, AccessCalls, ModelCalls):
    """Talks to one service; an asynchronous context manager.

    Every method raises `RefusedError` or `UnreachableError`. What changes something is sent under
    an idempotency key, and sent again where a connection was lost before the answer had come.
    """

    def __init__(
        self,
        url: str = DEFAULT_URL,
        *,
        token: str | None = None,
        timeout_s: float = 30.0,
        sleep: Sleep = asyncio.sleep,
    ) -> None:
        super().__init__(url, token=token, timeout_s=timeout_s, sleep=sleep)

    async def robots(self) -> list[RobotView]:
        return await self._get("/api/robots", list[RobotView])

    async def wait_for_end(self, run: UUID) -> RunView:
        """Follow the events until a run has ended."""
        async with self.follow("waiting") as stream:
            async for message in stream:
                if isinstance(message, Snapshot) or (
                    isinstance(message, ENDS) and message.run == run
                ):
                    view = await self.run(run)
                    if view.status.ended:
                        return view
        raise AssertionError("a stream has no end of its own")

    # --- speech -------------------------------------------------------------------------------

    async def speech(self) -> SpeechView:
        """What the service can say and hear."""
        return await self._get("/api/speech", SpeechView)

    async def sound(self, address: str) -> bytes:
        """What a `say` message names, as a WAV file."""
        return (await self._request("GET", address)).content

    @contextlib.asynccontextmanager
    async def talk(self, helper: str) -> AsyncIterator[SpeechStream]:
        """A microphone, to answer questions by voice."""
        # Sound does not get smaller by deflating it, only later.
        door = HelperEndpoint(self._url, "/ws/speech", self._headers, helper)
        async with door.connected(compression=None) as socket:
            yield SpeechStream(socket)

    # --- events as they come ------------------------------------------------------------------

    def follow(self, helper: str, after: int | None = None) -> EventStream:
        """Follow every event from now on, or from the one after `after`, as a helper."""
        return EventStream(HelperEndpoint(self._url, "/ws/helper", self._headers, helper), after)

    async def wait_until_ready(self, timeout_s: float = 30.0) -> None:
        """Wait until the service can be used. Raises `UnreachableError` after the time-out."""
        try:
            async with asyncio.timeout(timeout_s):
                while True:
                    if await self._ready():
                        return
                    await asyncio.sleep(READY_PAUSE_S)
        except TimeoutError:
            raise UnreachableError(
                f"no service is ready at {self._url} after {timeout_s:g} s"
            ) from None

    async def _ready(self) -> bool:
        try:
            await self._request("GET", "/readyz")
        except (UnreachableError, RefusedError):
            return False
        return True
