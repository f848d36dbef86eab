"""The robot's end of the link, talking to a service that the test plays."""

import asyncio
import random
import threading
from collections.abc import AsyncIterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import TypeVar

import pytest
from counting_agent import CountingAgent

from mend.robots.link.channel import Channel, ChannelClosedError, LinkRefusedError, memory_channel
from mend.robots.link.client import Aside, LinkSettings, run_agent
from mend.robots.link.clock import LoopClock
from mend.robots.link.messages import (
    Ack,
    AnyServiceMessage,
    Command,
    CommandBody,
    Driven,
    Heartbeat,
    Hello,
    Hold,
    LinkError,
    Look,
    PoseLayout,
    Poses,
    Report,
    ShowPoses,
    Shutdown,
    Start,
    Taken,
    Welcome,
    robot_message,
)
from mend.robots.link.outbox import IN_MEMORY, Outbox

START = Start(execution="e1", node="/0", behavior="count", parameters={})
IMPATIENT = LinkSettings(first_backoff_s=0.001, longest_backoff_s=0.002, goodbye_s=0.05)

M = TypeVar("M", Hello, Report, Taken, Heartbeat, Poses)


class PlayedService:
    """Accepts connections one after the other; the test says what the service says."""

    def __init__(self) -> None:
        self._connections: asyncio.Queue[Channel] = asyncio.Queue()
        self._channel: Channel | None = None
        self.heartbeat_s = 60.0

    async def connect(self) -> Channel:
        robot_end, service_end = memory_channel()
        self._connections.put_nowait(service_end)
        return robot_end

    async def accept(self, received: int = 0) -> Hello:
        async with asyncio.timeout(60):
            self._channel = await self._connections.get()
            hello = await self.next(Hello)
        await self.say(Welcome(protocol=1, received=received, heartbeat_s=self.heartbeat_s))
        return hello

    async def say(self, message: AnyServiceMessage) -> None:
        await self.say_text(message.model_dump_json())

    async def say_text(self, text: str) -> None:
        assert self._channel is not None
        await self._channel.send(text)

    async def command(self, command_id: str, body: CommandBody) -> None:
        await self.say(Command(id=command_id, body=body))

    async def next(self, kind: type[M]) -> M:
        """The next message of a kind; skips others."""
        assert self._channel is not None
        async with asyncio.timeout(60):
            while True:
                message = robot_message.validate_json(await self._channel.receive())
                if isinstance(message, kind):
                    return message

    async def drop(self) -> None:
        assert self._channel is not None
        await self._channel.close()


class Robot:
    """A counting robot that runs against a played service."""

    def __init__(
        self, agent: CountingAgent, outbox: Outbox | None = None, aside: Aside | None = None
    ) -> None:
        self.agent = agent
        self.service = PlayedService()
        self.outbox = outbox or Outbox(IN_MEMORY, agent.robot, "b1")
        self.task = asyncio.create_task(
            run_agent(
                agent,
                self.service.connect,
                self.outbox,
                LoopClock(),
                random.Random(0),
                IMPATIENT,
                aside,
            )
        )


@pytest.fixture
async def robot() -> AsyncIterator[Robot]:
    robot = Robot(CountingAgent())
    yield robot
    robot.task.cancel()
    await asyncio.gather(robot.task, return_exceptions=True)
    robot.outbox.close()


async def acknowledge_until_finished(service: PlayedService) -> list[Report]:
    reports = [await service.next(Report)]
    while reports[-1].body.type != "finished":
        await service.say(Ack(seq=reports[-1].seq))
        reports.append(await service.next(Report))
    await service.say(Ack(seq=reports[-1].seq))
    return reports


async def test_a_command_is_carried_out_taken_and_reported_on(robot: Robot) -> None:
    hello = await robot.service.accept()
    assert (hello.robot, hello.boot, hello.protocol) == ("counter", "b1", 1)
    await robot.service.command("c1", START)
    assert (await robot.service.next(Taken)).command == "c1"
    reports = await acknowledge_until_finished(robot.service)
    assert [report.seq for report in reports] == [1, 2, 3, 4]
    assert all(report.boot == "b1" for report in reports)


async def test_an_agent_works_in_a_thread_of_its_own_and_its_reports_are_passed_on() -> None:
    threads: set[int] = set()

    class Agent(CountingAgent):
        def advance(self, duration_s: float) -> bool:
            threads.add(threading.get_ident())
            return super().advance(duration_s)

    executor = ThreadPoolExecutor(1)
    robot = Robot(Agent(), aside=partial(asyncio.get_running_loop().run_in_executor, executor))
    await robot.service.accept()
    await robot.service.command("c1", START)
    reports = await acknowledge_until_finished(robot.service)
    assert [report.seq for report in reports] == [1, 2, 3, 4]
    assert len(threads) == 1
    assert threading.get_ident() not in threads
    robot.task.cancel()
    await asyncio.gather(robot.task, return_exceptions=True)
    robot.outbox.close()
    executor.shutdown()


