# ruff: noqa: T201
"""SIGSTOP of a service, then of its robot, while that works in a process of its own.

Prints whether the same process of the robot still works after the service stood still, what the
journal says of that, and how long it takes until a robot that stands still itself is told of. There
is no peer: what is measured is that no healthy robot is killed.

    python benchmarks/standing_still.py [--seconds 60] [--times 1]
"""

import argparse
import asyncio
import signal
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from uuid import UUID

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

from service_process import ServiceProcess, service_process

from mend.server.client import MendClient
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest

AFTERWARDS_S = 20.0
"""Longer than a robot may be silent."""
PAUSE_S = 0.5
SLOW = 0.05

REQUEST = RunRequest.model_validate(
    {"tree": "eket", "world": "workcell", "speed": SLOW, "answers": ["yes"] * 100}
)


async def all_events(client: MendClient, run: UUID) -> Sequence[ev.Event]:
    return await client.events(run, limit=1000)


async def wait_for(client: MendClient, run: UUID, kind: type[ev.Event], after: int = 0) -> ev.Event:
    """The first event of a kind after so many."""
    while True:
        for event in (await all_events(client, run))[after:]:
            if isinstance(event, kind):
                return event
        await asyncio.sleep(PAUSE_S)


def stand_still(service: ServiceProcess, seconds: float) -> None:
    service.send(signal.SIGSTOP)
    time.sleep(seconds)
    service.send(signal.SIGCONT)


async def measure(seconds: float, times: int) -> None:
    with tempfile.TemporaryDirectory() as folder:
        async with service_process(Path(folder)) as service, MendClient(service.url) as client:
            run = (await client.start_run(REQUEST)).id
            await wait_for(client, run, ev.StepStarted)
            (before,) = service.robots()
            for _ in range(times):
                stand_still(service, seconds)
                await asyncio.sleep(AFTERWARDS_S)
                lost = sum(isinstance(e, ev.RobotLost) for e in await all_events(client, run))
                same = [each.pid for each in service.robots()] == [before.pid]
                print(
                    f"the service stood still for {seconds:g} s: the robot's process is "
                    f"{'the same' if same else 'another one'}, it was lost {lost} times"
                )
            count = len(await all_events(client, run))
            began = time.monotonic()
            before.send_signal(signal.SIGSTOP)
            told = await wait_for(client, run, ev.RobotLost, count)
            assert isinstance(told, ev.RobotLost), "it was waited for"
            print(
                f"the robot stood still: told after {time.monotonic() - began:.1f} s: {told.reason}"
            )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--times", type=int, default=1)
    arguments = parser.parse_args()
    asyncio.run(measure(arguments.seconds, arguments.times))


if __name__ == "__main__":
    main()
