"""A runtime over the real robot link, with one task tree and no simulated worlds."""

import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from datetime import UTC, datetime

from loopback import served
from pretend_service import OneTree, PretendWorlds

from mend.dialogue.registry import load_scripts
from mend.server.dialogues.escalation import EscalationPolicy
from mend.server.journal.sqlite import SqliteJournal
from mend.server.poses.feed import PoseFeed
from mend.server.refusals import Refusals
from mend.server.robots.registry import RobotRegistry
from mend.server.robots.times import LinkTimes
from mend.server.runtime.context import RunSettings
from mend.server.runtime.runtime import Runtime


@dataclass(frozen=True)
class LiveService:
    """What a test of live robots touches; robots connect to `url`."""

    runtime: Runtime
    registry: RobotRegistry
    journal: SqliteJournal
    url: str
    refusals: Refusals


@asynccontextmanager
async def live_service(
    journal: SqliteJournal,
    tree: OneTree,
    *,
    token: str,
    port: int = 0,
    settings: RunSettings | None = None,
    times: LinkTimes | None = None,
) -> AsyncIterator[LiveService]:
    refusals = Refusals()
    registry = RobotRegistry(journal, time.monotonic, times or LinkTimes())
    runtime = Runtime(
        journal=journal,
        robots=registry,
        worlds=PretendWorlds(),
        preparation=tree,
        scripts=load_scripts(),
        policy=EscalationPolicy(),
        send_mail=lambda *_: None,
        settings=settings or RunSettings(),
        monotonic=time.monotonic,
        utc_now=lambda: datetime.now(UTC),
        poses=PoseFeed(registry.show_poses, lambda _: None),
        refusals=refusals,
    )
    async with served(registry, token, port) as url:
        await runtime.recover()
        try:
            yield LiveService(runtime, registry, journal, url, refusals)
        finally:
            registry.close()
            await runtime.close()
