"""A robot that floods is read at its pace, and ended when it reports without end."""

import asyncio
import time
from collections.abc import AsyncIterator
from contextlib import suppress

import pytest
from loopback import served
from recording_sink import RecordingSink
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

from mend.robots.link.channel import Channel, ChannelClosedError, memory_channel
from mend.robots.link.messages import (
    Ack,
    Detection,
    Held,
    Hello,
    IssueDetected,
    LinkError,
    Look,
    ReachLimits,
    Report,
    Welcome,
    service_message,
)
from mend.server.journal.sqlite import SqliteJournal
from mend.server.limits import Limits
from mend.server.pace import CHARS_OF_ONE, Pace
from mend.server.refusals import Refusals
from mend.server.robots.known_robot import MOST_UNASKED_REPORTS
from mend.server.robots.paced_channel import PacedChannel
from mend.server.robots.passes import Anyone
from mend.server.robots.registry import RobotRegistry
from mend.server.robots.times import LinkTimes

TIMES = LinkTimes(heartbeat_s=1.0, silence_s=60.0, absence_s=0.001)
HEADERS = {"Authorization": "Bearer secret"}


class Clock:
    """Time that passes only while somebody sleeps; `pauses` are those that were asked for."""

    def __init__(self) -> None:
        self.now = 0.0
        self.pauses: list[float] = []

    def __call__(self) -> float:
        return self.now

    async def sleep(self, seconds: float) -> None:
        self.pauses.append(seconds)
        self.now += seconds


def hello(boot: str = "b1", *, simulated: bool = False) -> str:
    return Hello(
        protocol=1, robot="arm", boot=boot, behaviors=[], cameras=[], simulated=simulated,
        reach=ReachLimits(x=0.0, y=0.0, min_m=0.2, max_m=0.8), time=0.0,
    ).model_dump_json()  # fmt: skip


def report(seq: int) -> str:
    return Report(seq=seq, time=float(seq), body=Held(command="c")).model_dump_json()


@pytest.fixture
async def journal() -> AsyncIterator[SqliteJournal]:
    journal = SqliteJournal(":memory:")
    yield journal
    journal.close()


async def all_of(channel: Channel) -> AsyncIterator[str]:
    """What comes until the other side closes it."""
    with suppress(ChannelClosedError):
        async with asyncio.timeout(60):
            while True:
                yield await channel.receive()


async def read_all(messages: list[str], clock: Clock, held_back: list[int]) -> None:
    ours, theirs = memory_channel()
    paced = PacedChannel(theirs, Pace(10, clock, lambda: held_back.append(1), clock.sleep))
    for text in messages:
        await ours.send(text)
    assert [await paced.receive() for _ in messages] == messages


async def test_what_comes_faster_than_allowed_is_read_later_and_all_of_it() -> None:
    clock, held_back = Clock(), list[int]()
    await read_all(["x"] * 140, clock, held_back)
    assert clock.now == pytest.approx(10.0)
    assert len(held_back) == len(clock.pauses) == 100


async def test_a_robot_that_keeps_to_its_pace_never_waits() -> None:
    clock = Clock()
    pace = Pace(10, clock)
    for _ in range(1000):
        clock.now += 0.1
        assert pace.take() == 0.0


async def test_a_long_message_counts_as_many() -> None:
    clock, held_back = Clock(), list[int]()
    await read_all(["x" * 40 * CHARS_OF_ONE, "x"], clock, held_back)
    assert clock.pauses == pytest.approx([0.1, 0.1])


async def test_a_flood_over_the_wire_is_held_back_and_others_are_served(
    journal: SqliteJournal,
) -> None:
    refusals = Refusals()
    limits = Limits(robot_messages_per_s=1)
    registry = RobotRegistry(journal, time.monotonic, TIMES, limits, refusals)
    async with (
        asyncio.timeout(60),
        served(registry, "secret") as url,
        connect(url, additional_headers=HEADERS) as flooding,
    ):
        await flooding.send(hello())
        assert isinstance(service_message.validate_json(await flooding.recv()), Welcome)
        for seq in range(1, 100):
            await flooding.send(report(seq))
        while refusals.counts["robot_messages_per_s"] == 0:  # noqa: ASYNC110
            await asyncio.sleep(0)
        assert await journal.received("arm", "b1") < 10
    registry.close()


