"""Many runs, a few helpers: is whoever is asked called at once, and does any question expire?

    python benchmarks/many_questions.py [--runs 20] [--helpers 5] [--questions 200] [--seed 1]

The service is a process of its own, and so is the push service's side that helpers' devices are
called through. Each robot does one run after the other of the paper's task, and is held up once for
each part, until somebody clears its way. A helper is signed in all the time, answers only what is
put to them, one question at a time, oldest first: thinks (4 s on average), says that they help, and
clears the way within 6 s. Beside them a fifth as many robots do runs whose questions a script
answers.

Printed are how many questions came to what end, how many expired and how long any helper was on
nothing while they waited, the time from each call's event to its arrival at the helper's page and
device, and how many devices were called about scripted runs. The exit code is 1 where a question
expired beside an idle helper, a call took more than 2 s, or a scripted run called anybody.
"""

# ruff: noqa: T201
import argparse
import asyncio
import json
import math
import random
import sys
import tempfile
import time
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Any
from uuid import UUID

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

import httpx
import numpy as np
from live_faulty_robots import FaultyRobot
from push_endpoint import PushDevice, PushService, push_service
from service_process import ServiceProcess
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

from mend.server.client import MendClient
from mend.server.client_errors import RefusedError
from mend.server.push.messages import CallMessage
from mend.server.runtime.requests import RunRequest

THINKS_S = 4.0
"""On average, exponentially distributed."""
CLEARS_WITHIN_S = 6.0
NEVER_S = 86_400.0
PATIENCE_S = 60.0
MOST_S = 2.0
NAMES = ("anna", "ben", "carla", "dora", "emil", "finn", "greta", "hugo")


@dataclass(frozen=True, slots=True)
class Call:
    """A question that was put to a helper: when it was journaled, and when the page had it."""

    dialogue: str
    helper: str
    put_s: float
    heard_s: float


@dataclass
class Seen:
    """What came to the helpers' pages of dialogues that are put to people.

    Moments are seconds since the epoch.
    """

    robots: dict[str, str] = field(default_factory=dict)
    calls: list[Call] = field(default_factory=list)
    claimed_s: dict[str, float] = field(default_factory=dict)
    ends: dict[str, tuple[str, float]] = field(default_factory=dict)

    def needed_until_s(self, call: Call) -> float:
        """Until when a helper was needed after a call; infinity if they still are."""
        others = [
            each.put_s
            for each in self.calls
            if each.dialogue == call.dialogue
            and each.helper != call.helper
            and each.put_s >= call.put_s
        ]
        _, ended_s = self.ends.get(call.dialogue, ("", math.inf))
        return min([self.claimed_s.get(call.dialogue, math.inf), ended_s, *others])


class SimulatedHelper:
    """Somebody at a console who answers what is put to them, one thing after the other."""

    def __init__(self, name: str, client: MendClient, seen: Seen, rng: random.Random) -> None:
        self.name = name
        self.idle: list[tuple[float, float]] = []
        """Stretches of time in which nothing was put to them and they were on nothing."""
        self._client, self._seen, self._rng = client, seen, rng
        self._mine: dict[str, str] = {}
        """Prompts that wait for this helper's answer, by dialogue."""
        self._changed = asyncio.Event()

    async def listen(self, url: str) -> None:
        with suppress(ConnectionClosed):
            async with connect(f"{url}/ws/helper?helper={self.name}", max_size=None) as socket:
                async for text in socket:
                    self._hear(json.loads(text))

    async def work(self, robots: dict[str, FaultyRobot]) -> None:
        while True:
            since = time.time()
            self.idle.append((since, math.inf))
            while not self._mine:
                self._changed.clear()
                await self._changed.wait()
            self.idle[-1] = (since, time.time())
            dialogue, prompt = next(iter(self._mine.items()))
            with suppress(RefusedError):
                await self._help(dialogue, prompt, robots)
            if self._mine.get(dialogue) == prompt:
                del self._mine[dialogue]

    async def _help(self, dialogue: str, prompt: str, robots: dict[str, FaultyRobot]) -> None:
        await self._client.claim(UUID(dialogue), self.name)
        await asyncio.sleep(self._rng.expovariate(1.0 / THINKS_S))
        await self._client.answer(UUID(dialogue), UUID(prompt), "yes", self.name)
        await asyncio.sleep(self._rng.uniform(0.0, CLEARS_WITHIN_S))
        robots[self._seen.robots[dialogue]].clear_way()
        while dialogue not in self._seen.ends:
            self._changed.clear()
            await self._changed.wait()

    def _hear(self, event: dict[str, Any]) -> None:
        seen, dialogue = self._seen, event.get("dialogue", "")
        if event["type"] == "dialogue_opened" and not event["scripted"]:
            seen.robots[dialogue] = event["robot"]
        if dialogue not in seen.robots:
            return
        match event["type"]:
            case "prompt" if event["kind"] == "ask":
                self._note_question(dialogue, event)
            case "claimed":
                seen.claimed_s.setdefault(dialogue, time.time())
            case "answered":
                self._mine.pop(dialogue, None)
            case "dialogue_closed":
                self._mine.pop(dialogue, None)
                seen.ends.setdefault(dialogue, (event["reason"], time.time()))
        self._changed.set()

    def _note_question(self, dialogue: str, event: dict[str, Any]) -> None:
        if event["to"] != self.name:
            self._mine.pop(dialogue, None)
            return
        put_s = datetime.fromisoformat(event["wall_time"]).timestamp()
        self._seen.calls.append(Call(dialogue, self.name, put_s, time.time()))
        self._mine[dialogue] = event["prompt"]


