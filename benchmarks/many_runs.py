# ruff: noqa: T201
"""What a service's process takes after thousands of runs: memory, threads, descriptors, processes.

    python benchmarks/many_runs.py [--runs 10000] [--at-a-time 6] [--helpers 3] [--world live]

Of the world `live`, the robots are processes of their own that take no time for a step; those of
`tabletop` are in the service's process. Helpers watch all the time, others come and go with every
run. Memory is compared between two moments when as many runs are
going on: after a tenth of the runs, and after all of them. There is no peer.
"""

import argparse
import asyncio
import sys
import tempfile
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

import psutil
from chaos_robots import RobotKeeper
from service_process import ServiceProcess
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

from mend.server.client import MendClient
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus

LIVE = "live"
MOMENTS = 20
PATIENCE_S = 60.0


@dataclass(frozen=True, slots=True)
class Footprint:
    """What a service's process takes after `runs`."""

    runs: int
    rss_mb: float
    threads: int
    descriptors: int
    processes: int

    def __str__(self) -> str:
        return (
            f"{self.runs:6} runs: {self.rss_mb:6.1f} MB, {self.threads} threads, "
            f"{self.descriptors} descriptors, {self.processes} process(es)"
        )


def footprint(service: ServiceProcess, runs: int) -> Footprint:
    process = psutil.Process(service.process.pid)
    return Footprint(
        runs,
        process.memory_info().rss / 1e6,
        process.num_threads(),
        process.num_fds(),
        1 + len(process.children(recursive=True)),
    )


class Starter:
    """Has each robot do one run after the other, until there were `runs`."""

    def __init__(self, service: ServiceProcess, runs: int, client: MendClient) -> None:
        self.footprints: list[Footprint] = []
        self._service = service
        self._client = client
        self._left = runs
        self._done = 0
        self._every = max(1, runs // MOMENTS)

    async def keep_busy(self, asked: dict[str, Any]) -> None:
        request = RunRequest.model_validate({"tree": "eket", "answers": "live", **asked})
        while self._left > 0:
            self._left -= 1
            async with asyncio.timeout(PATIENCE_S):
                started = await self._client.start_run(request)
                run = await self._client.wait_for_end(started.id)
            assert run.status is RunStatus.FINISHED, (
                f"a robot without faults finishes: {run.result}"
            )
            self._done += 1
            if self._done % self._every == 0:
                self.footprints.append(footprint(self._service, self._done))


async def watch(url: str, name: str) -> None:
    """A helper who is there all the time, and reads all that comes."""
    address = f"{url.replace('http', 'ws', 1)}/ws/helper?helper={name}"
    async for socket in connect(address, max_size=None):
        with suppress(ConnectionClosed):
            async for _ in socket:
                pass


async def measure(
    folder: Path, runs: int, at_a_time: int, helpers: int, world: str
) -> list[Footprint]:
    """The footprints of a service's process, at as many moments as there are."""
    service = ServiceProcess(
        folder, MEND_SPEECH_VOICE="none", MEND_SPEECH_RECOGNITION="false",
        MEND_LIMITS__RUNNING_RUNS=str(at_a_time + 1),
    )  # fmt: skip
    await service.start()
    live = world == LIVE
    names = [f"robot-{number}" for number in range(at_a_time)] if live else []
    asked: list[dict[str, Any]] = [{"world": LIVE, "robots": [name]} for name in names]
    try:
        async with MendClient(service.url) as client, asyncio.TaskGroup() as group:
            work = [RobotKeeper(name, service.url, folder, "", 0.0).keep() for name in names]
            work += [watch(service.url, f"helper-{number}") for number in range(helpers)]
            beside = [group.create_task(each) for each in work]
            await _connected(client, set(names))
            starter = Starter(service, runs, client)
            asked = asked or [{"world": world, "speed": "max"}] * at_a_time
            await asyncio.gather(*(starter.keep_busy(each) for each in asked))
            for task in beside:
                task.cancel()
        return starter.footprints
    finally:
        await service.stop()


async def _connected(client: MendClient, names: set[str]) -> None:
    async with asyncio.timeout(PATIENCE_S):
        while not names <= {  # noqa: ASYNC110 - nobody tells who is connected
            each.robot for each in await client.robots() if each.connected
        }:
            await asyncio.sleep(0.1)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=10_000)
    parser.add_argument("--at-a-time", type=int, default=6)
    parser.add_argument("--helpers", type=int, default=3)
    parser.add_argument("--world", choices=(LIVE, "tabletop"), default=LIVE)
    parser.add_argument("--quick", action="store_true", help="a smoke run")
    told = parser.parse_args()
    runs = 60 if told.quick else told.runs
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        found = asyncio.run(measure(Path(folder), runs, told.at_a_time, told.helpers, told.world))
    print(*found, sep="\n")
    early, late = found[len(found) // 10], found[-1]
    grown = late.rss_mb - early.rss_mb
    print(
        f"{late.runs} runs in {time.monotonic() - began:.0f} s; from {early.runs} to {late.runs} "
        f"runs the process grew by {grown:+.1f} MB, "
        f"{grown / (late.runs - early.runs) * 1e3:+.1f} kB a run"
    )


if __name__ == "__main__":
    main()
