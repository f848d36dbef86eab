"""Many live robots at one service: how soon is a helper asked, and what does each robot cost?

    python benchmarks/many_robots.py [--robots 10 30 100] [--seconds 45] [--step-s 2.0] [--quick]

The service is a process of its own. Robots, which are cheap and know where they are, and 5 helpers
are in this one. Each robot does one run after the other of the paper's task, and is held up once
for each part. Printed is the time from the moment at which a robot felt that to the arrival of its
question at each helper; the processor time of the service for each robot and second; and the
naive way, in the same run: a helper that asks for the open dialogues every second. The exit code is
1 where a robot among many costs more than 1.5 times one among few.
"""

# ruff: noqa: T201
import argparse
import asyncio
import json
import sys
import tempfile
import time
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

import httpx
import numpy as np
import psutil
from live_faulty_robots import FaultyRobot
from service_process import ServiceProcess
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

from mend.server.client import MendClient
from mend.server.runtime.requests import RunRequest

HELPERS = 5
POLL_PERIOD_S = 1.0
WARMS_UP_S = 6.0
PATIENCE_S = 60.0
MOST_GROWTH = 1.5


@dataclass
class Heard:
    """When the question about each fault was there, by the fault's execution."""

    pushed: list[dict[str, float]] = field(default_factory=list)
    polled: dict[str, float] = field(default_factory=dict)
    of_dialogue: dict[str, str] = field(default_factory=dict)
    of_node: dict[tuple[str, str], str] = field(default_factory=dict)


async def listen(url: str, name: str, heard: Heard) -> None:
    """A helper who reads all that comes, and notes the first prompt of each dialogue."""
    arrived: dict[str, float] = {}
    heard.pushed.append(arrived)
    with suppress(ConnectionClosed):
        async with connect(f"{url}/ws/helper?helper={name}", max_size=None) as socket:
            async for text in socket:
                event = json.loads(text)
                if event["type"] == "issue_raised":
                    heard.of_node[event["run"], event["node"]] = event["execution"]
                elif event["type"] == "prompt" and event["kind"] == "ask":
                    execution = heard.of_node.get((event["run"], event["node"]))
                    if execution is not None:
                        heard.of_dialogue[event["dialogue"]] = execution
                        arrived.setdefault(execution, time.time())


async def poll(url: str, heard: Heard) -> None:
    """The naive helper."""
    seen: dict[str, float] = {}
    async with httpx.AsyncClient(base_url=url, timeout=PATIENCE_S) as client:
        while True:
            found = await client.get("/api/dialogues", params={"status": "open", "limit": 200})
            for each in found.json():
                seen.setdefault(each["dialogue"], time.time())
            known = heard.of_dialogue
            heard.polled = {known[name]: at for name, at in seen.items() if name in known}
            await asyncio.sleep(POLL_PERIOD_S)


async def keep_busy(client: MendClient, robot: FaultyRobot, begun: set[str]) -> None:
    """One run after the other; whoever is asked says yes. `begun`: whose first run has begun."""
    asked = {"tree": "eket", "world": "live", "robots": [robot.name], "answers": ["yes"] * 20}
    while True:
        robot.forget_placed()
        started = await client.start_run(RunRequest.model_validate(asked))
        begun.add(robot.name)
        await client.wait_for_end(started.id)


@dataclass(frozen=True, slots=True)
class Measured:
    """Of so many robots: delays from fault to prompt, and what each cost the service."""

    robots: int
    pushed_s: list[float]
    polled_s: list[float]
    cost: float
    """Processor seconds of the service for each robot and second."""


async def measure(robots: int, seconds: float, step_s: float) -> Measured:
    """The service with so many robots, for a while after it has warmed up."""
    limits = {
        "RUNNING_RUNS": robots + 1, "CONNECTIONS": 2000, "CONNECTIONS_PER_PRINCIPAL": 2000,
        "STRANGERS_PER_ADDRESS": 2000, "REQUESTS_PER_S": 2000,
    }  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        service = ServiceProcess(
            Path(folder), MEND_SPEECH_VOICE="none", MEND_SPEECH_RECOGNITION="false",
            **{f"MEND_LIMITS__{name}": str(value) for name, value in limits.items()},
        )  # fmt: skip
        await service.start()
        try:
            return await _measured(service, robots, seconds, step_s)
        finally:
            await service.stop()


async def _measured(service: ServiceProcess, count: int, seconds: float, step_s: float) -> Measured:
    web, heard = service.url.replace("http", "ws", 1), Heard()
    robots = [FaultyRobot(f"robot-{number}", step_s) for number in range(count)]
    async with MendClient(service.url) as client:
        beside = [asyncio.create_task(each.work(web)) for each in robots]
        await _connected(client, count)
        beside += [
            asyncio.create_task(listen(web, f"helper-{number}", heard)) for number in range(HELPERS)
        ]
        beside.append(asyncio.create_task(poll(service.url, heard)))
        begun: set[str] = set()
        for each in robots:
            beside.append(asyncio.create_task(keep_busy(client, each, begun)))
            # Runs that begin at once would also fail at once.
            await asyncio.sleep(WARMS_UP_S / count)
        while len(begun) < count:  # noqa: ASYNC110 - nobody else tells that
            await asyncio.sleep(0.2)
        await asyncio.sleep(WARMS_UP_S)
        begin_s, used_s = time.time(), _used_s(service)
        await asyncio.sleep(seconds)
        used_s, end_s = _used_s(service) - used_s, time.time()
        for each in beside:
            each.cancel()
        await asyncio.gather(*beside, return_exceptions=True)
    faults = {
        execution: at
        for each in robots
        for execution, at in each.faults.items()
        if begin_s <= at < end_s - 2.0 * POLL_PERIOD_S
    }
    return Measured(
        count,
        [at - faults[e] for arrived in heard.pushed for e, at in arrived.items() if e in faults],
        [at - faults[e] for e, at in heard.polled.items() if e in faults],
        used_s / (count * (end_s - begin_s)),
    )


def _used_s(service: ServiceProcess) -> float:
    times = psutil.Process(service.process.pid).cpu_times()
    return float(times.user + times.system)


async def _connected(client: MendClient, count: int) -> None:
    async with asyncio.timeout(PATIENCE_S):
        while sum(each.connected for each in await client.robots()) < count:  # noqa: ASYNC110
            await asyncio.sleep(0.2)


def _told(seconds: list[float]) -> str:
    if not seconds:
        return "nothing measured"
    p50, p95 = np.percentile(np.array(seconds) * 1e3, [50, 95])
    return f"p50 {p50:5.0f} ms, p95 {p95:5.0f} ms (n {len(seconds)})"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--robots", nargs="+", type=int, default=[10, 30, 100])
    parser.add_argument("--seconds", type=float, default=45.0)
    parser.add_argument("--step-s", type=float, default=2.0)
    parser.add_argument("--quick", action="store_true")
    told = parser.parse_args()
    counts, seconds = ([3, 10], 15.0) if told.quick else (told.robots, told.seconds)
    measured = []
    for count in counts:
        found = asyncio.run(measure(count, seconds, told.step_s))
        measured.append(found)
        print(
            f"{count:4} robots: fault to prompt {_told(found.pushed_s)}; polled every second "
            f"{_told(found.polled_s)}; {found.cost * 1e3:.2f} ms of processor a robot and second",
            flush=True,
        )
    growth = measured[-1].cost / measured[0].cost
    print(f"a robot among {counts[-1]} costs {growth:.2f} times one among {counts[0]}")
    return 1 if growth > MOST_GROWTH else 0


if __name__ == "__main__":
    sys.exit(main())
