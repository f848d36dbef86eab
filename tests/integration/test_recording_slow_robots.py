"""A robot that does one thing after the other is kept from its work by no film of its cameras."""

import asyncio
import base64
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from typing import Any

from awaited_events import when
from gated_robot import GatedRobot
from service_under_test import until
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from mend.robots.link.messages import Command, service_message
from mend.server.composition import Service, open_service
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.server.settings import Settings

TOKEN = "t" * 32
PICTURE_S = 0.2
JPEG = base64.b64encode(b"\xff\xd8\xff a picture \xff\xd9").decode()


class SlowRobot(GatedRobot):
    """Raises a fault in what it is told to do; while it takes a picture it does nothing else."""

    def __init__(self) -> None:
        super().__init__("slow", "b", None)
        self.told: list[tuple[str, float]] = []

    async def work(self, socket: ClientConnection) -> None:
        self._socket = socket
        await self._say(
            type="hello", protocol=1, robot=self.name, boot="b", behaviors=["pick_and_place"],
            cameras=["forearm", "head"], reach={"x": 0.0, "y": 0.0, "min_m": 0.2, "max_m": 0.6},
        )  # fmt: skip
        with suppress(ConnectionClosed, asyncio.CancelledError):
            async with asyncio.TaskGroup() as group:
                group.create_task(self._beat())
                async for text in socket:
                    message = service_message.validate_json(text)
                    if isinstance(message, Command):
                        await self._one_by_one(message.id, message.body.model_dump())

    async def _one_by_one(self, command: str, body: dict[str, Any]) -> None:
        self.told.append((body["type"], time.monotonic()))
        if body["type"] == "take_picture":
            await asyncio.sleep(PICTURE_S)
            await self._say(type="picture", command=command, camera=body["camera"], jpeg=JPEG)
        elif body["type"] == "start":
            execution = body["execution"]
            await self._report(type="step_started", execution=execution, step=1, name="above pick")
            await self._report(
                type="issue", execution=execution, issue="missed", step=3, interrupts=True
            )
            await self._report(type="holding", execution=execution, at="neutral")
        elif self.looks == 0:
            await self._obey(command, body)
        await self._say(type="taken", command=command)

    @property
    def pictures(self) -> list[float]:
        return [at for kind, at in self.told if kind == "take_picture"]


@asynccontextmanager
async def faulty(folder: Path) -> AsyncIterator[tuple[Service, SlowRobot]]:
    values = {"data_dir": folder, "port": 0, "speech_voice": "none", "token": TOKEN}
    async with open_service(Settings.model_validate(values)) as service:
        robot = SlowRobot()
        headers = {"Authorization": f"Bearer {TOKEN}"}
        async with connect(
            service.robots_url, additional_headers=headers, compression=None
        ) as socket:
            working = asyncio.create_task(robot.work(socket))
            try:
                wish = {"tree": "eket", "world": "live", "robots": ["slow"], "answers": "none"}
                await service.runtime.start_run(RunRequest.model_validate(wish))
                await when(service, lambda each: isinstance(each, ev.IssueRaised))
                yield service, robot
            finally:
                working.cancel()
                await asyncio.gather(working, return_exceptions=True)


async def test_a_slow_robot_is_left_alone_between_its_pictures(tmp_path: Path) -> None:
    async with faulty(tmp_path) as (service, robot):
        recorded = await when(service, lambda each: isinstance(each, ev.CamerasRecorded))
        assert isinstance(recorded, ev.CamerasRecorded)
        assert {each.camera for each in recorded.pictures} == {"forearm", "head"}
        await until(lambda: len(robot.pictures) >= 3)
        assert robot.pictures[2] - robot.pictures[1] >= 4 * PICTURE_S
