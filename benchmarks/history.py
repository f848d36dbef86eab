"""What ended runs cost a service: its start, each helper's connect, its memory.

The journals are made for it, of one made-up run of 48 events over and over. The service is a
process of its own; its figures are those of its processor time, and of its memory once the helpers
have connected. The naive way in the same run folds every run at the start and keeps its state, over
fewer runs.

    python benchmarks/history.py [--runs 100000] [--naive 5000] [--quick]
"""

# ruff: noqa: T201
import argparse
import asyncio
import json
import multiprocessing
import tempfile
import time
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path

import psutil
from made_up_history import write_history
from websockets.asyncio.client import connect

from mend.dialogue.registry import load_scripts
from mend.server.composition import open_service
from mend.server.journal.run_index import RunPage
from mend.server.runtime.history import History
from mend.server.runtime.run_state import RunState
from mend.server.settings import Settings

HELPERS = 20


@dataclass(frozen=True, slots=True)
class Cost:
    """Processor seconds of a start, processor ms and ms of each connect, MB of memory."""

    start_s: float
    connect_ms: float
    wall_ms: float
    memory_mb: float


def serve_in_process(journal: Path, naive: bool, pipe: Connection) -> None:
    asyncio.run(_serve(journal, naive, pipe))


async def _serve(journal: Path, naive: bool, pipe: Connection) -> None:
    settings = Settings(
        port=0, data_dir=journal.parent, journal=journal, speech_voice="none", log_level="error",
        speech_recognition=False,
    )  # fmt: skip
    before = time.process_time()
    async with open_service(settings) as service:
        kept: list[RunState] = []
        if naive:
            history = History(service.journal, load_scripts())
            runs = await service.journal.index.page(RunPage(limit=2**31 - 1))
            kept = [await history.read(each.run) for each in runs]
        pipe.send((time.process_time() - before, service.url, len(kept)))
        await asyncio.to_thread(pipe.recv)


async def _connect_all(url: str) -> float:
    """Connect helpers one after the other; returns the ms of each."""
    address = f"{url.replace('http', 'ws', 1)}/ws/helper?helper=h"
    began = time.perf_counter()
    for number in range(HELPERS):
        async with connect(f"{address}{number}", max_size=None) as socket:
            assert json.loads(await socket.recv())["type"] == "snapshot"
    return (time.perf_counter() - began) / HELPERS * 1e3


def cost_of(journal: Path, *, naive: bool = False) -> Cost:
    """Start a service on a journal, connect helpers, and see what it took."""
    context = multiprocessing.get_context("spawn")
    pipe, theirs = context.Pipe()
    process = context.Process(target=serve_in_process, args=(journal, naive, theirs))
    process.start()
    start_s, url, _ = pipe.recv()
    service = psutil.Process(process.pid)
    asyncio.run(_connect_all(url))  # What is imported and compiled once counts to no helper.
    before = service.cpu_times()
    wall_ms = asyncio.run(_connect_all(url))
    after = service.cpu_times()
    memory_mb = service.memory_info().rss / 1e6
    pipe.send("stop")
    process.join()
    used_s = after.user + after.system - before.user - before.system
    return Cost(start_s, used_s / HELPERS * 1e3, wall_ms, memory_mb)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--runs", type=int, default=100_000)
    parser.add_argument("--naive", type=int, default=5000)
    parser.add_argument("--quick", action="store_true")
    arguments = parser.parse_args()
    runs, naive = (2000, 500) if arguments.quick else (arguments.runs, arguments.naive)
    print(f"{'ended runs':<34}  start, CPU s  connect, CPU ms (wall)   memory, MB")
    with tempfile.TemporaryDirectory(dir=Path.cwd()) as folder:
        for name, count in (("none", 0), ("some", naive), ("many", runs)):
            write_history(Path(folder) / f"{name}.db", count)
        _row("none", cost_of(Path(folder) / "none.db"))
        _row(f"{naive:,}", cost_of(Path(folder) / "some.db"))
        _row(f"{naive:,}, all folded and kept", cost_of(Path(folder) / "some.db", naive=True))
        _row(f"{runs:,}", cost_of(Path(folder) / "many.db"))
        size = (Path(folder) / "many.db").stat().st_size
        print(f"the journal of {runs:,} runs has {size / 1e6:,.0f} MB")


def _row(name: str, cost: Cost) -> None:
    print(
        f"{name:<34}  {cost.start_s:12.2f}  {cost.connect_ms:15.1f} ({cost.wall_ms:4.0f})"
        f"  {cost.memory_mb:12.0f}"
    )


if __name__ == "__main__":
    main()
