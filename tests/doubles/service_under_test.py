"""The whole service around a fake runtime, in this process or behind real sockets."""

import asyncio
import contextlib
import shutil
import tempfile
import time
import weakref
from collections.abc import AsyncIterator, Callable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import httpx
from fake_runs import TREES, FakeRuns, FakeTreeChecker, FakeWorlds
from fastapi import FastAPI

from mend.server.access.access import Access
from mend.server.access.deed_log import DeedLog
from mend.server.app import build_access, create_app
from mend.server.documents import DocumentKind
from mend.server.fixed_documents import GivenFiles, NamedTexts, fixed_documents
from mend.server.fleets.fleets import Fleets
from mend.server.journal.sqlite import SqliteJournal
from mend.server.journaled_documents import JournaledDocuments
from mend.server.library import Library, build_library
from mend.server.limits import LimitName, Limits
from mend.server.listening import listen
from mend.server.models.own_models import OwnModels
from mend.server.models.robot_models import RobotModels, WorldModels
from mend.server.off_loop import OffLoop
from mend.server.pace import Sleep
from mend.server.poses.feed import PoseFeed
from mend.server.poses.record import PoseRecords
from mend.server.push.push import Push
from mend.server.refusals import Refusals
from mend.server.robots.passes import OwnRobots
from mend.server.robots.registry import RobotRegistry
from mend.server.scene_checks import WorldChecks
from mend.server.serving import Server, serve_config
from mend.server.settings import Settings
from mend.server.sites.sites import Sites
from mend.server.sites.worlds import SimulatedWorlds
from mend.server.speech.abilities import NO_SPEECH, SpeechAbilities

TOKEN = "correct-horse-battery"


@dataclass
class ServiceUnderTest:
    """A service and what is behind it; `url` once it is served."""

    app: FastAPI
    runs: FakeRuns
    journal: SqliteJournal
    settings: Settings
    poses: PoseFeed
    access: Access
    deeds: DeedLog
    url: str = "http://localhost"
    served_by: Server | None = None

    @property
    def server(self) -> Server:
        assert self.served_by is not None, "it is behind a socket"
        return self.served_by

    @property
    def refusals(self) -> Refusals:
        refusals: Refusals = self.app.state.services.refusals
        return refusals

    async def refused(self, limit: LimitName) -> None:
        """Wait until something was refused for this limit."""
        await until(lambda: self.refusals.counts[limit] > 0)

    async def left_alone(self) -> None:
        """Wait until no connection is left."""
        await until(lambda: len(self.server.visitors) == 0)

    @property
    def ws(self) -> str:
        return self.url.replace("http", "ws", 1) + "/ws/helper"

    def client(self, **arguments: Any) -> httpx.AsyncClient:
        """A client that talks to the application without a socket."""
        transport = httpx.ASGITransport(self.app, raise_app_exceptions=False)
        return httpx.AsyncClient(transport=transport, base_url=self.url, **arguments)


async def until(true: Callable[[], bool]) -> None:
    async with asyncio.timeout(60):
        while not true():  # noqa: ASYNC110 - the service has no events for its tests
            await asyncio.sleep(0.01)


def build(
    speech: SpeechAbilities = NO_SPEECH,
    *,
    runs_in: Callable[[SqliteJournal], FakeRuns] = FakeRuns,
    records: PoseRecords | None = None,
    models: Sequence[Any] = (),
    wall_time_s: Callable[[], float] = time.time,
    now: Callable[[], float] = time.monotonic,
    sleep: Sleep = asyncio.sleep,
    **settings: Any,
) -> ServiceUnderTest:
    """A service on an empty journal in memory; `models` are adapters that provide some."""
    journal = SqliteJournal(":memory:")
    runs = runs_in(journal)
    folder = Path(tempfile.mkdtemp())
    chosen = Settings(port=0, **{"data_dir": folder, **settings})

    def utc_now() -> datetime:
        return datetime.fromtimestamp(wall_time_s(), UTC)

    deeds = DeedLog(journal, utc_now)
    refusals = Refusals()
    access = build_access(
        chosen, deeds, refusals=refusals, wall_time_s=wall_time_s, now=now, sleep=sleep
    )
    fixed = fixed_documents(GivenFiles(), None)
    library = build_library(journal, fixed, WorldChecks({}), utc_now=utc_now)
    trees = JournaledDocuments(
        DocumentKind.TREE, journal, NamedTexts(TREES), FakeTreeChecker(), utc_now=utc_now
    )
    poses = PoseFeed(lambda *_: None, lambda _: None, records)
    sites = _no_sites(journal, library, utc_now)
    app = create_app(
        runs,
        journal,
        chosen,
        trees=trees,
        scenes=library.scenes,
        scenarios=library.scenarios,
        worlds=FakeWorlds(),
        sites=sites,
        fleets=Fleets(
            sites,
            runs,
            journal,
            poses,
            utc_now=utc_now,
            most_open=chosen.limits.open_requests,
        ),
        models=_models(WorldModels(models), journal, chosen, utc_now),
        poses=poses,
        access=access,
        deeds=deeds,
        push=Push(journal, runs.dialogues, runs, access, chosen, None, utc_now, now),
        speech_abilities=speech,
        refusals=refusals,
        wall_time_s=wall_time_s,
    )
    service = ServiceUnderTest(app, runs, journal, chosen, poses, access, deeds)
    weakref.finalize(service, shutil.rmtree, folder)
    return service


def _models(
    worlds: WorldModels, journal: SqliteJournal, settings: Settings, utc_now: Callable[[], datetime]
) -> RobotModels:
    """The journal is in memory, and yet models are kept, beside where it would be."""
    own = OwnModels(
        settings.models_path,
        journal,
        settings.limits,
        OffLoop(),
        utc_now=utc_now,
        taken=worlds.__contains__,
    )
    return RobotModels(worlds, own)


def _no_sites(journal: SqliteJournal, library: Library, utc_now: Callable[[], datetime]) -> Sites:
    """Sites of a service that has no world to open one in."""

    async def launch(*_: object) -> Any:
        raise AssertionError("there is no world to launch")

    registry = RobotRegistry(journal, time.monotonic)
    worlds, names = SimulatedWorlds({}), OwnRobots()
    return Sites(worlds, journal, registry, launch, names, Limits(), library, utc_now=utc_now)


@contextlib.asynccontextmanager
async def serving(
    speech: SpeechAbilities = NO_SPEECH,
    now: Callable[[], float] = time.monotonic,
    **arguments: Any,
) -> AsyncIterator[ServiceUnderTest]:
    """A service behind a real socket on a free port; by `now` connections are ended."""
    service = build(speech, now=now, **arguments)
    config = serve_config(service.app, service.settings)
    server = Server(config, service.settings, service.refusals, now=now)
    service.served_by = server
    server.config.log_level = None
    socket = listen(service.settings)
    service.url = f"http://127.0.0.1:{socket.getsockname()[1]}"
    server.config.load()
    server.lifespan = server.config.lifespan_class(server.config)
    await server.startup(sockets=[socket])
    try:
        yield service
    finally:
        await server.shutdown(sockets=[socket])
        service.journal.close()