@dataclass(frozen=True, slots=True)
class Found:
    """What the helpers' pages and devices got until so many questions had ended."""

    ends: Counter[str]
    expired_beside_idle: int
    heard_s: list[float]
    pushed_s: list[float]
    unpushed: int
    about_scripted: int

    @property
    def is_good(self) -> bool:
        slowest_s = max([*self.heard_s, *self.pushed_s])
        return slowest_s <= MOST_S and not (
            self.expired_beside_idle or self.unpushed or self.about_scripted
        )


async def measure(runs: int, helpers: int, questions: int, step_s: float, seed: int) -> Found:
    """One service until so many questions have been put and ended."""
    names = [*NAMES[:helpers]]
    with tempfile.TemporaryDirectory() as folder, push_service() as pushes:
        limits = {
            "RUNNING_RUNS": 2 * runs, "CONNECTIONS": 2000, "CONNECTIONS_PER_PRINCIPAL": 2000,
            "STRANGERS_PER_ADDRESS": 2000, "REQUESTS_PER_S": 2000,
        }  # fmt: skip
        service = ServiceProcess(
            Path(folder), MEND_SPEECH_VOICE="none", MEND_SPEECH_RECOGNITION="false",
            MEND_HELPERS=json.dumps(names), MEND_PUSH_SERVICES='["127.0.0.1"]',
            **{f"MEND_LIMITS__{name}": str(value) for name, value in limits.items()},
        )  # fmt: skip
        await service.start()
        try:
            return await _measured(service, pushes, names, runs, questions, step_s, seed)
        finally:
            await service.stop()


