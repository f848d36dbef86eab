"""What a service does with trees of 100,000 nodes: how its loop stands still, what helpers get.

A service in a process of its own keeps a tree, gives it out, starts a run of it (tabletop, nobody
is robbed, one leaf needs a hand), lets helpers in and is answered. Of each call: processor seconds
of the service and of the process that checks for it, seconds until it is answered, what the longest
callback of the service's loop took of the processor, and how late a task in that loop was that
wants to run every 5 ms, beside the same in a process with nothing to do. Of each helper: seconds
until its first picture, and the bytes of it. The naive way in the same run is to check in the loop.

    python benchmarks/large_trees.py [--nodes 100000] [--helpers 5] [--shape wide|mixed] [--quick]
"""

# ruff: noqa: T201
import argparse
import asyncio
import json
import multiprocessing
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, TypeVar

import httpx
import psutil
from websockets.asyncio.client import ClientConnection, connect

from mend.garbage import settle_garbage
from mend.server.composition import open_service
from mend.server.document_checks import TreeChecker
from mend.server.documents import DocumentView
from mend.server.fixed_documents import GivenFiles, fixed_documents
from mend.server.rendered import Rendered
from mend.server.scene_checks import load_world_checks
from mend.server.settings import Settings

PROBE_S = 0.005
PATIENCE_S = 600.0
STOP_S = 10.0

T = TypeVar("T")


# --- The trees ------------------------------------------------------------------------------------


def wide_tree(nodes: int) -> str:
    """Everything at once: THEN of two ORs, each with half of the leaves as alternatives."""
    half = (nodes - 3) // 2
    lines = ["name: large", "tree:", "  then:"]
    for part in ("green_leg", "yellow_bar"):
        lines.append("  - or:")
        lines += [f"    - {_leaf(part, needs_help=part == 'green_leg')}"] * half
    return "\n".join(lines)