async def test_who_reports_without_end_is_ended_and_let_in_no_more_until_started_again(
    journal: SqliteJournal, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mend.server.robots.known_robot.MOST_UNASKED_REPORTS", 5)
    refusals = Refusals()
    registry = RobotRegistry(journal, lambda: 0.0, TIMES, refusals=refusals)
    sink = RecordingSink(journal)
    registry.assign("arm", sink)
    ours, theirs = memory_channel()
    serving = asyncio.create_task(registry.serve(theirs))
    await ours.send(hello())
    for seq in range(1, 6):
        await ours.send(report(seq))
    await sink.wait_until(lambda: len(sink.reports) == 5)
    # What it was told is a reason to report.
    registry.send("arm", "c1", Look())
    for seq in range(6, 12):
        await ours.send(report(seq))
    *_, last = [service_message.validate_json(each) async for each in all_of(ours)]
    assert isinstance(last, LinkError)
    assert last.detail == "the robot 'arm' has sent 5 reports since it was last told something new"
    assert len(sink.reports) == 10
    assert refusals.counts["unasked_reports"] == 1
    await serving
    assert await journal.received("arm", "b1") == 10
    ours, theirs = memory_channel()
    serving = asyncio.create_task(registry.serve(theirs))
    await ours.send(hello())
    refused = service_message.validate_json(await ours.receive())
    assert isinstance(refused, LinkError)
    assert "start the robot's program again" in refused.detail
    await serving
    registry.close()


async def test_a_robot_that_says_it_is_simulated_is_let_in_no_more_either(
    journal: SqliteJournal, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mend.server.robots.known_robot.MOST_UNASKED_REPORTS", 5)
    registry = RobotRegistry(journal, lambda: 0.0, TIMES)
    for said in ("has sent 5 reports since", "start the robot's program again"):
        ours, theirs = memory_channel()
        serving = asyncio.create_task(registry.serve_stranger(theirs, Anyone()))
        await ours.send(hello(simulated=True))
        for seq in range(1, 12):
            with suppress(ChannelClosedError):
                await ours.send(report(seq))
        *_, last = [service_message.validate_json(each) async for each in all_of(ours)]
        assert isinstance(last, LinkError)
        assert said in last.detail
        await serving
    registry.close()


async def test_pictures_count_by_their_size(
    journal: SqliteJournal, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mend.server.robots.known_robot.MOST_UNASKED_REPORTS", 10)
    registry = RobotRegistry(journal, lambda: 0.0, TIMES)
    ours, theirs = memory_channel()
    serving = asyncio.create_task(registry.serve(theirs))
    await ours.send(hello())
    for seq in (1, 2, 3):
        issue = IssueDetected(
            execution="e", issue="missed", step=1, interrupts=True,
            detection=Detection(camera="head"), jpeg="x" * 4 * CHARS_OF_ONE,
        )  # fmt: skip
        await ours.send(Report(seq=seq, time=0.0, body=issue).model_dump_json())
    *_, last = [service_message.validate_json(each) async for each in all_of(ours)]
    assert isinstance(last, LinkError)
    assert await journal.received("arm", "b1") == 2
    await serving
    registry.close()


def test_a_command_may_have_many_reports() -> None:
    assert MOST_UNASKED_REPORTS >= 10_000


@pytest.mark.parametrize("simulated", [False, True])
async def test_a_second_program_with_the_same_credential_does_not_push_the_first_out(
    journal: SqliteJournal, simulated: bool
) -> None:
    registry = RobotRegistry(journal, time.monotonic, TIMES)
    async with (
        asyncio.timeout(60),
        served(registry, "secret") as url,
        connect(url, additional_headers=HEADERS) as first,
        connect(url, additional_headers=HEADERS) as second,
    ):
        await first.send(hello("b1"))
        assert isinstance(service_message.validate_json(await first.recv()), Welcome)
        await second.send(hello("b2", simulated=simulated))
        refused = service_message.validate_json(await second.recv())
        assert isinstance(refused, LinkError)
        assert "another program is connected" in refused.detail
        with pytest.raises(ConnectionClosed):
            await second.recv()
        await first.send(report(1))
        assert isinstance(service_message.validate_json(await first.recv()), Ack)
    registry.close()
