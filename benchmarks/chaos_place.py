"""Where the chaos happens: a service on a small disk, its robots, and all who talk to it."""

import asyncio
import sys
import time
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from chaos_lives import Lives, footprint_of
from chaos_people import Clients, Follower
from chaos_probe import Probe
from chaos_robots import RobotKeeper
from chaos_strangers import Strangers
from chaos_witness import Witness
from full_disk import SmallDisk
from service_process import ServiceProcess

from mend.server.access.changes import PrincipalsEditor

TOKEN = "only-for-this-benchmark-and-thrown-away"
DISK_MB = 512
DESCRIPTORS = 220
START_S = 120.0
ROBOTS = ("arm-1", "arm-2", "arm-3")
HOSTILE = ("mallory-1", "mallory-2")

SETTINGS = {
    "MEND_SPEECH_VOICE": "none",
    "MEND_SPEECH_RECOGNITION": "false",
    "MEND_ROBOT_LOST_TIMEOUT_S": "5",
    # People who promise help and do not give it are not what is looked at here.
    "MEND_HELP_WINDOW_S": "3",
    "MEND_ASK_DEADLINE_S": "5",
    "MEND_LIMITS__RUNNING_RUNS": "100",
    # More than there are descriptors, so that these run out.
    "MEND_LIMITS__STRANGERS": "1000",
    "MEND_LIMITS__STRANGERS_PER_ADDRESS": "1000",
    "MEND_LIMITS__HEAD_S": "2",
    "MEND_LIMITS__BODY_S": "2",
    "MEND_LIMITS__STUCK_CLIENT_S": "3",
}


class HangsError(Exception):
    """Something that must happen does not; says what."""


@dataclass(slots=True)
class Place:
    """Everything that takes part. `most_stop_s`: so long may a process be stopped at most."""

    service: ServiceProcess
    disk: SmallDisk
    clock: Path
    probe: Probe
    witness: Witness
    clients: Clients
    followers: list[Follower]
    robots: list[RobotKeeper]
    strangers: Strangers
    rng: np.random.Generator
    most_stop_s: float
    lives: Lives = field(default_factory=Lives)

    def a_while_s(self, most_s: float) -> float:
        """A time that is drawn, mostly short."""
        return float(min(most_s, self.most_stop_s, 0.2 + self.rng.exponential(most_s / 4)))

    async def start_service(self) -> None:
        """Start the service until it stays. Raises `HangsError` if it never does."""
        async with _within(START_S, "the service does not start"):
            while True:
                await self.service.spawn()
                if await self._ready():
                    self.look()
                    return
                await asyncio.sleep(0.2)

    async def wait_until_ready(self) -> None:
        """It was started. Raises `HangsError` if it has ended, or never gets ready."""
        async with _within(START_S, "the service does not get ready"):
            if not await self._ready():
                raise HangsError("the service has ended by itself")
        self.look()

    async def _ready(self) -> bool:
        """Wait until it can be used, or has ended."""
        ended = asyncio.create_task(self.service.process.wait())
        try:
            while not ended.done():
                if await self.clients.running() is not None:
                    return True
                await asyncio.sleep(0.05)
        finally:
            ended.cancel()
        return False

    async def kill_service(self) -> None:
        """`kill -9`, after a last look at what this life of it takes."""
        self.look()
        await self.service.kill()

    def look(self) -> None:
        """Note what the service takes now, if it is there."""
        pid = self.service.process.pid
        footprint = footprint_of(pid)
        if footprint is not None:
            ended = self.followers[0].ends
            self.lives.note(pid, footprint, ended, time.monotonic())

    def request(self, seed: int) -> dict[str, Any]:
        """A run: most in an instant world, some on robots, a few on hostile ones."""
        rng = np.random.default_rng([int(self.rng.integers(2**31)), seed])
        asked: dict[str, Any] = {"tree": "eket", "answers": "live", "max_attempts": 20}
        kind = rng.random()
        if kind < 0.8:
            scenarios = (None, "eket_paper", "eket_clean", "eket_clumsy_helper")
            asked |= {"world": "tabletop", "speed": (2.0, 10.0, "max")[rng.integers(3)]}
            asked |= {"scenario": scenarios[rng.integers(len(scenarios))]}
            if rng.random() < 0.3:
                asked |= {"interventions": "random", "scenario": None}
            return asked
        robots = ROBOTS if kind < 0.95 else HOSTILE
        return asked | {"world": "live", "robots": [robots[rng.integers(len(robots))]]}


@asynccontextmanager
async def chaos_place(
    folder: Path, disk: SmallDisk, seed: int, most_stop_s: float
) -> AsyncIterator[Place]:
    """A service that runs, with people and robots who are there all the time."""
    clock = folder / "clock"
    clock.write_text("0")
    program = (sys.executable, str(Path(__file__).with_name("chaos_clock.py")), str(clock))
    editor = PrincipalsEditor(folder / "principals.yaml", by="chaos")
    credentials = {name: _enrolled(editor, name) for name in (*ROBOTS, *HOSTILE)}
    service = ServiceProcess(
        disk.folder, descriptors=DESCRIPTORS, program=program, token=TOKEN,
        MEND_PRINCIPALS=str(editor.path), **SETTINGS,
    )  # fmt: skip
    witness = Witness()
    hostile = {name: credentials[name] for name in HOSTILE}
    place = Place(
        service=service,
        disk=disk,
        clock=clock,
        probe=Probe(service.port, TOKEN),
        witness=witness,
        clients=Clients(service.url, TOKEN, witness),
        followers=[
            Follower(f"follower-{number}", service.url, TOKEN, witness, seed + number, eager)
            for number, eager in enumerate((0.0, 0.5, 0.3))
        ],
        robots=[RobotKeeper(each, service.url, folder, credentials[each]) for each in ROBOTS],
        strangers=Strangers(service.port, TOKEN, hostile),
        rng=np.random.default_rng(seed),
        most_stop_s=most_stop_s,
    )
    try:
        await place.start_service()
        async with AsyncExitStack() as stack:
            for work in (
                *(each.follow() for each in place.followers),
                *(each.keep() for each in place.robots),
                place.clients.answer_what_is_open(),
            ):
                await stack.enter_async_context(_going_on(work))
            yield place
    finally:
        await place.clients.close()
        await _ended(service)


async def _ended(service: ServiceProcess) -> None:
    """Whatever happened: nothing of it is left."""
    if service.process.returncode is None:
        service.process.kill()
        await service.process.wait()


def _enrolled(editor: PrincipalsEditor, robot: str) -> str:
    now = datetime.now(UTC)
    return editor.enrol(robot, editor.open_enrolment(robot, now, minutes=15), now)


@asynccontextmanager
async def _going_on(work: Any) -> AsyncIterator[None]:
    """Do something beside the block; a fault of its own is raised at the end."""
    task = asyncio.create_task(work)
    try:
        yield
    finally:
        task.cancel()
        (result,) = await asyncio.gather(task, return_exceptions=True)
    if isinstance(result, Exception):
        raise result


@asynccontextmanager
async def _within(seconds: float, otherwise: str) -> AsyncIterator[None]:
    try:
        async with asyncio.timeout(seconds):
            yield
    except TimeoutError:
        raise HangsError(f"{otherwise} within {seconds:g} s") from None
