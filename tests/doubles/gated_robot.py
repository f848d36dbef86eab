"""A live robot on a real socket that goes on when a test lets it, and sees its own parts alone."""

import asyncio
import json
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from typing import Any

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from mend.robots.link.messages import Command, service_message

ROOM = {"resting": [(0.2, 0.0)], "hand_over": (0.4, 0.0), "around_m": 0.1}


class GatedRobot:
    """Carries out what it is told once `may_finish` and `may_look` are set, as they are at first.

    `started` are the parts that it was told to place, in order.
    """

    def __init__(
        self,
        name: str,
        boot: str,
        room: dict[str, Any] | None,
        shows: dict[str, Any] | None = None,
    ) -> None:
        self.name = name
        self._shows = shows
        self.started: list[str] = []
        self.looks = 0
        self.may_finish, self.may_look = asyncio.Event(), asyncio.Event()
        self.may_finish.set()
        self.may_look.set()
        self.news = asyncio.Condition()
        self._boot = boot
        self._room = room
        self._seq = 0
        self._placed: list[str] = []
        self._socket: ClientConnection | None = None

    async def work(self, socket: ClientConnection) -> None:
        """Work until the connection ends."""
        self._socket = socket
        await self._say(
            type="hello", protocol=1, robot=self.name, boot=self._boot, room=self._room,
            behaviors=["pick_and_place"], cameras=[], shows=self._shows,
            reach={"x": 0.0, "y": 0.0, "min_m": 0.2, "max_m": 0.6},
        )  # fmt: skip
        with suppress(ConnectionClosed, asyncio.CancelledError):
            async with asyncio.TaskGroup() as group:
                group.create_task(self._beat())
                async for text in socket:
                    message = service_message.validate_json(text)
                    if isinstance(message, Command):
                        await self._say(type="taken", command=message.id)
                        group.create_task(self._obey(message.id, message.body.model_dump()))

    async def show(self, *joints: float) -> None:
        """Tell how its arm is held, with nothing in its gripper."""
        tool = [0.3, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
        await self._say(type="poses", joints=joints, tool=tool, opening_m=0.05, objects=[])

    async def until(self, started: int = 0, looks: int = 0) -> None:
        """Wait until it was told so many things, in all."""
        async with asyncio.timeout(60), self.news:
            await self.news.wait_for(lambda: len(self.started) >= started and self.looks >= looks)

    async def _beat(self) -> None:
        while True:
            await self._say(type="heartbeat")
            await asyncio.sleep(0.1)

    async def _say(self, **message: Any) -> None:
        assert self._socket is not None
        await self._socket.send(json.dumps({"time": time.monotonic(), **message}))

    async def _report(self, **body: Any) -> None:
        self._seq += 1
        await self._say(type="report", seq=self._seq, body=body)

    async def _obey(self, command: str, body: dict[str, Any]) -> None:
        match body["type"]:
            case "look":
                await self._note(looks=1)
                await self.may_look.wait()
                there = [each for each in body["finished"] if each["object"] in self._placed]
                at_rest = {"x": 0.2, "y": 0.0, "z": 1.0}
                await self._report(
                    type="looked", command=command, objects={}, gripper=at_rest, there=there
                )
            case "start":
                execution, part = body["execution"], body["parameters"]["object"]
                step = {"step": 1, "name": "above pick"}
                await self._report(type="step_started", execution=execution, **step)
                await self._note(part)
                await self.may_finish.wait()
                self._placed.append(part)
                await self._report(type="finished", execution=execution)
            case "interrupt":
                at = "neutral" if body["retreat"] else "in_place"
                await self._report(type="holding", execution=None, at=at)

    async def _note(self, *started: str, looks: int = 0) -> None:
        async with self.news:
            self.started += started
            self.looks += looks
            self.news.notify_all()


@asynccontextmanager
async def gated_robot(
    url: str,
    token: str,
    name: str,
    *,
    boot: str = "b",
    room: dict[str, Any] | None = ROOM,
    shows: dict[str, Any] | None = None,
) -> AsyncIterator[GatedRobot]:
    """A robot that is there until the end of the block, and gone without a word then."""
    robot = GatedRobot(name, boot, room, shows)
    headers = {"Authorization": f"Bearer {token}"}
    async with connect(url, additional_headers=headers, compression=None) as socket:
        working = asyncio.create_task(robot.work(socket))
        try:
            yield robot
        finally:
            socket.transport.abort()
            working.cancel()
            await asyncio.gather(working, return_exceptions=True)