def mixed_tree(nodes: int) -> str:
    """OR of many THENs, each of a leaf and of two in any order."""
    first = _leaf("green_leg", needs_help=True)
    bars = ", ".join(_leaf(part, needs_help=False) for part in ("pink_bar", "yellow_bar"))
    ways = [f"  - then: [{first}, {{and: [{bars}]}}]"] * ((nodes - 1) // 5)
    return "\n".join(["name: large", "tree:", "  or:", *ways])


def _leaf(part: str, *, needs_help: bool) -> str:
    more = ", needs_help: true" if needs_help else ""
    return f"{{behavior: pick_and_place, object: {part}, place: {part}{more}}}"


SHAPES: dict[str, Callable[[int], str]] = {"wide": wide_tree, "mixed": mixed_tree}


# --- The service ----------------------------------------------------------------------------------


class LoopProbe:
    """What keeps a loop: a task in it that wants to run every 5 ms, and each of its callbacks.

    `longest_s` is how late that task was, and `longest_cpu_s` what one callback took of the
    processor, those of the simulated robot left out.
    """

    def __init__(self) -> None:
        self.longest_s = self.longest_cpu_s = 0.0
        self.longest_of = ""

    def reset(self) -> None:
        self.longest_s = self.longest_cpu_s = 0.0
        self.longest_of = ""

    async def run(self) -> None:
        before = time.perf_counter()
        while True:
            await asyncio.sleep(PROBE_S)
            now = time.perf_counter()
            self.longest_s = max(self.longest_s, now - before - PROBE_S)
            before = now

    def watch_callbacks(self) -> None:
        """Measure every callback of the loops of this process from now on."""
        run = asyncio.Handle._run

        def measured(handle: asyncio.Handle) -> None:
            began = time.thread_time()
            run(handle)
            taken_s = time.thread_time() - began
            if taken_s > self.longest_cpu_s:
                self.longest_cpu_s, self.longest_of = taken_s, _called(handle)

        setattr(asyncio.Handle, "_run", measured)  # noqa: B010


def _called(handle: asyncio.Handle) -> str:
    """What a callback is called; of a step of a task what that task does."""
    callback: Any = vars(type(handle)).get("_callback")
    callback = callback.__get__(handle) if callback is not None else None
    task = getattr(callback, "__self__", None)
    if isinstance(task, asyncio.Task):
        callback = task.get_coro()
    return str(getattr(callback, "__qualname__", ""))


def probe_idle_loop(pipe: Connection) -> None:
    """The same in a process that has nothing else to do: what the machine itself is late by."""
    asyncio.run(_probe(LoopProbe(), pipe))


async def _probe(probe: LoopProbe, pipe: Connection) -> None:
    probing = asyncio.create_task(probe.run())
    while await asyncio.to_thread(pipe.recv) == "longest":
        pipe.send((probe.longest_s, probe.longest_cpu_s, probe.longest_of))
        probe.reset()
    probing.cancel()


def serve_in_process(folder: Path, pipe: Connection) -> None:
    asyncio.run(_serve(folder, pipe))


async def _serve(folder: Path, pipe: Connection) -> None:
    settings = Settings(
        port=0, data_dir=folder, journal=folder / "journal.db", speech_voice="none",
        log_level="error", speech_recognition=False,
    )  # fmt: skip
    probe = LoopProbe()
    probe.watch_callbacks()
    async with open_service(settings) as service:
        settle_garbage()
        pipe.send(service.url)
        await _probe(probe, pipe)


# --- The calls ------------------------------------------------------------------------------------


class Watched:
    """The service's process as seen from here, and one whose loop has nothing to do."""

    def __init__(self, pid: int, pipe: Connection, idle: Connection) -> None:
        self._process = psutil.Process(pid)
        self._pipe = pipe
        self._idle = idle
        self.worst_cpu_s = 0.0

    def _longest(self, pipe: Connection) -> tuple[float, float, str]:
        pipe.send("longest")
        longest: tuple[float, float, str] = pipe.recv()
        return longest

    def _used_s(self) -> tuple[float, float]:
        children = sum(_cpu_s(each) for each in self._process.children(recursive=True))
        return _cpu_s(self._process), children

    @contextmanager
    def measured(self, name: str) -> Iterator[None]:
        """Print what a call cost."""
        self._longest(self._pipe)
        self._longest(self._idle)
        own, checking = self._used_s()
        began = time.perf_counter()
        yield
        wall_s = time.perf_counter() - began
        own_after, checking_after = self._used_s()
        late_s, cpu_s, called = self._longest(self._pipe)
        idle_s, _, _ = self._longest(self._idle)
        self.worst_cpu_s = max(self.worst_cpu_s, cpu_s)
        print(
            f"{name:<38}{own_after - own:8.2f}{checking_after - checking:10.2f}{wall_s:8.2f}"
            f"{cpu_s * 1e3:14.0f}{late_s * 1e3:9.0f}{idle_s * 1e3:9.0f}  {called[:40]}",
            flush=True,
        )


def _cpu_s(process: psutil.Process) -> float:
    try:
        times = process.cpu_times()
    except psutil.NoSuchProcess:
        return 0.0
    return float(times.user + times.system)


class Helper:
    """One helper; `open_ask` is the question that waits."""

    def __init__(self, address: str) -> None:
        self._address = address
        self.first_s = 0.0
        self.first_bytes = 0
        self.all_bytes = 0
        self.messages: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
        self._socket: ClientConnection | None = None

    async def run(self, ready: asyncio.Event) -> None:
        began = time.perf_counter()
        async with connect(self._address, max_size=None, compression=None) as socket:
            self._socket = socket
            text = await socket.recv(decode=False)
            self.first_s = time.perf_counter() - began
            self.first_bytes = self.all_bytes = len(text)
            self.messages.put_nowait(json.loads(text))
            ready.set()
            async for more in socket:
                self.all_bytes += len(more)
                self.messages.put_nowait(json.loads(more))

    async def answer(self, dialogue: str, prompt: str) -> None:
        assert self._socket is not None, "it is connected"
        said = {"type": "answer", "dialogue": dialogue, "prompt": prompt, "answer": "yes"}
        await self._socket.send(json.dumps(said | {"id": 1}))


async def _wait_for(helper: Helper, wanted: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
    async with asyncio.timeout(PATIENCE_S):
        while True:
            message = await helper.messages.get()
            if wanted(message):
                return message


async def _measure(url: str, watched: Watched, arguments: argparse.Namespace) -> None:
    text = SHAPES[arguments.shape](arguments.nodes)
    print(f"the file has {len(text) / 1e6:.1f} MB")
    ws = url.replace("http", "ws", 1)
    async with httpx.AsyncClient(base_url=url, timeout=PATIENCE_S) as client:
        yaml = {"content-type": "application/yaml"}
        (await client.get("/readyz")).raise_for_status()
        if not arguments.quick:
            with watched.measured("check"):
                answer = await client.post("/api/trees/check", content=text, headers=yaml)
                answer.raise_for_status()
            with watched.measured("upload, as JSON"):
                body = json.dumps({"text": text})
                kind = {"content-type": "application/json"}
                (await client.post("/api/trees", content=body, headers=kind)).raise_for_status()
            with watched.measured("GET the tree"):
                answer = await client.get("/api/trees/large")
                answer.raise_for_status()
            print(f"  (its answer has {len(answer.content) / 1e6:.1f} MB)")
        with watched.measured("upload"):
            (await client.post("/api/trees", content=text, headers=yaml)).raise_for_status()
        early = Helper(f"{ws}/ws/helper?helper=early")
        ready = asyncio.Event()
        tasks = [asyncio.create_task(early.run(ready))]
        await ready.wait()
        request = {"tree": "large", "world": "tabletop", "speed": 1.0, "seed": 1,
                   "answers": "live"}  # fmt: skip
        with watched.measured("start a run"):
            answer = await client.post("/api/runs", json=request)
            assert answer.status_code == 201, answer.text[:500]
        run = answer.json()["id"]
        helpers = [Helper(f"{ws}/ws/helper?helper=h{n}") for n in range(arguments.helpers)]
        with watched.measured(f"{arguments.helpers} helpers connect"):
            events = [asyncio.Event() for _ in helpers]
            tasks += [
                asyncio.create_task(helper.run(ready))
                for helper, ready in zip(helpers, events, strict=True)
            ]
            await asyncio.gather(*(ready.wait() for ready in events))
        worst = max(each.first_s for each in helpers)
        print(f"  (first picture within {worst:.2f} s, {helpers[0].first_bytes / 1e6:.3f} MB each)")
        with watched.measured("GET the run"):
            answer = await client.get(f"/api/runs/{run}")
            answer.raise_for_status()
        print(f"  (its answer has {len(answer.content) / 1e6:.1f} MB)")
        with watched.measured("GET its events"):
            answer = await client.get(f"/api/runs/{run}/events?limit=100")
            answer.raise_for_status()
        print(f"  (its answer has {len(answer.content) / 1e6:.1f} MB)")
        with watched.measured("its first leaf, up to the question"):
            ask = await _wait_for(early, lambda m: m["type"] == "prompt" and m["kind"] == "ask")
        with watched.measured("an answer, until the next leaf starts"):
            await helpers[0].answer(ask["dialogue"], ask["prompt"])
            await _wait_for(early, lambda m: m["type"] == "node_done")
            await _wait_for(early, lambda m: m["type"] == "node_started")
        with watched.measured("a helper comes back with `after`"):
            again = Helper(f"{ws}/ws/helper?helper=early2&after={ask['seq']}")
            ready = asyncio.Event()
            tasks.append(asyncio.create_task(again.run(ready)))
            await ready.wait()
        with watched.measured("pause and resume"):
            (await client.post(f"/api/runs/{run}/pause")).raise_for_status()
            (await client.post(f"/api/runs/{run}/resume")).raise_for_status()
        with watched.measured("abort"):
            (await client.post(f"/api/runs/{run}/abort")).raise_for_status()
        with watched.measured("GET the run that has ended"):
            (await client.get(f"/api/runs/{run}")).raise_for_status()
        print(f"bytes to the helper who saw it all: {early.all_bytes / 1e6:.2f} MB")
        print(f"longest callback of the loop: {watched.worst_cpu_s * 1e3:.0f} ms of the processor")
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


def check_at_once(text: str) -> float:
    """The naive way: processor seconds for which a loop that checks a tree itself is held up."""
    checker = TreeChecker(fixed_documents(GivenFiles(), None), load_world_checks())
    began = time.thread_time()
    checked = checker.try_in_worlds(text, {})
    Rendered.of(
        DocumentView(name="large", built_in=False, text=text, definition=checked.definition)
    )
    return time.thread_time() - began


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--nodes", type=int, default=100_000)
    parser.add_argument("--helpers", type=int, default=5)
    parser.add_argument("--quick", action="store_true", help="upload once, and read nothing back")
    parser.add_argument("--shape", choices=sorted(SHAPES), default="wide")
    arguments = parser.parse_args()
    context = multiprocessing.get_context("spawn")
    pipe, theirs = context.Pipe()
    idle, theirs_too = context.Pipe()
    with tempfile.TemporaryDirectory(dir=Path.cwd()) as folder:
        processes = [
            context.Process(target=serve_in_process, args=(Path(folder), theirs)),
            context.Process(target=probe_idle_loop, args=(theirs_too,)),
        ]
        for process in processes:
            process.start()
        try:
            url = pipe.recv()
            print(
                f"{'':<38}{'CPU s':>26}{'longest in the loop, ms':>31}\n{'call':<38}{'service':>8}"
                f"{'checking':>10}{'wall s':>8}{'callback, CPU':>14}{'late':>9}{'idle one':>9}"
            )
            watched = Watched(processes[0].pid or 0, pipe, idle)
            asyncio.run(_measure(url, watched, arguments))
            for each in (pipe, idle):
                each.send("stop")
            if not arguments.quick:
                naive_s = check_at_once(SHAPES[arguments.shape](arguments.nodes))
                print(
                    f"a loop that checks it itself: held up for {naive_s * 1e3:,.0f} ms, "
                    f"{naive_s / watched.worst_cpu_s:.0f} x"
                )
            processes[0].join(STOP_S)
        finally:
            for process in processes:
                process.kill()


if __name__ == "__main__":
    main()
