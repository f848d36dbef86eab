"""What needs a file descriptor is made once there are some again."""

import asyncio
import errno
import time
from collections.abc import AsyncIterator
from typing import Any

import pytest
from full_disk import Passing
from recording_sink import RecordingSink

from server.descriptors import TRY_AGAIN_S, once_there_are_descriptors
from server.journal.sqlite import SqliteJournal
from server.robots.passes import OwnRobots
from server.robots.process import InProcessRobot
from server.robots.registry import RobotRegistry
from sim.tabletop.adapter import adapter
from sim.tabletop.layout import lay_out
from sim.world import WorldSetup


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

    def create_agent(self, setup: WorldSetup) -> Any:
        if self.failures:
            self.failures -= 1
            raise OSError(errno.EMFILE, "Too many open files")
        return adapter.create_agent(setup)


async def test_a_robot_within_the_service_starts_once_there_are_descriptors(
    journal: SqliteJournal, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("server.descriptors.TRY_AGAIN_S", 0.0)
    registry = RobotRegistry(journal, time.monotonic)
    sink = RecordingSink(journal)
    registry.assign("arm", sink)
    world = ShortOfDescriptors()
    ended: list[str] = []
    robot = InProcessRobot(world, ended.append, registry, OwnRobots())  # type: ignore[arg-type]
    scene = lay_out([("part", "spot")], 1)
    await robot.start(WorldSetup(robot="arm", scene=scene, seed=1, speed=None))
    async with asyncio.timeout(60):
        await sink.wait_until(lambda: len(sink.hellos) == 1)
    assert (world.failures, ended) == (0, [])
    await robot.stop()
    registry.close()
