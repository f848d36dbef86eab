"""What needs a file descriptor is made once there are some again."""

import asyncio
import errno
import os
import sys
import time
from collections.abc import AsyncIterator
from typing import Any

import pytest
from full_disk import Passing
from recording_sink import RecordingSink

from mend.robots.link.messages import Look
from mend.server.descriptors import (
    TRY_AGAIN_S,
    once_there_are_descriptors,
    until_there_are_descriptors,
)
from mend.server.journal.sqlite import SqliteJournal
from mend.server.robots.passes import OwnRobots
from mend.server.robots.process import InProcessWorld, WorldProcess
from mend.server.robots.registry import RobotRegistry
from mend.server.robots.simulation_thread import SimulationThread
from mend.sim.tabletop.adapter import adapter
from mend.sim.tabletop.layout import lay_out
from mend.sim.world import WorldSetup


@pytest.fixture
async def journal() -> AsyncIterator[SqliteJournal]:
    journal = SqliteJournal(":memory:")
    yield journal
    journal.close()


@pytest.mark.parametrize("number", [errno.EMFILE, errno.ENFILE])
async def test_it_is_tried_again_while_there_are_none(number: int) -> None:
    passing, failures = Passing(), [number] * 3

    async def make() -> str:
        if failures:
            raise OSError(failures.pop(), "too many open files")
        return "made"

    assert await once_there_are_descriptors(make, passing) == "made"
    assert passing.pauses == [TRY_AGAIN_S] * 3


async def test_what_else_is_wrong_is_raised_at_once() -> None:
    passing = Passing()

    async def make() -> str:
        raise OSError(errno.ENOENT, "no such file")

    with pytest.raises(OSError, match="no such file"):
        await once_there_are_descriptors(make, passing)
    assert passing.pauses == []


class ShortOfDescriptors:
    """A world that can be built only once this process has descriptors again."""

    own_process = False

    def __init__(self) -> None:
        self.failures = 2

    def create_agents(self, setup: WorldSetup) -> Any:
        if self.failures:
            self.failures -= 1
            raise OSError(errno.EMFILE, "Too many open files")
        return adapter.create_agents(setup)


async def test_a_robot_within_the_service_starts_once_there_are_descriptors(
    journal: SqliteJournal, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mend.server.descriptors.TRY_AGAIN_S", 0.0)
    registry = RobotRegistry(journal, time.monotonic)
    sink = RecordingSink(journal)
    registry.assign("arm", sink)
    world = ShortOfDescriptors()
    ended: list[str] = []
    robot = InProcessWorld(world, ended.append, registry, OwnRobots(), SimulationThread())  # type: ignore[arg-type]
    scene = lay_out([("part", "spot")], 1)
    await robot.start(WorldSetup(robots=["arm"], scene=scene, seed=1, speed=None))
    async with asyncio.timeout(60):
        await sink.wait_until(lambda: len(sink.hellos) == 1)
    assert (world.failures, ended) == (0, [])
    await robot.stop()
    registry.close()


async def test_a_process_of_a_robot_starts_once_there_are_descriptors(
    journal: SqliteJournal, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mend.server.descriptors.TRY_AGAIN_S", 0.0)
    really_start = asyncio.create_subprocess_exec
    failures = [errno.EMFILE, errno.ENFILE]

    async def start(*_: Any, **how: Any) -> asyncio.subprocess.Process:
        if failures:
            raise OSError(failures.pop(), "Too many open files")
        return await really_start(sys.executable, "-c", "input()", **how)

    monkeypatch.setattr(asyncio, "create_subprocess_exec", start)
    registry = RobotRegistry(journal, time.monotonic)
    ended: asyncio.Queue[str] = asyncio.Queue()
    robot = WorldProcess("tabletop", ended.put_nowait, registry, OwnRobots(), "ws://localhost")
    scene = lay_out([("part", "spot")], 1)
    await robot.start(WorldSetup(robots=["arm"], scene=scene, seed=1, speed=None))
    async with asyncio.timeout(60):
        assert await ended.get() == "its process ended with code 0"
    await robot.stop()
    registry.close()


class FailsOnTheWay:
    """A world whose robot finds no descriptor once it is at work."""

    own_process = False

    def create_agents(self, setup: WorldSetup) -> Any:
        agent = adapter.create_agents(setup)

        def advance(*_: Any) -> Any:
            raise OSError(errno.EMFILE, "Too many open files")

        agent.advance = advance
        return agent


async def test_a_robot_that_fails_for_that_says_so_without_a_traceback(
    journal: SqliteJournal, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    waited: list[bool] = []

    async def until_there_are() -> None:
        waited.append(not ended)

    monkeypatch.setattr("mend.server.robots.process.until_there_are_descriptors", until_there_are)
    registry = RobotRegistry(journal, time.monotonic)
    registry.assign("arm", RecordingSink(journal))
    ended: list[str] = []
    news = asyncio.Event()

    def end(reason: str) -> None:
        ended.append(reason)
        news.set()

    robot = InProcessWorld(FailsOnTheWay(), end, registry, OwnRobots(), SimulationThread())  # type: ignore[arg-type]
    scene = lay_out([("part", "spot")], 1)
    await robot.start(WorldSetup(robots=["arm"], scene=scene, seed=1, speed=None))
    registry.send("arm", "c1", Look())
    async with asyncio.timeout(60):
        await news.wait()
    assert waited == [True]
    assert "Too many open files" in ended[0]
    assert [each.exc_info for each in caplog.records if each.exc_info] == []
    assert any("begins anew" in each.message for each in caplog.records)
    registry.close()


async def test_it_is_waited_for_until_something_can_be_opened(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    passing, left = Passing(), [3]
    really_open = os.open

    def open_late(*arguments: Any) -> int:
        if left[0]:
            left[0] -= 1
            raise OSError(errno.ENFILE, "too many open files in the system")
        return really_open(*arguments)

    with monkeypatch.context() as patched:
        patched.setattr("mend.server.descriptors.os.open", open_late)
        await until_there_are_descriptors(passing)
    assert passing.pauses == [TRY_AGAIN_S] * 3
