"""From a fault to the question at every helper, on the whole service.

Runs of the paper's scenario on the tabletop at real-time speed. Helpers are WebSockets in a process
of their own, one of which never reads; with `--browser` one of them is a real console too. Printed
is the time from the moment at which the fault was detected (the event's wall time) to the arrival
of the dialogue's first prompt, to the frame in which a console's card shows the question, and gaps
in what the helpers received. The naive way, in the same run, is a helper that asks for the open
dialogues every second.

    python benchmarks/fault_to_prompt.py [--helpers 200] [--runs 20] [--seconds 60] [--quick]
    python benchmarks/fault_to_prompt.py --browser      (20 helpers, one run at a time)
"""

# ruff: noqa: T201
import argparse
import asyncio
import contextlib
import json
import multiprocessing
import shutil
import tempfile
import time
from collections.abc import AsyncIterator, Mapping, Sequence
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from pathlib import Path

import httpx
import numpy as np
from playwright.async_api import Page, async_playwright
from websockets.asyncio.client import connect

from mend.server.composition import Service, open_service
from mend.server.journal.events import IssueRaised, Prompt
from mend.server.limits import Limits
from mend.server.runtime.requests import RunRequest
from mend.server.settings import Settings

POLL_PERIOD_S = 1.0

# Notes when each question is first drawn: after the frame in which its heading stands on the page.
WATCH = """
window.drawn = {};
const note = () => {
  const heading = document.querySelector("article.question h2");
  const dialogue = heading?.id.replace("question-", "");
  if (dialogue === undefined || dialogue in window.drawn) return;
  window.drawn[dialogue] = null;
  requestAnimationFrame(() => setTimeout(() => { window.drawn[dialogue] = Date.now() / 1000; }));
};
new MutationObserver(note).observe(document, { childList: true, subtree: true, attributes: true });
"""

Times = dict[str, float]
"""Of each dialogue: when it was first noticed, as seconds since the epoch."""


@dataclass
class Heard:
    """What the helpers heard: when, how many events, and sequence numbers that were missing."""

    pushed: list[Times] = field(default_factory=list)
    polled: Times = field(default_factory=dict)
    events: int = 0
    gaps: int = 0


async def _listen(url: str, name: str, heard: Heard, until: float) -> None:
    arrived: Times = {}
    heard.pushed.append(arrived)
    last: int | None = None
    async with connect(f"{url}/ws/helper?helper={name}", max_size=None) as socket:
        while (left := until - time.time()) > 0:
            try:
                async with asyncio.timeout(left):
                    message = json.loads(await socket.recv())
            except TimeoutError:
                break
            if message["type"] == "snapshot":
                last = message["seq"]
                continue
            heard.events += 1
            heard.gaps += last is not None and message["seq"] != last + 1
            last = message["seq"]
            if message["type"] == "prompt":
                arrived.setdefault(message["dialogue"], time.time())


async def _poll(url: str, heard: Heard, until: float) -> None:
    """The naive helper."""
    async with httpx.AsyncClient(base_url=url) as client:
        while time.time() < until:
            open_now = await client.get("/api/dialogues", params={"status": "open", "limit": 200})
            for each in open_now.json():
                heard.polled.setdefault(each["dialogue"], time.time())
            await asyncio.sleep(POLL_PERIOD_S)


async def _stuck(url: str, until: float) -> None:
    async with connect(f"{url}/ws/helper?helper=stuck", max_queue=1):
        await asyncio.sleep(max(0.0, until - time.time()))


def _helpers(pipe: Connection, url: str, count: int, until: float) -> None:
    heard = Heard()
    web = url.replace("http", "ws", 1)

    async def listen() -> None:
        listening = (_listen(web, f"helper-{number}", heard, until) for number in range(count))
        await asyncio.gather(*listening, _stuck(web, until), _poll(url, heard, until))

    asyncio.run(listen())
    pipe.send(heard)


@contextlib.asynccontextmanager
async def _console(url: str) -> AsyncIterator[Page]:
    """A real console whose page notes what it draws."""
    async with async_playwright() as playwright:
        browser = await playwright.chromium.launch(
            executable_path=shutil.which("chromium") or shutil.which("google-chrome"),
            headless=True,
            args=["--no-sandbox"],
        )
        context = await browser.new_context(base_url=url)
        await context.add_init_script("localStorage.setItem('mend.helper', '\"anna\"')")
        page = await context.new_page()
        await page.add_init_script(WATCH)
        await page.goto("/")
        yield page
        await browser.close()


