"""A robot that is told one thing after the other, and nothing comes of it, is given up."""

import asyncio
import json
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from typing import Any
from uuid import UUID

import pytest
from live_service import LiveService, live_service
from pretend_service import BARE, OneTree, pretend_service
from task_documents import definition_of

from robots.link.channel import Channel, ChannelClosedError, memory_channel
from robots.link.messages import Command, service_message
from server.dialogues.escalation import EscalationPolicy
from server.journal.sqlite import SqliteJournal
from server.runtime.livelock import MOST_FRUITLESS_COMMANDS
from server.runtime.requests import RunRequest
from server.runtime.views import RunStatus, RunView
from sim.tabletop.layout import lay_out

PARTS = ("green_leg", "blue_leg", "pink_bar", "yellow_bar")
TREE = {
    "then": [
        {"behavior": "pick_and_place", "object": part, "place": f"place_of_{part}"}
        for part in PARTS
    ]
}
GRIPPER = {"x": 0.3, "y": 0.0, "z": 1.0}
Body = dict[str, Any]


class ToldRobot:
    """A robot over a channel in this process; what it does with a command is up to the test."""

    def __init__(self, service: LiveService, name: str) -> None:
        self.boots = 0
        self.told = 0
        self.asks = False
        self.service = service
        self.run: asyncio.Future[UUID] = asyncio.get_running_loop().create_future()
        self.executing = ""
        self._name = name
        self._tasks: list[asyncio.Task[None]] = []

    async def boot(self, obey: "Obey") -> None:
        """Start its program (again)."""
        self.boots += 1
        self._seq = 0
        self._channel, theirs = memory_channel()
        self._serving = asyncio.create_task(self.service.registry.serve(theirs))
        await self._say(
            type="hello", protocol=1, robot=self._name, boot=f"boot {self.boots}",
            behaviors=["pick_and_place"], cameras=[],
            reach={"x": 0.0, "y": 0.0, "min_m": 0.2, "max_m": 0.8},
        )  # fmt: skip
        self._tasks.append(asyncio.create_task(self._work(self._channel, obey)))

    async def ended(self) -> None:
        """Its connection has come to its end."""
        await self._serving

    async def end(self) -> None:
        """Its program ends, and the service has noticed."""
        await self._channel.close()
        await self._serving

    async def stop(self) -> None:
        await self.end()
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    async def _work(self, channel: Channel, obey: "Obey") -> None:
        with suppress(ChannelClosedError):
            while True:
                message = service_message.validate_json(await channel.receive())
                if isinstance(message, Command):
                    self.told += 1
                    await channel.send(_json(type="taken", command=message.id))
                    await obey(self, message.id, message.body.model_dump())

    async def _say(self, **message: Any) -> None:
        await self._channel.send(_json(time=time.monotonic(), **message))

    async def report(self, **body: Any) -> None:
        self._seq += 1
        await self._say(type="report", seq=self._seq, body=body)

    async def look(self, command: str, x: float = 0.5, **fields: Any) -> None:
        """What it sees: everything, and everything that is to be there."""
        seen = {
            part: {"x": x, "y": 0.1, "z": 0.7, "yaw": 0.0, "time": time.monotonic()}
            for part in PARTS
        }
        await self.report(type="looked", command=command, objects=seen, gripper=GRIPPER, **fields)

    async def finish(self, body: Body) -> None:
        about = {"execution": body["execution"]}
        await self.report(type="step_started", step=1, name="above pick", **about)
        await self.report(type="finished", **about)


Obey = Callable[[ToldRobot, str, Body], Any]


def _json(**message: Any) -> str:
    return json.dumps(message)


async def works(robot: ToldRobot, command: str, body: Body) -> None:
    if body["type"] == "look":
        await robot.look(command, there=body["finished"])
    elif body["type"] == "start":
        await robot.finish(body)


async def rejects_looks(robot: ToldRobot, command: str, body: Body) -> None:
    if body["type"] == "look":
        await robot.report(type="rejected", command=command, reason="I would rather not")