async def _measured(
    service: ServiceProcess,
    pushes: PushService,
    names: list[str],
    runs: int,
    questions: int,
    step_s: float,
    seed: int,
) -> Found:
    rng, seen = random.Random(seed), Seen()
    web = service.url.replace("http", "ws", 1)
    live = {f"robot-{n}": FaultyRobot(f"robot-{n}", step_s, NEVER_S) for n in range(runs)}
    scripted = [FaultyRobot(f"scripted-{n}", step_s) for n in range(max(1, runs // 5))]
    devices = {name: PushDevice(pushes, name) for name in names}
    began: set[UUID] = set()
    async with MendClient(service.url) as client:
        for name, device in devices.items():
            await subscribe(service.url, device, name)
        robots = [*live.values(), *scripted]
        beside = [asyncio.create_task(each.work(web)) for each in robots]
        await _connected(client, len(robots))
        people = [
            SimulatedHelper(name, client, seen, random.Random(rng.random())) for name in names
        ]
        beside += [asyncio.create_task(each.listen(web)) for each in people]
        beside += [asyncio.create_task(each.work(live)) for each in people]
        for number, each in enumerate(robots):
            answers = "live" if each.name in live else ["yes"] * 20
            late_s = rng.uniform(0.0, 7.0 * step_s)
            noted = None if number < runs else began
            beside.append(asyncio.create_task(_keep_busy(client, each, answers, late_s, noted)))
        while len(seen.ends) < questions:  # noqa: ASYNC110 - the helpers hear of it, not this
            await asyncio.sleep(0.5)
        for task in beside:
            task.cancel()
        await asyncio.gather(*beside, return_exceptions=True)
    return _found(seen, people, pushes, devices, began)


def _found(
    seen: Seen,
    people: list[SimulatedHelper],
    pushes: PushService,
    devices: dict[str, PushDevice],
    scripted: set[UUID],
) -> Found:
    arrivals: dict[tuple[str, str], list[float]] = {}
    about_scripted = 0
    for pushed in [*pushes.pushed]:
        device = next(each for each in devices.values() if each.path == pushed.path)
        message = device.read(pushed)
        if isinstance(message, CallMessage):
            about_scripted += message.run in scripted
            arrivals.setdefault((str(message.dialogue), device.name), []).append(pushed.at_s)
    pushed_s, unpushed = _pushed_after(seen, arrivals)
    idle = [stretch for each in people for stretch in each.idle]
    expired = [at_s for reason, at_s in seen.ends.values() if reason == "gave_up"]
    return Found(
        Counter(reason for reason, _ in seen.ends.values()),
        sum(any(since <= at_s <= until for since, until in idle) for at_s in expired),
        [each.heard_s - each.put_s for each in seen.calls],
        pushed_s,
        unpushed,
        about_scripted,
    )


def _pushed_after(
    seen: Seen, arrivals: dict[tuple[str, str], list[float]]
) -> tuple[list[float], int]:
    """How long each call took to its helper's device, and how many never came there.

    Whoever is on the question before the push was sent needs none, and gets none; nor does who is
    asked no longer by then, as somebody idle is.
    """
    after_s, missed, now_s = [], 0, time.time()
    for call in seen.calls:
        at_s = [
            each for each in arrivals.get((call.dialogue, call.helper), []) if each >= call.put_s
        ]
        if at_s:
            after_s.append(min(at_s) - call.put_s)
        elif (until_s := min(seen.needed_until_s(call), now_s)) > call.put_s + MOST_S:
            print(f"no push to {call.helper}, who was asked for {until_s - call.put_s:.1f} s")
            missed += 1
    return after_s, missed


async def _keep_busy(
    client: MendClient,
    robot: FaultyRobot,
    answers: Any,
    late_s: float,
    began: set[UUID] | None,
) -> None:
    """One run after the other, the first after a while: robots seldom begin all at once."""
    await asyncio.sleep(late_s)
    asked = {"tree": "eket", "world": "live", "robots": [robot.name], "answers": answers}
    while True:
        robot.forget_placed()
        started = await client.start_run(RunRequest.model_validate(asked))
        if began is not None:
            began.add(started.id)
        await client.wait_for_end(started.id)


async def subscribe(url: str, device: PushDevice, helper: str) -> None:
    async with httpx.AsyncClient(base_url=url) as client:
        body = {**device.subscription, "helper": helper}
        answer = await client.post("/api/push/subscriptions", json=body)
        answer.raise_for_status()


async def _connected(client: MendClient, count: int) -> None:
    async with asyncio.timeout(PATIENCE_S):
        while sum(each.connected for each in await client.robots()) < count:  # noqa: ASYNC110
            await asyncio.sleep(0.2)


def _told(seconds: list[float]) -> str:
    p50, p95, most = np.percentile(np.array(seconds) * 1e3, [50, 95, 100])
    return f"p50 {p50:.0f} ms, p95 {p95:.0f} ms, max {most:.0f} ms (n {len(seconds)})"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--helpers", type=int, default=5, choices=range(1, len(NAMES) + 1))
    parser.add_argument("--questions", type=int, default=200)
    parser.add_argument("--step-s", type=float, default=6.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--quick", action="store_true")
    told = parser.parse_args()
    runs, questions = (6, 12) if told.quick else (told.runs, told.questions)
    found = asyncio.run(measure(runs, told.helpers, questions, told.step_s, told.seed))
    ends = ", ".join(f"{count} {reason}" for reason, count in found.ends.most_common())
    print(
        f"{runs} runs, {told.helpers} helpers: {found.ends.total()} questions ended: {ends}; "
        f"{found.ends['gave_up']} expired, {found.expired_beside_idle} beside an idle helper"
    )
    print(f"a call to the helper's page: {_told(found.heard_s)}")
    print(f"and to the device: {_told(found.pushed_s)}; {found.unpushed} never came")
    print(f"devices called about scripted runs: {found.about_scripted}")
    return 0 if found.is_good else 1


if __name__ == "__main__":
    sys.exit(main())