async def _keep_running(service: Service, seed: int, speed: float, until: float) -> None:
    """One run after the other."""
    while (left := until - time.time()) > 0:
        run = await service.runtime.start_run(
            RunRequest(tree="eket", world="tabletop", speed=speed, seed=seed, scenario="eket_paper")
        )
        try:
            async with asyncio.timeout(left):
                await service.runtime.wait_for_end(run.id)
        except TimeoutError:
            await service.runtime.abort(run.id)


async def _faults(service: Service) -> Times:
    """When the fault that opened each dialogue was detected."""
    raised: dict[tuple[object, str], float] = {}
    opened: Times = {}
    for event in await service.journal.read(0, 1_000_000):
        if isinstance(event, IssueRaised):
            raised[event.run, event.node] = event.wall_time.timestamp()
        elif isinstance(event, Prompt):
            opened.setdefault(str(event.dialogue), raised[event.run, event.node])
    return opened


async def measure(
    helpers: int, runs: int, speed: float, seconds: float, *, browser: bool
) -> tuple[Heard, Times, Times]:
    """What the helpers heard, what a console has drawn, and when the faults were detected."""
    async with contextlib.AsyncExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        limits = Limits(running_runs=runs)
        settings = Settings(port=0, data_dir=folder, log_level="warning", limits=limits)
        service = await stack.enter_async_context(open_service(settings))
        page = await stack.enter_async_context(_console(service.url)) if browser else None
        here, there = multiprocessing.Pipe()
        until = time.time() + seconds
        process = multiprocessing.get_context("spawn").Process(
            target=_helpers, args=(there, service.url, helpers, until)
        )
        process.start()
        # Nobody is asked before everybody listens.
        await asyncio.sleep(min(5.0, seconds / 4))
        async with asyncio.TaskGroup() as group:
            for seed in range(runs):
                group.create_task(_keep_running(service, seed, speed, until))
                # Runs that begin at once would also fail at once.
                await asyncio.sleep(0.2)
        heard: Heard = await asyncio.to_thread(here.recv)
        await asyncio.to_thread(process.join)
        drawn: Mapping[str, float | None] = {}
        if page is not None:
            drawn = await page.evaluate("window.drawn")
        seen = {dialogue: at for dialogue, at in drawn.items() if at is not None}
        return heard, seen, await _faults(service)


def _delays(faults: Times, noticed: Times) -> list[float]:
    return [at - faults[dialogue] for dialogue, at in noticed.items() if dialogue in faults]


def _row(name: str, seconds: Sequence[float]) -> None:
    if not seconds:
        print(f"{name:<40} nothing measured")
        return
    milliseconds = np.array(seconds) * 1e3
    p50, p95, p99 = np.percentile(milliseconds, [50, 95, 99])
    highest = milliseconds.max()
    print(f"{name:<40}{len(seconds):7}{p50:9.1f}{p95:9.1f}{p99:9.1f}{highest:9.1f}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--browser", action="store_true", help="one helper is a real console")
    parser.add_argument("--helpers", type=int)
    parser.add_argument("--runs", type=int, help="at a time")
    parser.add_argument("--seconds", type=float)
    parser.add_argument("--quick", action="store_true")
    given = parser.parse_args()
    # A card is drawn only when no other one stands before it: one run at a time, and a quick one.
    helpers, runs, speed, seconds = (20, 1, 4.0, 120.0) if given.browser else (200, 20, 1.0, 60.0)
    if given.quick:
        helpers, runs, seconds = 20, min(runs, 3), 40.0
    helpers, runs = given.helpers or helpers, given.runs or runs
    seconds = given.seconds or seconds
    heard, drawn, faults = asyncio.run(
        measure(helpers, runs, speed, seconds, browser=given.browser)
    )
    pushed = [delay for each in heard.pushed for delay in _delays(faults, each)]
    polled = _delays(faults, heard.polled)
    print(f"{helpers} helpers (and one that never reads), {runs} runs at a time, {seconds:g} s")
    print(f"{'from fault to prompt, ms':<40}{'n':>7}{'p50':>9}{'p95':>9}{'p99':>9}{'max':>9}")
    if given.browser:
        _row("drawn in a console", _delays(faults, drawn))
    _row("pushed to every helper", pushed)
    _row("polled every second", polled)
    if pushed and polled:
        print(f"ratio at p95: {np.percentile(polled, 95) / np.percentile(pushed, 95):.1f}")
    print(f"{heard.events} events received, {heard.gaps} gaps")


if __name__ == "__main__":
    main()