async def holds(robot: ToldRobot, command: str, body: Body) -> None:
    if body["type"] == "look":
        await robot.look(command)
    elif body["type"] in ("start", "resume"):
        await robot.report(type="holding", execution=body["execution"], at="in_place")


async def knows_an_unknown_issue(robot: ToldRobot, command: str, body: Body) -> None:
    if body["type"] == "look":
        await robot.look(command)
    elif body["type"] in ("start", "resume"):
        about = {"execution": body["execution"]}
        await robot.report(type="issue", issue="bored", step=1, interrupts=False, **about)
        await robot.report(type="holding", at="in_place", **about)


async def goes_backwards(robot: ToldRobot, command: str, body: Body) -> None:
    """It begins more and more steps of one and the same leaf."""
    if body["type"] == "look":
        await robot.look(command)
    elif body["type"] in ("start", "resume"):
        about = {"execution": body["execution"]}
        await robot.report(type="step_started", step=robot.told, name="one more", **about)
        await robot.report(type="holding", at="in_place", **about)


async def _misses(robot: ToldRobot, body: Body) -> None:
    about = {"execution": body["execution"]}
    await robot.report(type="issue", issue="missed", step=1, interrupts=True, **about)
    await robot.report(type="holding", at="neutral", **about)
    robot.asks = True


async def rejects_looks_while_it_asks(robot: ToldRobot, command: str, body: Body) -> None:
    if body["type"] == "start":
        await _misses(robot, body)
    elif robot.asks:
        await robot.report(type="rejected", command=command, reason="I would rather not")
    else:
        await robot.look(command)


async def sees_its_part_wander_while_it_asks(robot: ToldRobot, command: str, body: Body) -> None:
    if body["type"] == "start":
        await _misses(robot, body)
    elif body["type"] == "look":
        await robot.look(command, x=0.3 + 0.1 * (robot.told % 5))


async def floods(robot: ToldRobot, command: str, body: Body) -> None:
    """It makes as much as it likes of each thing that it is told."""
    if body["type"] == "look":
        await robot.look(command)
    elif body["type"] in ("start", "resume"):
        for _ in range(40):
            await robot.report(type="holding", execution=body["execution"], at="in_place")


async def boots_at_each_start(robot: ToldRobot, command: str, body: Body) -> None:
    if body["type"] == "look":
        await robot.look(command)
    elif body["type"] == "start":
        await robot.report(
            type="step_started", step=1, name="above pick", execution=body["execution"]
        )
        await robot.end()
        await robot.boot(boots_at_each_start)


@asynccontextmanager
async def at_work(
    obey: Obey, journal: SqliteJournal, *, with_another: bool
) -> AsyncIterator[tuple[LiveService, ToldRobot, UUID]]:
    tree = OneTree(definition_of(TREE), BARE)
    async with asyncio.timeout(60), live_service(journal, tree, token="t" * 32) as service:
        robot = ToldRobot(service, "arm")
        another = ToldRobot(service, "other arm")
        await robot.boot(obey)
        await another.boot(works)
        names = ["arm", "other arm"] if with_another else ["arm"]
        while not all(map(service.registry.connected, names)):  # noqa: ASYNC110
            await asyncio.sleep(0.01)
        run = await service.runtime.start_run(RunRequest(tree="one", world="live", robots=names))
        robot.run.set_result(run.id)
        yield service, robot, run.id
        await robot.stop()
        await another.stop()


async def end_of(
    obey: Obey, journal: SqliteJournal, *, with_another: bool = False
) -> tuple[RunView, ToldRobot, int]:
    """The run, the robot, and how many events the journal has of it."""
    async with at_work(obey, journal, with_another=with_another) as (service, robot, run):
        ended = await service.runtime.wait_for_end(run)
        events = await journal.read(0, 100_000, run)
    return ended, robot, len(events)


