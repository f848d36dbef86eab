"""A service whose runs play a recording into a real journal, for tests of the command line."""

import asyncio
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from uuid import UUID, uuid4

from mend.errors import NotFoundError
from mend.server.fixed_documents import GivenFiles
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry
from mend.server.journal.sqlite import SqliteJournal
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus
from mend.server.settings import Settings

RECORDED = Path(__file__).parents[1] / "server" / "recorded" / "eket_paper.jsonl"
ENDS = {
    ev.RunFinished: RunStatus.FINISHED,
    ev.RunFailed: RunStatus.FAILED,
    ev.RunAborted: RunStatus.ABORTED,
}
JPEG = b"\xff\xd8 a picture \xff\xd9"


def recorded_events() -> list[ev.Event]:
    """A whole run of the paper's scenario."""
    return [ev.any_event.validate_json(line) for line in RECORDED.read_text().splitlines()]


@dataclass
class RecordedRuns:
    """Runs that play `events`; one that never ends waits to be aborted.

    `stops` ends a run's task without an end in the journal, as a fault of Mend's own would.
    """

    journal: SqliteJournal
    events: Sequence[ev.Event]
    stops: bool = False
    started: Callable[[], None] = lambda: None
    requests: list[RunRequest] = field(default_factory=list)

    async def start_run(self, request: RunRequest, author: ev.Author) -> Any:  # noqa: ARG002
        if request.tree == "nowhere":
            raise NotFoundError("there is no tree 'nowhere'")
        self.requests.append(request)
        self._run = uuid4()
        self._status = RunStatus.RUNNING
        self._ended = asyncio.Event()
        await self._play(self.events)
        asyncio.get_running_loop().call_soon(self.started)
        return SimpleNamespace(id=self._run)

    def robots(self) -> list[Any]:
        return []

    async def _play(self, events: Sequence[ev.Event]) -> None:
        for event in events:
            moved = event.model_copy(update={"run": self._run, "seq": 0})
            pictures = {}
            if isinstance(event, ev.IssueRaised) and event.picture:
                pictures = {event.picture: JPEG}
            await self.journal.append(Entry(events=[moved], pictures=pictures))
            if type(event) in ENDS:
                self._status = ENDS[type(event)]
                self._ended.set()

    async def wait_for_end(self, run: UUID) -> Any:
        assert run == self._run
        if not self.stops:
            await self._ended.wait()
        return SimpleNamespace(status=self._status)

    async def abort(self, run: UUID, author: ev.Author) -> None:  # noqa: ARG002
        last = self.events[-1]
        aborted = ev.RunAborted(time=last.time, wall_time=last.wall_time, run=run)
        await self._play([aborted])


@dataclass
class RecordedService:
    """Replaces `server.composition.open_service`; remembers what was asked of it."""

    events: Sequence[ev.Event]
    stops: bool = False
    started: Callable[[], None] = lambda: None
    settings: list[Settings] = field(default_factory=list)
    requests: list[RunRequest] = field(default_factory=list)
    given: list[GivenFiles] = field(default_factory=list)

    @asynccontextmanager
    async def open(
        self, settings: Settings, *, recover: bool = True, given: GivenFiles
    ) -> AsyncIterator[Any]:
        assert not recover, "a run of its own takes up no other run"
        self.given.append(given)
        self.settings.append(settings)
        journal = SqliteJournal(settings.journal_path)
        runs = RecordedRuns(journal, self.events, self.stops, self.started, self.requests)
        try:
            yield SimpleNamespace(
                runtime=runs, journal=journal, settings=settings, robots_url="ws://here/ws/robot"
            )
        finally:
            journal.close()
