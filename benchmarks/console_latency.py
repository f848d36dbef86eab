"""From a fault to the question on a helper's screen, with many consoles connected.

Runs of the paper's scenario on the tabletop at real-time speed. One helper has a real browser, the
others are plain sockets in a process of their own, one of which never reads. Printed is the time
from the moment at which the fault was detected (the event's wall time) until the browser has drawn
the card's question, and, in the same run, until the prompt arrives at the plain sockets. The naive
way, in the same run, is a page that asks for the open dialogues every second.

    python benchmarks/console_latency.py [--consoles 20] [--seconds 120] [--quick]
"""

# ruff: noqa: T201
import argparse
import asyncio
import json
import multiprocessing
import shutil
import tempfile
import time
from collections.abc import Sequence
from datetime import datetime
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np
from playwright.async_api import Page, async_playwright
from websockets.asyncio.client import connect

from server.composition import Service, open_service
from server.runtime.requests import RunRequest
from server.settings import Settings

POLL_PERIOD_S = 1.0

# Notes when each question is first drawn: after the frame in which its heading stands on the page.
WATCH = """
window.drawn = {};
const note = () => {
  const card = document.querySelector("article.question h2");
  if (card === null || card.id in window.drawn) return;
  const id = card.id;
  window.drawn[id] = 0;
  requestAnimationFrame(() => setTimeout(() => { window.drawn[id] = Date.now() / 1000; }));
};
new MutationObserver(note).observe(document, { childList: true, subtree: true, attributes: true });
"""

# The naive page, beside the real one in the same browser.
POLL = """
window.polled = {};
setInterval(async () => {
  for (const each of await (await fetch("/api/dialogues?status=open")).json()) {
    window.polled[each.dialogue] ??= Date.now() / 1000;
  }
}, %d);
"""


async def _listen(url: str, name: str, until: float) -> dict[str, float]:
    """When each dialogue's first prompt arrived."""
    arrived: dict[str, float] = {}
    async with connect(f"{url}/ws/helper?helper={name}", max_size=None) as socket:
        while (left := until - time.time()) > 0:
            try:
                async with asyncio.timeout(left):
                    event = json.loads(await socket.recv())
            except TimeoutError:
                break
            if event["type"] == "prompt":
                arrived.setdefault(event["dialogue"], time.time())
    return arrived


async def _stuck(url: str, until: float) -> dict[str, float]:
    async with connect(f"{url}/ws/helper?helper=stuck", max_queue=1):
        await asyncio.sleep(max(0.0, until - time.time()))
    return {}


def _sockets(pipe: Connection, url: str, count: int, until: float) -> None:
    web = url.replace("http", "ws", 1)

    async def listen() -> list[dict[str, float]]:
        names = [f"helper-{number}" for number in range(count)]
        return await asyncio.gather(
            *(_listen(web, name, until) for name in names), _stuck(web, until)
        )

    pipe.send(asyncio.run(listen()))


async def _open_page(playwright: Any, url: str) -> tuple[Page, Page]:
    browser = await playwright.chromium.launch(
        executable_path=shutil.which("chromium"), headless=True, args=["--no-sandbox"]
    )
    context = await browser.new_context(base_url=url)
    await context.add_init_script("localStorage.setItem('mend.helper', '\"anna\"')")
    page, naive = await context.new_page(), await context.new_page()
    await page.add_init_script(WATCH)
    await page.goto("/")
    await naive.goto("/docs")
    await naive.evaluate(POLL % round(POLL_PERIOD_S * 1000))
    await page.bring_to_front()
    return page, naive


async def _faults(service: Service) -> dict[str, float]:
    """When the fault that opened each asking dialogue was detected."""
    raised: dict[tuple[str, str], float] = {}
    opened: dict[str, float] = {}
    for event in await service.journal.read(0, 100_000):
        fields = json.loads(event.model_dump_json())
        key = (fields["run"], fields.get("node", ""))
        if fields["type"] == "issue_raised":
            raised[key] = datetime.fromisoformat(fields["wall_time"]).timestamp()
        elif fields["type"] == "prompt" and fields["kind"] == "ask":
            opened.setdefault(fields["dialogue"], raised[key])
    return opened


async def measure(
    consoles: int, seed: int, seconds: float
) -> tuple[list[float], list[float], list[float]]:
    """Delays in seconds: drawn in the browser, arrived at plain sockets, polled."""
    with tempfile.TemporaryDirectory() as folder:
        settings = Settings(port=0, data_dir=Path(folder), log_level="warning")
        async with open_service(settings) as service, async_playwright() as playwright:
            here, there = multiprocessing.Pipe()
            until = time.time() + seconds
            process = multiprocessing.get_context("spawn").Process(
                target=_sockets, args=(there, service.url, consoles - 2, until)
            )
            process.start()
            page, naive = await _open_page(playwright, service.url)
            while time.time() < until:
                # One after the other: a card is drawn when no other one stands before it.
                await _one_run(service, seed, until)
            sockets: list[dict[str, float]] = await asyncio.to_thread(here.recv)
            await asyncio.to_thread(process.join)
            drawn: dict[str, float] = await page.evaluate("window.drawn")
            polled: dict[str, float] = await naive.evaluate("window.polled")
            faults = await _faults(service)
    on_screen = {name.removeprefix("question-"): at for name, at in drawn.items() if at > 0}
    return (
        _delays(faults, on_screen),
        [delay for each in sockets for delay in _delays(faults, each)],
        _delays(faults, polled),
    )


async def _one_run(service: Service, seed: int, until: float) -> None:
    run = await service.runtime.start_run(
        RunRequest(
            tree="eket", world="tabletop", speed=4.0, seed=seed, scenario="eket_paper", answers=None
        )
    )
    try:
        async with asyncio.timeout(max(0.1, until - time.time())):
            await service.runtime.wait_for_end(run.id)
    except TimeoutError:
        await service.runtime.abort(run.id)


def _delays(faults: dict[str, float], seen: dict[str, float]) -> list[float]:
    return [at - faults[dialogue] for dialogue, at in seen.items() if dialogue in faults]


def _row(name: str, seconds: Sequence[float]) -> None:
    if not seconds:
        print(f"{name:<40} nothing measured")
        return
    milliseconds = np.array(seconds) * 1e3
    p50, p95 = np.percentile(milliseconds, [50, 95])
    print(f"{name:<40}{len(seconds):6}{p50:9.1f}{p95:9.1f}{milliseconds.max():9.1f}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--consoles", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=120.0)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--quick", action="store_true")
    arguments = parser.parse_args()
    seconds = 40.0 if arguments.quick else arguments.seconds
    drawn, arrived, polled = asyncio.run(measure(arguments.consoles, arguments.seed, seconds))
    print(f"{arguments.consoles} consoles, one of them a browser and one stuck; {seconds:g} s")
    print(f"{'from fault to question, ms':<40}{'n':>6}{'p50':>9}{'p95':>9}{'max':>9}")
    _row("drawn in the browser", drawn)
    _row("arrived at a plain socket", arrived)
    _row("polled every second by a page", polled)
    if drawn and polled:
        ratio = np.percentile(polled, 95) / np.percentile(drawn, 95)
        print(f"ratio at p95: {ratio:.1f}")


if __name__ == "__main__":
    main()
