"""From a fault to the question on every helper's socket, on the whole service.

Runs of the paper's scenario on the tabletop at real-time speed, helpers on WebSockets in a process
of their own, one of which never reads. Printed are the time from the moment at which the fault was
detected (the event's wall time) to the arrival of the prompt, and gaps. The naive way, in the same
run, is a helper that asks for the open dialogues every second.

    python benchmarks/fault_to_prompt.py [--helpers 200] [--runs 20] [--seconds 45] [--quick]
"""

# ruff: noqa: T201
import argparse
import asyncio
import json
import multiprocessing
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import datetime
from multiprocessing.connection import Connection
from pathlib import Path

import httpx
import numpy as np
from websockets.asyncio.client import connect

from server.composition import open_service
from server.runtime.requests import RunRequest
from server.settings import Settings

POLL_PERIOD_S = 1.0


@dataclass
class Heard:
    """What the helpers heard: delays in seconds, events, and sequence numbers that were missing."""

    delays_s: list[float] = field(default_factory=list)
    polled_s: list[float] = field(default_factory=list)
    events: int = 0
    gaps: int = 0


async def _listen(url: str, name: str, heard: Heard, until: float) -> None:
    raised: dict[str, float] = {}
    last: int | None = None
    async with connect(f"{url}/ws/helper?helper={name}", max_size=None) as socket:
        while (left := until - time.time()) > 0:
            try:
                async with asyncio.timeout(left):
                    event = json.loads(await socket.recv())
            except TimeoutError:
                break
            arrived = time.time()
            if event["type"] == "snapshot":
                last = event["seq"]
                continue
            heard.events += 1
            if last is not None and event["seq"] != last + 1:
                heard.gaps += 1
            last = event["seq"]
            if event["type"] == "issue_raised":
                raised[event["run"]] = datetime.fromisoformat(event["wall_time"]).timestamp()
            elif event["type"] == "prompt" and event["run"] in raised:
                heard.delays_s.append(arrived - raised.pop(event["run"]))


async def _poll(url: str, heard: Heard, until: float) -> None:
    """The naive helper; a dialogue is as old as its first prompt."""
    known: set[str] = set()
    async with httpx.AsyncClient(base_url=url) as client:
        while time.time() < until:
            dialogues = (await client.get("/api/dialogues", params={"limit": 200})).json()
            for each in dialogues:
                if each["dialogue"] in known:
                    continue
                known.add(each["dialogue"])
                events = await client.get(f"/api/runs/{each['run']}/events", params={"limit": 500})
                opened = next(
                    event
                    for event in events.json()
                    if event["type"] == "dialogue_opened" and event["dialogue"] == each["dialogue"]
                )
                opened_at = datetime.fromisoformat(opened["wall_time"]).timestamp()
                heard.polled_s.append(time.time() - opened_at)
            await asyncio.sleep(POLL_PERIOD_S)


async def _stuck(url: str, until: float) -> None:
    async with connect(f"{url}/ws/helper?helper=stuck", max_queue=1):
        await asyncio.sleep(max(0.0, until - time.time()))


def _helpers(pipe: Connection, url: str, count: int, until: float) -> None:
    heard = Heard()
    web = url.replace("http", "ws", 1)

    async def listen() -> None:
        await asyncio.gather(
            *(_listen(web, f"helper-{i}", heard, until) for i in range(count)),
            _stuck(web, until),
            _poll(url, heard, until),
            return_exceptions=False,
        )

    asyncio.run(listen())
    pipe.send(heard)


async def measure(helpers: int, runs: int, seconds: float) -> Heard:
    with tempfile.TemporaryDirectory() as folder:
        settings = Settings(port=0, data_dir=Path(folder), log_level="warning")
        async with open_service(settings) as service:
            here, there = multiprocessing.Pipe()
            until = time.time() + seconds
            context = multiprocessing.get_context("spawn")
            process = context.Process(target=_helpers, args=(there, service.url, helpers, until))
            process.start()
            await asyncio.sleep(min(5.0, seconds / 4))
            for seed in range(runs):
                await service.runtime.start_run(
                    RunRequest(
                        tree="eket",
                        world="tabletop",
                        speed=1.0,
                        seed=seed,
                        scenario="eket_paper",
                    )
                )
                # Runs that begin at once would also fail at once.
                await asyncio.sleep(0.2)
            heard: Heard = await asyncio.to_thread(here.recv)
            await asyncio.to_thread(process.join)
    return heard


def _row(name: str, seconds: Sequence[float]) -> None:
    if not seconds:
        print(f"{name:<44} nothing measured")
        return
    milliseconds = np.array(seconds) * 1e3
    p50, p95, p99 = np.percentile(milliseconds, [50, 95, 99])
    print(f"{name:<44}{p50:9.1f}{p95:9.1f}{p99:9.1f}{milliseconds.max():9.1f}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--helpers", type=int, default=200)
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--quick", action="store_true")
    arguments = parser.parse_args()
    helpers, runs, seconds = arguments.helpers, arguments.runs, arguments.seconds
    if arguments.quick:
        helpers, runs, seconds = 20, 3, 40.0
    heard = asyncio.run(measure(helpers, runs, seconds))
    print(f"{helpers} helpers (and one that never reads), {runs} runs, {seconds:g} s")
    print(f"{'from fault to prompt, ms':<44}{'p50':>9}{'p95':>9}{'p99':>9}{'max':>9}")
    _row("pushed to every helper", heard.delays_s)
    _row("polled every second", heard.polled_s)
    if heard.delays_s and heard.polled_s:
        ratio = np.percentile(heard.polled_s, 95) / np.percentile(heard.delays_s, 95)
        print(f"ratio at p95: {ratio:.1f}")
    print(f"{heard.events} events received, {heard.gaps} gaps")


if __name__ == "__main__":
    main()
