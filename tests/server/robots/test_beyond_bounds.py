"""Robots whose numbers are beyond all bounds: refused, and nobody else is harmed."""

import asyncio
import json
import math
from collections.abc import AsyncIterator
from contextlib import suppress
from typing import Any

import pytest
from recording_sink import RecordingSink

from mend.robots.link.channel import ChannelClosedError, memory_channel
from mend.server.journal.sqlite import SqliteJournal
from mend.server.limits import Limits
from mend.server.refusals import Refusals
from mend.server.robots.registry import RobotRegistry
from mend.server.robots.times import LinkTimes

TIMES = LinkTimes(heartbeat_s=0.001, silence_s=10.0, absence_s=0.001)

HELLO: dict[str, Any] = {
    "type": "hello",
    "protocol": 1,
    "robot": "arm",
    "boot": "b1",
    "behaviors": ["pick_and_place"],
    "cameras": ["head"],
    "reach": {"x": 0.0, "y": 0.0, "min_m": 0.2, "max_m": 0.8},
    "time": 0.0,
}
HELD = {"type": "held", "command": "c"}
REPORT: dict[str, Any] = {"type": "report", "seq": 1, "time": 1.0, "body": HELD}


class RawRobot:
    """A connection on which anything may be said."""

    def __init__(self, registry: RobotRegistry) -> None:
        self.channel, service_end = memory_channel()
        self.serving = asyncio.create_task(registry.serve(service_end))

    async def say(self, message: dict[str, Any]) -> None:
        await self.channel.send(json.dumps(message))

    async def hear(self) -> dict[str, Any]:
        async with asyncio.timeout(60):
            message: dict[str, Any] = json.loads(await self.channel.receive())
        return message


@pytest.fixture
async def journal() -> AsyncIterator[SqliteJournal]:
    journal = SqliteJournal(":memory:")
    yield journal
    journal.close()


@pytest.fixture
async def registry(journal: SqliteJournal) -> AsyncIterator[RobotRegistry]:
    registry = RobotRegistry(journal, lambda: 0.0, TIMES)
    yield registry
    registry.close()


@pytest.fixture
async def sink(registry: RobotRegistry, journal: SqliteJournal) -> RecordingSink:
    sink = RecordingSink(journal)
    registry.assign("arm", sink)
    return sink


def looked(**sighting: float) -> dict[str, Any]:
    seen = {"x": 0.0, "y": 0.0, "z": 0.0, "yaw": 0.0, "time": 0.0, **sighting}
    gripper = {"x": 0.0, "y": 0.0, "z": 0.0}
    return {"type": "looked", "command": "c", "objects": {"cup": seen}, "gripper": gripper}


def issue(**detection: Any) -> dict[str, Any]:
    seen = {"camera": "head", **detection}
    what = {"execution": "e", "issue": "missed", "step": 1, "interrupts": True}
    return {"type": "issue", **what, "detection": seen}


@pytest.mark.parametrize(
    ("message", "where"),
    [
        ({**REPORT, "seq": 2**53}, "report.seq"),
        ({**REPORT, "seq": 2**63}, "report.seq"),
        ({**REPORT, "time": 1e308}, "report.time"),
        ({**REPORT, "time": -1e308}, "report.time"),
        ({**REPORT, "body": looked(x=1e308)}, "report.body.looked.objects.cup.x"),
        ({**REPORT, "body": looked(time=-1e300)}, "report.body.looked.objects.cup.time"),
        ({**REPORT, "body": issue(area_px=2**40)}, "report.body.issue.detection.area_px"),
        ({**REPORT, "body": issue(center=[1e20, 0.0])}, "report.body.issue.detection.center.0"),
        ({**REPORT, "body": {**issue(), "step": -1}}, "report.body.issue.step"),
        ({**REPORT, "seq": 0}, "report.seq"),
        ({"type": "heartbeat", "time": 1e300}, "heartbeat.time"),
        ({"type": "heartbeat", "time": math.nan}, "heartbeat.time"),
    ],
)
async def test_a_number_beyond_all_bounds_ends_the_connection_and_says_where(
    registry: RobotRegistry, sink: RecordingSink, message: dict[str, Any], where: str
) -> None:
    robot = RawRobot(registry)
    await robot.say(HELLO)
    assert (await robot.hear())["type"] == "welcome"
    await robot.say(message)
    refusal = await robot.hear()
    assert refusal["type"] == "error"
    assert f"at {where}: " in refusal["detail"]
    with pytest.raises(ChannelClosedError):
        await robot.hear()
    assert sink.reports == []