async def test_a_command_that_comes_twice_is_carried_out_once_and_taken_twice(
    robot: Robot,
) -> None:
    await robot.service.accept()
    await robot.service.command("c1", Look())
    await robot.service.command("c1", Look())
    assert [(await robot.service.next(Taken)).command for _ in range(2)] == ["c1", "c1"]
    assert [command for command, _ in robot.agent.handled] == ["c1"]


async def test_after_a_drop_the_robot_is_the_same_boot_and_resends_what_is_not_acknowledged(
    robot: Robot,
) -> None:
    await robot.service.accept()
    await robot.service.command("c1", Look())
    await robot.service.next(Report)
    await robot.service.drop()
    hello = await robot.service.accept()
    assert hello.boot == "b1"
    assert (await robot.service.next(Report)).seq == 1


async def test_what_the_welcome_says_is_received_is_not_sent_again(robot: Robot) -> None:
    await robot.service.accept()
    await robot.service.command("c1", Look())
    await robot.service.next(Report)
    await robot.service.drop()
    await robot.service.accept(received=1)
    await robot.service.command("c2", Look())
    report = await robot.service.next(Report)
    assert (report.seq, report.body.command) == (2, "c2")


async def test_a_command_sent_again_after_a_drop_is_not_carried_out_again(robot: Robot) -> None:
    await robot.service.accept()
    await robot.service.command("c1", Look())
    await robot.service.next(Report)
    await robot.service.drop()
    await robot.service.accept()
    await robot.service.command("c1", Look())
    assert (await robot.service.next(Taken)).command == "c1"
    assert len(robot.agent.handled) == 1


async def test_a_simulated_world_does_not_run_ahead_of_what_is_acknowledged(robot: Robot) -> None:
    await robot.service.accept()
    await robot.service.command("c1", START)
    first = await robot.service.next(Report)
    await robot.service.command("c2", Look())
    await robot.service.next(Taken)
    assert robot.agent.time_s() == first.time
    await robot.service.say(Ack(seq=1))
    assert (await robot.service.next(Report)).body.type == "looked"


async def test_a_real_robot_finishes_what_it_does_without_a_connection() -> None:
    robot = Robot(CountingAgent(simulated=False))
    await robot.service.accept()
    await robot.service.command("c1", START)
    await robot.service.next(Report)
    await robot.service.drop()
    await robot.service.accept(received=1)
    reports = [await robot.service.next(Report) for _ in range(3)]
    assert [report.seq for report in reports] == [2, 3, 4]
    robot.task.cancel()
    await asyncio.gather(robot.task, return_exceptions=True)
    robot.outbox.close()


async def test_an_idle_robot_waits_for_a_command(robot: Robot) -> None:
    await robot.service.accept()
    for n in range(3):
        await robot.service.command(f"c{n}", Look())
        await robot.service.say(Ack(seq=(await robot.service.next(Report)).seq))
    assert robot.agent.idle_advances <= 10


async def test_heartbeats_come_by_themselves() -> None:
    robot = Robot(CountingAgent())
    robot.service.heartbeat_s = 0.001
    await robot.service.accept()
    for _ in range(3):
        assert (await robot.service.next(Heartbeat)).time == 0.0
    robot.task.cancel()
    await asyncio.gather(robot.task, return_exceptions=True)
    robot.outbox.close()


async def test_an_unknown_command_is_rejected_and_an_unknown_message_ignored(
    robot: Robot,
) -> None:
    await robot.service.accept()
    await robot.service.say_text('{"type": "horoscope", "sign": "robot"}')
    await robot.service.say_text("not even json")
    await robot.service.say_text('{"type": "command", "id": "c1", "body": {"type": "dance"}}')
    report = await robot.service.next(Report)
    assert (report.body.type, report.body.command) == ("rejected", "c1")
    assert robot.agent.handled == []


async def test_a_shutdown_ends_the_robot_after_its_last_report(robot: Robot) -> None:
    await robot.service.accept()
    await robot.service.command("c1", Hold(until=1.0))
    await robot.service.command("c2", Shutdown())
    report = await robot.service.next(Report)
    await robot.service.say(Ack(seq=report.seq))
    async with asyncio.timeout(60):
        await robot.task


