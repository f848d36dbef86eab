"""A live robot that takes its time is heard while a person helps it, and so are people."""

import asyncio
import json
import time
from typing import Any

import pytest
from live_service import LiveService, live_service
from pretend_service import BARE, OneTree
from task_documents import definition_of

from mend.robots.link.channel import Channel, memory_channel
from mend.robots.link.messages import Command, service_message
from mend.server.journal.sqlite import SqliteJournal
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import DialogueView, RunStatus

PART = "green_leg"
ONE_PART = {"behavior": "pick_and_place", "object": PART, "place": "left"}
GRIPPER = {"x": 0.3, "y": 0.0, "z": 1.0}


class LateRobot:
    """Misses its part; where its arm and its looks are late they come when a test says so."""

    def __init__(self, channel: Channel, *, late_arm: bool, late_looks: bool) -> None:
        self.in_time = asyncio.Event()
        self._channel = channel
        self._late_arm = late_arm
        self._late_looks = late_looks
        self._seq = 0
        self._executions = 0

    async def _say(self, **message: Any) -> None:
        await self._channel.send(_json(time=time.monotonic(), **message))

    async def _report(self, **body: Any) -> None:
        self._seq += 1
        await self._say(type="report", seq=self._seq, body=body)

    async def work(self) -> None:
        reach = {"x": 0.0, "y": 0.0, "min_m": 0.2, "max_m": 0.8}
        await self._say(
            type="hello", protocol=1, robot="arm", boot="b", behaviors=["pick_and_place"],
            cameras=["head"], reach=reach,
        )  # fmt: skip
        async with asyncio.TaskGroup() as group:
            while True:
                message = service_message.validate_json(await self._channel.receive())
                if isinstance(message, Command):
                    await self._channel.send(_json(type="taken", command=message.id))
                    group.create_task(self._obey(message.id, message.body.model_dump()))

    async def _obey(self, command: str, body: dict[str, Any]) -> None:
        if body["type"] == "look":
            if self._late_looks and self._executions:
                await self.in_time.wait()
            seen = {PART: {"x": 0.5, "y": 0.1, "z": 0.7, "yaw": 0.0, "time": time.monotonic()}}
            fulfilled = {"fulfilled": True} if body.get("expect") else {}
            await self._report(
                type="looked", command=command, objects=seen, gripper=GRIPPER, **fulfilled
            )
        elif body["type"] == "start" and not self._executions:
            self._executions += 1
            execution = body["execution"]
            about = {"execution": execution, "step": 1}
            await self._report(type="step_started", name="above pick", **about)
            await self._report(type="issue", issue="missed", interrupts=True, **about)
            if self._late_arm:
                await self.in_time.wait()
            await self._report(type="holding", execution=execution, at="neutral")


def _json(**message: Any) -> str:
    return json.dumps(message)


async def _question(service: LiveService) -> DialogueView:
    while not (found := await service.runtime.dialogues.page("open", 10, 0)) or not found[0].prompt:  # noqa: ASYNC110
        await asyncio.sleep(0.01)
    return found[0]


@pytest.mark.parametrize(
    ("late_arm", "late_looks"), [(True, False), (False, True), (True, True), (False, False)]
)
async def test_who_has_promised_help_can_still_pause_and_abort(
    late_arm: bool, late_looks: bool
) -> None:
    journal = SqliteJournal(":memory:")
    tree = OneTree(definition_of(ONE_PART), BARE)
    async with asyncio.timeout(60), live_service(journal, tree, token="t" * 32) as service:
        ours, theirs = memory_channel()
        robot = LateRobot(ours, late_arm=late_arm, late_looks=late_looks)
        serving = asyncio.create_task(service.registry.serve(theirs))
        working = asyncio.create_task(robot.work())
        while not service.registry.connected("arm"):  # noqa: ASYNC110
            await asyncio.sleep(0.01)
        run = await service.runtime.start_run(RunRequest(tree="one", world="live", robots=["arm"]))
        asked = await _question(service)
        assert asked.prompt is not None
        await service.runtime.dialogues.answer(asked.dialogue, asked.prompt.prompt, "yes", "ben")
        robot.in_time.set()
        assert (await service.runtime.pause(run.id)).status is RunStatus.PAUSED
        await service.runtime.resume(run.id)
        await service.runtime.abort(run.id)
        ended = await service.runtime.wait_for_end(run.id)
        assert ended.status is RunStatus.ABORTED
        working.cancel()
        await ours.close()
        await asyncio.gather(serving, working, return_exceptions=True)
    journal.close()