async def test_numbers_beyond_all_bounds_are_counted(journal: SqliteJournal) -> None:
    refusals = Refusals()
    registry = RobotRegistry(journal, lambda: 0.0, TIMES, refusals=refusals)
    for hello in ({**HELLO, "time": 1e308}, HELLO):
        robot = RawRobot(registry)
        await robot.say(hello)
        await robot.say({**REPORT, "time": 1e308})
        with suppress(ChannelClosedError):
            while True:
                await robot.hear()
    registry.close()
    assert refusals.counts["robot_numbers"] == 2


async def test_the_run_is_told_why_such_a_robot_is_gone(
    registry: RobotRegistry, sink: RecordingSink
) -> None:
    robot = RawRobot(registry)
    await robot.say(HELLO)
    await sink.wait_until(lambda: len(sink.hellos) == 1)
    await robot.say({**REPORT, "time": 1e308})
    await sink.wait_until(lambda: bool(sink.lost))
    assert "report.time" in sink.lost[0]


async def test_the_same_start_of_its_program_is_not_let_in_again_but_the_next_one_is(
    registry: RobotRegistry, sink: RecordingSink
) -> None:
    robot = RawRobot(registry)
    await robot.say(HELLO)
    await robot.hear()
    await robot.say({**REPORT, "seq": 2**63})
    await robot.serving
    again = RawRobot(registry)
    await again.say(HELLO)
    refusal = await again.hear()
    assert refusal["type"] == "error"
    assert "start the robot's program again" in refusal["detail"]
    with pytest.raises(ChannelClosedError):
        await again.hear()
    anew = RawRobot(registry)
    await anew.say({**HELLO, "boot": "b2"})
    assert (await anew.hear())["type"] == "welcome"
    await anew.say(REPORT)
    assert (await anew.hear())["type"] == "ack"
    assert [each.seq for each in sink.reports] == [1]


async def test_a_hello_with_such_a_number_is_refused(registry: RobotRegistry) -> None:
    robot = RawRobot(registry)
    await robot.say({**HELLO, "time": 1e308})
    assert "at hello.time: " in (await robot.hear())["detail"]
    with pytest.raises(ChannelClosedError):
        await robot.hear()
    assert registry.known() == []


@pytest.mark.parametrize(
    "name",
    ["a\nb", "\x1b[31mred", "", "x" * 129, "a\u2028b", "\x9b1m", "\u202eann", "an\u200bn", " "],
)
async def test_a_robot_has_a_name_that_can_be_written(registry: RobotRegistry, name: str) -> None:
    robot = RawRobot(registry)
    await robot.say({**HELLO, "robot": name})
    assert "at hello.robot: " in (await robot.hear())["detail"]
    assert registry.known() == []


async def test_a_hello_that_is_too_long_is_refused(journal: SqliteJournal) -> None:
    registry = RobotRegistry(journal, lambda: 0.0, TIMES, Limits(hello_chars=1000))
    robot = RawRobot(registry)
    await robot.say({**HELLO, "behaviors": ["x" * 100] * 10})
    assert "a hello may have 1000 characters" in (await robot.hear())["detail"]
    with pytest.raises(ChannelClosedError):
        await robot.hear()
    assert registry.known() == []
    registry.close()


async def test_of_robots_that_are_gone_those_gone_longest_are_forgotten(
    journal: SqliteJournal,
) -> None:
    registry = RobotRegistry(journal, lambda: 0.0, TIMES, Limits(departed_robots=2))
    for name in ("a", "b", "c", "a", "d"):
        robot = RawRobot(registry)
        await robot.say({**HELLO, "robot": name})
        await robot.hear()
        await robot.channel.close()
        await robot.serving
    assert registry.known() == ["a", "d"]
    registry.close()


async def test_a_step_with_an_endless_name_is_not_taken(
    registry: RobotRegistry, sink: RecordingSink
) -> None:
    robot = RawRobot(registry)
    await robot.say(HELLO)
    await robot.hear()
    step = {"type": "step_started", "execution": "e", "step": 1, "name": "x" * 900_000}
    await robot.say({**REPORT, "body": step})
    assert "at report.body.step_started.name" in (await robot.hear())["detail"]
    assert sink.reports == []