async def test_a_shutdown_does_not_wait_for_a_service_that_is_gone(robot: Robot) -> None:
    await robot.service.accept()
    await robot.service.command("c1", Hold(until=1.0))
    await robot.service.command("c2", Shutdown())
    async with asyncio.timeout(60):
        await robot.task


async def test_an_error_in_place_of_a_welcome_ends_the_robot() -> None:
    robot_end, service_end = memory_channel()

    async def connect() -> Channel:
        return robot_end

    await service_end.send(LinkError(detail="this service speaks protocol 9").model_dump_json())
    outbox = Outbox(IN_MEMORY, "counter", "b1")
    with pytest.raises(LinkRefusedError, match="speaks protocol 9"):
        await run_agent(CountingAgent(), connect, outbox, LoopClock(), random.Random(0), IMPATIENT)
    outbox.close()


async def test_a_service_that_is_not_there_yet_is_tried_again() -> None:
    service = PlayedService()
    attempts = 0

    async def connect() -> Channel:
        nonlocal attempts
        attempts += 1
        if attempts < 4:
            raise ChannelClosedError("no service")
        return await service.connect()

    outbox = Outbox(IN_MEMORY, "counter", "b1")
    task = asyncio.create_task(
        run_agent(CountingAgent(), connect, outbox, LoopClock(), random.Random(0), IMPATIENT)
    )
    await service.accept()
    assert attempts == 4
    await service.command("c1", Shutdown())
    await task
    outbox.close()


# --- What is driven ---------------------------------------------------------------------------


class DrivingAgent(CountingAgent):
    """A counting robot that drives two metres a step."""

    def driven(self) -> Driven:
        return Driven(way_m=2.0 * self.time_s(), barred_s=0.0)


async def test_a_robot_that_drives_says_how_far_it_had_when_something_happened() -> None:
    robot = Robot(DrivingAgent())
    assert (await robot.service.accept()).driven == Driven(way_m=0.0, barred_s=0.0)
    await robot.service.command("c1", START)
    reports = await acknowledge_until_finished(robot.service)
    ways_m = [each.driven.way_m for each in reports if each.driven is not None]
    assert ways_m == [2.0 * each.time for each in reports]
    robot.task.cancel()
    await asyncio.gather(robot.task, return_exceptions=True)
    robot.outbox.close()


async def test_a_robot_without_a_base_says_nothing_of_that(robot: Robot) -> None:
    assert (await robot.service.accept()).driven is None
    await robot.service.command("c1", START)
    assert {each.driven for each in await acknowledge_until_finished(robot.service)} == {None}


# --- Poses ------------------------------------------------------------------------------------


class ShowingAgent(CountingAgent):
    """A counting robot that counts as well how often it was asked where everything is."""

    asked = 0

    def pose_layout(self) -> PoseLayout:
        return PoseLayout(joints=["elbow"])

    def poses(self) -> Poses:
        self.asked += 1
        return Poses(
            time=self.time_s(),
            joints=[self.time_s()],
            tool=(0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
            opening_m=0.05,
        )


@pytest.fixture
async def showing() -> AsyncIterator[Robot]:
    robot = Robot(ShowingAgent(simulated=False))
    yield robot
    robot.task.cancel()
    await asyncio.gather(robot.task, return_exceptions=True)
    robot.outbox.close()


async def test_a_robot_says_what_it_shows_and_shows_it_only_when_asked(showing: Robot) -> None:
    agent = showing.agent
    assert isinstance(agent, ShowingAgent)
    hello = await showing.service.accept()
    assert hello.shows == PoseLayout(joints=["elbow"])
    await showing.service.command("c1", START)
    await acknowledge_until_finished(showing.service)
    assert agent.asked == 0
    await showing.service.say(ShowPoses(rate_hz=20.0))
    poses = await showing.service.next(Poses)
    assert poses.time == agent.time_s()
    await showing.service.command("c2", START)
    assert (await showing.service.next(Poses)).time >= poses.time


async def test_what_a_connection_was_asked_to_show_ends_with_it(showing: Robot) -> None:
    agent = showing.agent
    assert isinstance(agent, ShowingAgent)
    await showing.service.accept()
    await showing.service.say(ShowPoses(rate_hz=20.0))
    await showing.service.next(Poses)
    await showing.service.drop()
    await showing.service.accept()
    asked = agent.asked
    await showing.service.command("c1", START)
    await acknowledge_until_finished(showing.service)
    assert agent.asked == asked


async def test_a_robot_that_shows_nothing_ignores_that_it_was_asked(robot: Robot) -> None:
    assert (await robot.service.accept()).shows is None
    await robot.service.say(ShowPoses(rate_hz=20.0))
    await robot.service.command("c1", START)
    assert await acknowledge_until_finished(robot.service)
