"""A live robot that does with each command what a test says, at a run with a few leaves."""

import asyncio
import json
import time
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager, suppress
from typing import Any
from uuid import UUID

from live_service import LiveService, live_service
from pretend_service import BARE, OneTree
from task_documents import definition_of

from mend.robots.link.channel import Channel, ChannelClosedError, memory_channel
from mend.robots.link.messages import Command, service_message
from mend.server.journal.sqlite import SqliteJournal
from mend.server.robots.times import LinkTimes
from mend.server.runtime.context import RunSettings
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunView

PARTS = ("green_leg", "blue_leg", "pink_bar", "yellow_bar")
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
        self.parts: Sequence[str] = PARTS
        self.heard: list[Body] = []
        self._name = name
        self._tasks: list[asyncio.Task[None]] = []

    async def boot(self, obey: "Obey") -> None:
        """Start its program (again)."""
        self.boots += 1
        self._seq = 0
        await self.connect(obey)

    async def connect(self, obey: "Obey", **doing: Any) -> None:
        """Connect (again) with the same start of its program; `doing`: more for its hello."""
        self._channel, theirs = memory_channel()
        self._serving = asyncio.create_task(self.service.registry.serve(theirs))
        await self._say(
            type="hello", protocol=1, robot=self._name, boot=f"boot {self.boots}",
            behaviors=["pick_and_place"], cameras=[],
            reach={"x": 0.0, "y": 0.0, "min_m": 0.2, "max_m": 0.8}, **doing,
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
                    self.heard.append(message.body.model_dump())
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
            for part in self.parts
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


@asynccontextmanager
async def at_work(
    obey: Obey,
    journal: SqliteJournal,
    *,
    another_obeys: Obey | None = None,
    kind: str = "then",
    parts: Sequence[str] = PARTS,
    settings: RunSettings | None = None,
    times: LinkTimes | None = None,
    **request: Any,
) -> AsyncIterator[tuple[LiveService, ToldRobot, UUID]]:
    """A robot called 'arm' at a run with a leaf for each part, and 'other arm' if that obeys."""
    leaves = [
        {"behavior": "pick_and_place", "object": part, "place": f"place_of_{part}"}
        for part in parts
    ]
    tree = OneTree(definition_of({kind: leaves}), BARE)
    async with (
        asyncio.timeout(60),
        live_service(journal, tree, settings=settings, times=times, token="t" * 32) as service,
    ):
        robot = ToldRobot(service, "arm")
        another = ToldRobot(service, "other arm")
        robot.parts = another.parts = parts
        await robot.boot(obey)
        await another.boot(another_obeys or works)
        names = ["arm", "other arm"] if another_obeys else ["arm"]
        while not all(map(service.registry.connected, names)):  # noqa: ASYNC110
            await asyncio.sleep(0.01)
        wanted = RunRequest(tree="one", world="live", robots=names, **request)
        run = await service.runtime.start_run(wanted)
        robot.run.set_result(run.id)
        yield service, robot, run.id
        await robot.stop()
        await another.stop()


async def end_of(obey: Obey, journal: SqliteJournal, **more: Any) -> tuple[RunView, ToldRobot, int]:
    """The run, the robot, and how many events the journal has of it."""
    async with at_work(obey, journal, **more) as (service, robot, run):
        ended = await service.runtime.wait_for_end(run)
        events = await journal.read(0, 100_000, run)
    return ended, robot, len(events)
