"""A robot that is there and says nothing of what it was told keeps a run going for only so long."""

import asyncio

import pytest
from told_robot import Body, Obey, ToldRobot, at_work, end_of, works

from mend.server.journal.sqlite import SqliteJournal
from mend.server.runtime.context import RunSettings
from mend.server.runtime.views import RunStatus

SOON = RunSettings(robot_silent_timeout_s=0.2)


async def does_nothing(robot: ToldRobot, command: str, body: Body) -> None:
    """It takes what it is told, and that is all."""


async def takes_a_leaf_and_stops(robot: ToldRobot, command: str, body: Body) -> None:
    if body["type"] == "look":
        await robot.look(command, there=body["finished"])


@pytest.mark.parametrize("obey", [does_nothing, takes_a_leaf_and_stops])
async def test_a_robot_that_says_nothing_of_what_it_was_told_is_given_up(obey: Obey) -> None:
    journal = SqliteJournal(":memory:")
    ended, robot, _ = await end_of(obey, journal, settings=SOON)
    journal.close()
    assert ended.status is RunStatus.FAILED
    assert ended.result is not None
    assert ended.result.reason == (
        "the robot 'arm' is given up: for 0.2 s it has said nothing of what it was told"
    )
    assert robot.told < 5


async def takes_a_leaf_and_only_retreats(robot: ToldRobot, command: str, body: Body) -> None:
    await takes_a_leaf_and_stops(robot, command, body)
    if body["type"] == "interrupt":
        await robot.report(type="holding", execution=None, at="neutral")


@pytest.mark.parametrize("obey", [does_nothing, takes_a_leaf_and_only_retreats])
async def test_its_leaf_goes_to_another_once_its_arm_rests(obey: Obey) -> None:
    journal = SqliteJournal(":memory:")
    ended, _, _ = await end_of(obey, journal, another_obeys=works, settings=SOON)
    journal.close()
    assert ended.status is RunStatus.FINISHED


async def test_its_leaf_goes_to_nobody_while_its_arm_may_be_there() -> None:
    journal = SqliteJournal(":memory:")
    ended, _, _ = await end_of(takes_a_leaf_and_stops, journal, another_obeys=works, settings=SOON)
    journal.close()
    assert ended.status is RunStatus.FAILED
    assert ended.result is not None
    assert ended.result.reason.endswith(
        "no robot can do it: the arm of 'arm' may be in the way, which was given up there"
    )


async def test_no_time_passes_while_the_run_is_paused() -> None:
    started = asyncio.Event()

    async def starts(robot: ToldRobot, command: str, body: Body) -> None:
        await takes_a_leaf_and_stops(robot, command, body)
        if body["type"] == "start":
            started.set()

    journal = SqliteJournal(":memory:")
    settings = RunSettings(robot_silent_timeout_s=3600.0)
    async with at_work(starts, journal, settings=settings) as (service, _, run):
        await started.wait()
        await service.runtime.pause(run)
        actor = service.runtime._runs[run]
        proxy = actor.proxies["arm"]
        at = actor._patience.silent_too_long_at(proxy)
        before = actor.context.clock.now()
        await asyncio.sleep(0)
        assert actor.context.clock.now() == before
        assert at is not None
        assert at == actor._patience.silent_too_long_at(proxy)
    journal.close()


async def test_while_the_journal_could_not_be_written_nobody_counts_as_silent() -> None:
    """What a robot said meanwhile still waits behind what another one said."""
    started = asyncio.Event()

    async def starts(robot: ToldRobot, command: str, body: Body) -> None:
        await takes_a_leaf_and_stops(robot, command, body)
        if body["type"] == "start":
            started.set()

    journal = SqliteJournal(":memory:")
    settings = RunSettings(robot_silent_timeout_s=3600.0)
    async with at_work(starts, journal, settings=settings) as (service, _, run):
        await started.wait()
        actor = service.runtime._runs[run]
        proxy = actor.proxies["arm"]
        proxy.silent_since = actor.context.clock.now() - 7200.0
        actor.journal_troubled(None)
        await actor.request(actor._go_on)
        assert not proxy.gone_for_good
    journal.close()