@pytest.mark.parametrize(
    "obey",
    [
        rejects_looks,
        holds,
        knows_an_unknown_issue,
        goes_backwards,
        boots_at_each_start,
        rejects_looks_while_it_asks,
        sees_its_part_wander_while_it_asks,
    ],
)
async def test_a_robot_with_which_nothing_comes_on_is_given_up(obey: Obey) -> None:
    journal = SqliteJournal(":memory:")
    ended, robot, events = await end_of(obey, journal)
    journal.close()
    assert ended.status is RunStatus.FAILED
    assert ended.result is not None
    assert ended.result.reason == (
        f"the robot 'arm' is given up: it was told {MOST_FRUITLESS_COMMANDS} things one after the "
        "other, and nothing was done and nobody answered meanwhile"
    )
    assert MOST_FRUITLESS_COMMANDS <= robot.told <= MOST_FRUITLESS_COMMANDS + 5
    assert events <= 4 * MOST_FRUITLESS_COMMANDS


async def test_a_robot_reports_no_more_for_being_told_the_same_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    most = 100
    monkeypatch.setattr("server.robots.known_robot.MOST_UNASKED_REPORTS", most)
    journal = SqliteJournal(":memory:")
    async with at_work(floods, journal, with_another=False) as (_, robot, run):
        await robot.ended()
        events = await journal.read(0, 100_000, run)
    journal.close()
    assert len(events) <= most + 10


async def test_another_robot_goes_on_without_one_that_is_given_up() -> None:
    journal = SqliteJournal(":memory:")
    ended, robot, _ = await end_of(holds, journal, with_another=True)
    journal.close()
    assert ended.status is RunStatus.FINISHED
    assert robot.told <= MOST_FRUITLESS_COMMANDS + len(PARTS) + 5


async def test_a_robot_whose_program_is_killed_again_and_again_goes_on_while_it_gets_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    most = 30
    monkeypatch.setattr("server.runtime.livelock.MOST_FRUITLESS_COMMANDS", most)
    kills = 12

    async def killed(robot: ToldRobot, command: str, body: Body) -> None:
        if body["type"] == "look":
            await robot.look(command, there=body["finished"])
        elif body["type"] == "start" and robot.boots % kills:
            await robot.end()
            await robot.boot(killed)
        elif body["type"] == "start":
            robot.boots += 1
            await robot.finish(body)

    journal = SqliteJournal(":memory:")
    ended, robot, _ = await end_of(killed, journal)
    journal.close()
    assert ended.status is RunStatus.FINISHED
    assert robot.told > 2 * most


async def test_a_run_that_people_pause_and_resume_goes_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    most = 10
    monkeypatch.setattr("server.runtime.livelock.MOST_FRUITLESS_COMMANDS", most)
    resumed = 0

    async def pauses(robot: ToldRobot, command: str, body: Body) -> None:
        nonlocal resumed
        if body["type"] == "look":
            await robot.look(command, there=body["finished"])
        elif body["type"] == "interrupt":
            await robot.report(type="holding", execution=robot.executing, at="in_place")
            await robot.service.runtime.resume(await robot.run)
        elif body["type"] == "resume" and resumed >= most:
            await robot.finish(body)
        elif body["type"] in ("start", "resume"):
            robot.executing = body["execution"]
            resumed += 1
            await robot.service.runtime.pause(await robot.run)

    journal = SqliteJournal(":memory:")
    ended, robot, _ = await end_of(pauses, journal)
    journal.close()
    assert ended.status is RunStatus.FINISHED
    assert robot.told > 3 * most


async def test_a_robot_that_asks_for_an_hour_is_not_given_up() -> None:
    """Its part stands before it, and it looks every other second whether that changes."""
    parts = [("part_1", "spot_1")]
    leaf = {"behavior": "pick_and_place", "object": "part_1", "place": "spot_1"}
    hour = EscalationPolicy(answer_within_s=1800.0)
    async with pretend_service(
        definition_of({"then": [leaf]}),
        {"part_1": [("missed", 4)]},
        policy=hour,
        scene=lay_out(parts, seed=1),
        wrong=True,
    ) as service:
        ended, events = await service.run_to_end(answers="none")
        [robot] = service.robots.robots.values()
    looks = [each for each in robot.commands if each.type == "look"]
    assert ended.status is RunStatus.FINISHED
    assert events[-1].time > 3600.0
    assert len(looks) > 5 * MOST_FRUITLESS_COMMANDS
