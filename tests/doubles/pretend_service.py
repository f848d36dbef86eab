"""A runtime over pretend robots and an in-memory journal, for tests of what runs do."""

import asyncio
import time
from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any
from uuid import UUID

from pretend_robots import PARTS, PretendRobot, PretendRobots

from mend.dialogue.registry import load_scripts
from mend.dialogue.script import Script
from mend.errors import NotFoundError
from mend.server.dialogues.attendance import Attendance
from mend.server.dialogues.escalation import EscalationPolicy
from mend.server.journal import events as ev
from mend.server.journal.sqlite import SqliteJournal
from mend.server.journal.trouble import Sleep
from mend.server.poses.feed import PoseFeed
from mend.server.runtime.clock import RunClock, SimulatedClock
from mend.server.runtime.context import RunSettings
from mend.server.runtime.dialogue_state import DialogueState
from mend.server.runtime.ports import PreparedRun, SiteOffer
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.robot_proxy import RobotProxy
from mend.server.runtime.run import Run
from mend.server.runtime.run_state import RunState
from mend.server.runtime.runtime import Runtime
from mend.server.runtime.team import Neighbour
from mend.server.runtime.views import DialogueView, RunView
from mend.tasks.definition import BehaviorNode, TaskTreeDefinition
from mend.tasks.scene import Scene

BARE = Scene(name="bare", objects={}, places={})


class NoHardware:
    simulated = True

    def __init__(self, restarted: list[str]) -> None:
        self._restarted = restarted

    def clock(self, start_s: float) -> RunClock:
        return SimulatedClock(start_s)

    def lend(self) -> None: ...

    async def begin(self, robot: str) -> None:
        await self.restart(robot)

    async def restart(self, robot: str) -> None:
        self._restarted.append(robot)

    def came(self, proxy: RobotProxy) -> None: ...

    def neighbours(self) -> Sequence[Neighbour]:
        return ()

    def tell_neighbours(self) -> None: ...

    async def release(self) -> None: ...


@dataclass
class PretendWorlds:
    restarted: list[str] = field(default_factory=list)

    def check(self, world: str, options: Mapping[str, Any]) -> None: ...

    def offer(self, site: UUID, robots: list[str]) -> SiteOffer:  # noqa: ARG002
        raise NotFoundError(f"there is no site {site}")

    def now_s(self, site: UUID) -> float | None:  # noqa: ARG002
        return None

    def open(self, state: RunState, run: Any) -> NoHardware:  # noqa: ARG002
        return NoHardware(self.restarted)


@dataclass
class OneTree:
    """Implements `mend.server.runtime.ports.Preparation`: all runs are of one tree in one scene."""

    definition: TaskTreeDefinition
    scene: Scene = BARE

    async def prepare(self, request: RunRequest, scene: Scene | None = None) -> PreparedRun:  # noqa: ARG002
        return PreparedRun(request.tree, self.definition.model_dump_json(), self.scene)


@dataclass
class PretendService:
    """Everything that a test of the runtime touches."""

    runtime: Runtime
    journal: SqliteJournal
    robots: PretendRobots
    worlds: PretendWorlds
    mails: list[ev.Escalated | ev.SuspectedFalseAlarm]

    async def run_to_end(self, **fields: Any) -> tuple[RunView, list[ev.Event]]:
        """Start a run with as-fast-as-possible defaults and wait for its end."""
        request = {"tree": "tree", "world": "tabletop", "speed": "max", **fields}
        started = await self.runtime.start_run(RunRequest.model_validate(request))
        ended = await self.runtime.wait_for_end(started.id)
        return ended, await self.journal.read(0, 1_000_000, started.id)

    async def first_question(self) -> DialogueView:
        """The first question that is put, once it is."""
        async with asyncio.timeout(60):
            while not (waiting := await self.runtime.dialogues.page("open", 100, 0)):  # noqa: ASYNC110
                await asyncio.sleep(0)
        return waiting[0]

    def run_of(self, view: RunView) -> Run:
        return self.runtime._runs[view.id]


def utc_now() -> datetime:
    return datetime.now(UTC)


@asynccontextmanager
async def pretend_service(
    definition: TaskTreeDefinition,
    faults: Mapping[str, list[tuple[str, int]]] | None = None,
    *,
    journal: Path | None = None,
    policy: EscalationPolicy | None = None,
    scripts: Mapping[str, Script] | None = None,
    scene: Scene = BARE,
    settings: RunSettings | None = None,
    sleep: Sleep = asyncio.sleep,
    attendance: Attendance | None = None,
    utc_now: Callable[[], datetime] = utc_now,
    **robot: Any,
) -> AsyncIterator[PretendService]:
    """A runtime whose robots run into `faults` (object -> issue and step, in turn)."""
    kept = SqliteJournal(journal or ":memory:", sleep=sleep)
    robots = PretendRobots()
    # What no run is about would only be seen, told and read again with each look.
    handled = {node.object for node in definition.nodes if isinstance(node, BehaviorNode)}
    table = {part: y for part, y in PARTS.items() if part in handled}
    robots.make = lambda name: PretendRobot(
        name,
        faults={part: list(each) for part, each in (faults or {}).items()},
        table=table,
        **robot,
    )
    mails: list[ev.Escalated | ev.SuspectedFalseAlarm] = []

    def send_mail(
        _: RunState, event: ev.Escalated | ev.SuspectedFalseAlarm, __: DialogueState
    ) -> None:
        mails.append(event)

    worlds = PretendWorlds()
    runtime = Runtime(
        journal=kept,
        robots=robots,
        worlds=worlds,
        preparation=OneTree(definition, scene),
        scripts=scripts if scripts is not None else load_scripts(),
        policy=policy or EscalationPolicy(),
        send_mail=send_mail,
        settings=settings or RunSettings(),
        monotonic=time.monotonic,
        utc_now=utc_now,
        poses=PoseFeed(lambda *_: None, lambda _: None),
        attendance=attendance,
    )
    try:
        await runtime.recover()
        yield PretendService(runtime, kept, robots, worlds, mails)
    finally:
        await runtime.close()
        kept.close()
