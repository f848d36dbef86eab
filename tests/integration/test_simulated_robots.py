"""Simulated robots in processes of their own, killed and hung, and within this one."""

import asyncio
import json
import os
import signal
import sys
import time
from collections.abc import AsyncIterator
from functools import partial
from pathlib import Path

import counting_world
import pytest
from loopback import served
from recording_sink import RecordingSink
from ticking_clock import TickingClock

from mend.errors import WrongInputError
from mend.robots.link.messages import Interrupt, Shutdown, Start
from mend.server.access.access import Access
from mend.server.journal.sqlite import SqliteJournal
from mend.server.robots.passes import OwnRobots
from mend.server.robots.process import WorldProcess, launch
from mend.server.robots.registry import RobotRegistry
from mend.server.robots.simulation_thread import SimulationThread
from mend.sim.world import WorldSetup
from mend.tasks.plugins import load_plugins
from mend.tasks.scene import Scene

DOUBLES = Path(counting_world.__file__).parent
SETUP = WorldSetup(
    robots=["counter"], scene=Scene(name="empty", objects={}, places={}), seed=1, speed=None
)
launched = partial(launch, aside=SimulationThread())
START = Start(execution="e1", node="/0", behavior="count", parameters={})


@pytest.fixture
async def journal() -> AsyncIterator[SqliteJournal]:
    journal = SqliteJournal(":memory:")
    yield journal
    journal.close()


@pytest.fixture
def _worlds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[None]:
    counting_world.install(tmp_path)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path), str(DOUBLES)]))
    monkeypatch.syspath_prepend(str(tmp_path))
    load_plugins.cache_clear()
    yield
    load_plugins.cache_clear()


@pytest.mark.slow
@pytest.mark.usefixtures("_worlds")
async def test_a_killed_process_is_reported_once_and_can_be_started_again(
    journal: SqliteJournal,
) -> None:
    registry = RobotRegistry(journal, time.monotonic)
    ended: asyncio.Queue[str] = asyncio.Queue()
    sink = RecordingSink(journal)
    registry.assign("counter", sink)
    own = OwnRobots()
    access = Access("secret", own_robots=own, wall_time_s=time.time)
    async with served(registry, access=access) as url:
        robot = await launched(
            "counting", SETUP, ended.put_nowait, registry=registry, own_robots=own, url=url
        )
        await sink.wait_until(lambda: len(sink.hellos) == 1)
        registry.send("counter", "c1", START)
        await sink.wait_until(lambda: len(sink.reports) >= 5)
        assert robot.pid is not None
        os.kill(robot.pid, signal.SIGKILL)
        assert await ended.get() == "its process was ended by SIGKILL"
        assert robot.pid is None
        before = len(sink.reports)
        await robot.start(SETUP)
        await sink.wait_until(lambda: len(sink.hellos) == 2)
        assert sink.hellos[1].boot != sink.hellos[0].boot
        registry.send("counter", "c2", START)
        await sink.wait_until(lambda: "finished" in sink.types()[before:])
        await robot.stop()
        assert robot.pid is None
    seqs = [receipt.seq for receipt in sink.receipts]
    assert seqs == [*range(1, before + 1), *range(1, len(seqs) - before + 1)]
    assert ended.empty()
    assert sink.lost == []


@pytest.mark.slow
@pytest.mark.usefixtures("_worlds")
async def test_a_process_that_hangs_is_killed(journal: SqliteJournal) -> None:
    registry = RobotRegistry(journal, time.monotonic)
    ended: asyncio.Queue[str] = asyncio.Queue()
    sink = RecordingSink(journal)
    registry.assign("counter", sink)
    async with served(registry) as url:
        robot = WorldProcess("counting", ended.put_nowait, registry, OwnRobots(), url, hang_s=1.5)
        await robot.start(SETUP)
        await sink.wait_until(lambda: len(sink.hellos) == 1)
        registry.send("counter", "c1", Interrupt(retreat=False))
        assert "hung" in await ended.get()
        assert robot.pid is None
        await robot.stop()


@pytest.mark.slow
@pytest.mark.usefixtures("_worlds")
async def test_only_a_process_that_stands_still_itself_is_killed(journal: SqliteJournal) -> None:
    clock = TickingClock()
    registry = RobotRegistry(journal, clock)
    ended: asyncio.Queue[str] = asyncio.Queue()
    sink = RecordingSink(journal)
    registry.assign("counter", sink)
    async with served(registry) as url:
        robot = WorldProcess(
            "counting", ended.put_nowait, registry, OwnRobots(), url, check_s=0.01, clock=clock
        )
        await robot.start(SETUP)
        await sink.wait_until(lambda: len(sink.hellos) == 1)
        assert robot.pid is not None
        # The service itself stood still for a minute.
        clock.now_s += 60.0
        await clock.looked_at(5)
        assert robot.pid is not None
        assert ended.empty()
        os.kill(robot.pid, signal.SIGSTOP)
        clock.step_s = 0.015
        assert "hung: nothing was heard of it for 6" in await ended.get()
        assert robot.pid is None
        await robot.stop()


@pytest.mark.slow
@pytest.mark.usefixtures("_worlds")
async def test_a_shut_down_process_says_that_it_ended(journal: SqliteJournal) -> None:
    registry = RobotRegistry(journal, time.monotonic)
    ended: asyncio.Queue[str] = asyncio.Queue()
    sink = RecordingSink(journal)
    registry.assign("counter", sink)
    async with served(registry) as url:
        await launched(
            "counting", SETUP, ended.put_nowait, registry=registry, own_robots=OwnRobots(), url=url
        )
        await sink.wait_until(lambda: len(sink.hellos) == 1)
        registry.send("counter", "c1", Shutdown())
        assert await ended.get() == "its process ended with code 0"


@pytest.mark.usefixtures("_worlds")
async def test_a_robot_within_the_service_runs_without_a_socket(journal: SqliteJournal) -> None:
    registry = RobotRegistry(journal, time.monotonic)
    ended: asyncio.Queue[str] = asyncio.Queue()
    sink = RecordingSink(journal)
    registry.assign("counter", sink)
    robot = await launched(
        "embedded",
        SETUP,
        ended.put_nowait,
        registry=registry,
        own_robots=OwnRobots(),
        url="ws://unused",
    )
    await sink.wait_until(lambda: len(sink.hellos) == 1)
    registry.send("counter", "c1", START)
    await sink.wait_until(lambda: "finished" in sink.types())
    await robot.stop()
    registry.close()
    assert ended.empty()


@pytest.mark.usefixtures("_worlds")
async def test_a_world_that_cannot_run_here_is_refused_with_its_reason(
    journal: SqliteJournal,
) -> None:
    registry = RobotRegistry(journal, time.monotonic)
    ended: asyncio.Queue[str] = asyncio.Queue()
    with pytest.raises(WrongInputError, match="needs a package that is not installed"):
        await launched(
            "absent",
            SETUP,
            ended.put_nowait,
            registry=registry,
            own_robots=OwnRobots(),
            url="ws://unused",
        )
    with pytest.raises(WrongInputError, match="there is no world 'nowhere'"):
        await launched(
            "nowhere",
            SETUP,
            ended.put_nowait,
            registry=registry,
            own_robots=OwnRobots(),
            url="ws://unused",
        )


@pytest.mark.slow
@pytest.mark.usefixtures("_worlds")
async def test_a_process_whose_parent_died_ends_while_it_builds_its_world() -> None:
    told = {
        "world": "endless",
        "url": "ws://unused",
        "setup": SETUP.model_dump(mode="json"),
        "tokens": ["t"],
    }
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-P", "-m", "mend.sim.robot_process",
        stdin=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE,
    )  # fmt: skip
    assert process.stdin is not None
    assert process.stderr is not None
    process.stdin.write(json.dumps(told).encode() + b"\n")
    assert await process.stderr.readline() == b"building for ever\n"
    process.stdin.close()
    async with asyncio.timeout(60):
        assert await process.wait() == 0


async def run_process(told: bytes) -> tuple[int | None, str]:
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-P", "-m", "mend.sim.robot_process",
        stdin=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE,
    )  # fmt: skip
    assert process.stdin is not None
    assert process.stderr is not None
    # Not `communicate`: a closed stdin means that the parent has died.
    process.stdin.write(told)
    complaint = await process.stderr.read()
    return await process.wait(), complaint.decode()


@pytest.mark.slow
@pytest.mark.usefixtures("_worlds")
async def test_a_process_that_cannot_run_says_so_in_one_sentence() -> None:
    told = {
        "world": "absent",
        "url": "ws://unused",
        "setup": SETUP.model_dump(mode="json"),
        "tokens": ["t"],
    }
    code, complaint = await run_process(json.dumps(told).encode() + b"\n")
    assert code == 2
    assert complaint == "the world 'absent' needs a package that is not installed\n"
    code, complaint = await run_process(b'{"world": 1}\n')
    assert code == 2
    assert complaint.startswith("the setup of the robot is wrong at 'world'")
    assert complaint.count("\n") == 1
