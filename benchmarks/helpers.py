# ruff: noqa: T201
"""Latency from append to 200 WebSocket helpers under the event traffic of 20 runs, one stuck.

The service runs in this process and the helpers in another, on this machine's clock. The peer in
the same run sends to one helper after the other from one loop, as a simple broadcast would.
"""

import argparse
import asyncio
import contextlib
import json
import multiprocessing
import socket as sockets
import statistics
import tempfile
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from dataclasses import MISSING, fields
from datetime import UTC, datetime
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any
from uuid import UUID, uuid4

from fastapi import FastAPI
from starlette.websockets import WebSocket, WebSocketDisconnect
from websockets.asyncio.client import connect

from mend.server.access.access import Access
from mend.server.api import helper_socket
from mend.server.api.services import Services
from mend.server.journal.events import RunFailed
from mend.server.journal.journal import Entry
from mend.server.journal.sqlite import SqliteJournal
from mend.server.limits import Limits
from mend.server.listening import listen
from mend.server.refusals import Refusals
from mend.server.runtime.views import Snapshot
from mend.server.serving import Server, serve_config
from mend.server.settings import Settings

RUNS = 20
EVENTS_PER_RUN_S = 2.0
"""A pick and place has eight steps in about 12 s at speed 1; faults and dialogues add as much."""

EVENT_BYTES = 600

SEND_BUFFER_BYTES = 64 * 1024
"""Small, so that the stuck client's buffers fill within seconds instead of minutes."""

QUEUE = 200

Append = Callable[[RunFailed], Awaitable[object]]


UPGRADE = (
    b"GET /ws/helper?helper=stuck HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\n"
    b"Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
    b"Sec-WebSocket-Key: c3R1Y2tjbGllbnRzdHVjaw==\r\n\r\n"
)


class EmptyRuntime:
    """Enough of a runtime for a helper to be let in."""

    def __init__(self, journal: SqliteJournal) -> None:
        self._journal = journal

    async def snapshot(self, seq: int | None) -> Snapshot:
        return Snapshot(seq=self._journal.head if seq is None else seq, runs=[], dialogues=[])


class Broadcast:
    """The peer: every event is sent to one client after the other."""

    def __init__(self) -> None:
        self.clients: list[WebSocket] = []
        self.app = FastAPI()
        self.app.add_api_websocket_route("/ws/helper", self.serve)

    async def serve(self, websocket: WebSocket) -> None:
        await websocket.accept()
        await websocket.send_text('{"type": "snapshot", "seq": 0}')
        self.clients.append(websocket)
        with contextlib.suppress(WebSocketDisconnect):
            while True:
                await websocket.receive_text()

    async def send(self, text: str) -> None:
        for client in tuple(self.clients):
            try:
                await client.send_text(text)
            except (WebSocketDisconnect, RuntimeError):
                self.clients.remove(client)


def event(run: UUID) -> RunFailed:
    """An event that carries the moment of its append."""
    stamp = f"{time.monotonic():.6f}|"
    now = datetime.now(UTC)
    return RunFailed(time=0.0, wall_time=now, run=run, reason=stamp + "x" * (EVENT_BYTES - 200))


@contextlib.asynccontextmanager
async def serving(app: FastAPI) -> AsyncIterator[int]:
    """Serve an application on a free port."""
    settings = Settings(port=0, log_level="error", limits=Limits(connections=2**31 - 1))
    config = serve_config(app, settings)
    server = Server(config, settings, Refusals())
    socket = listen(settings)
    socket.setsockopt(sockets.SOL_SOCKET, sockets.SO_SNDBUF, SEND_BUFFER_BYTES)
    config.load()
    server.lifespan = config.lifespan_class(config)
    await server.startup(sockets=[socket])
    task = asyncio.create_task(server.main_loop())
    yield int(socket.getsockname()[1])
    server.should_exit = True
    await task
    await server.shutdown(sockets=[socket])


def follow_in_process(port: int, helpers: int, pipe: Connection) -> None:
    """The helpers' process: sends back every latency, and each helper's gaps."""
    asyncio.run(follow_all(port, helpers, pipe))


async def follow_all(port: int, helpers: int, pipe: Connection) -> None:
    """Follow as many helpers, and a stuck one that never reads."""
    latencies: list[float] = []
    gaps = 0
    address = f"ws://127.0.0.1:{port}/ws/helper?helper="

    async def follow(number: int, ready: asyncio.Event) -> None:
        nonlocal gaps
        async with connect(f"{address}h{number}", max_queue=None, compression=None) as socket:
            last = json.loads(await socket.recv())["seq"]
            ready.set()
            async for text in socket:
                message = json.loads(text)
                stamp, _, _ = message["reason"].partition("|")
                latencies.append(time.monotonic() - float(stamp))
                gaps += message["seq"] != last + 1
                last = message["seq"]
                if message["reason"].endswith("!"):
                    return

    async def stay_stuck() -> None:
        reader, writer = await asyncio.open_connection("127.0.0.1", port, limit=1024)
        writer.write(UPGRADE)
        await reader.readuntil(b"\r\n\r\n")
        writer.transport.pause_reading()  # type: ignore[attr-defined]
        await asyncio.sleep(3600)

    stuck = asyncio.create_task(stay_stuck())
    tasks = []
    for number in range(helpers):
        ready = asyncio.Event()
        tasks.append(asyncio.create_task(follow(number, ready)))
        await ready.wait()
    pipe.send("ready")
    await asyncio.gather(*tasks)
    stuck.cancel()
    pipe.send((latencies, gaps))


async def produce(append: Append, seconds: float) -> int:
    """The traffic of the runs, each at its own phase; the last event ends with `!`."""

    async def run(number: int) -> int:
        identity = uuid4()
        await asyncio.sleep(number / RUNS / EVENTS_PER_RUN_S)
        count = int(seconds * EVENTS_PER_RUN_S)
        began = time.monotonic()
        for index in range(count):
            await append(event(identity))
            await asyncio.sleep(max(0.0, began + (index + 1) / EVENTS_PER_RUN_S - time.monotonic()))
        return count

    counts = await asyncio.gather(*(run(number) for number in range(RUNS)))
    last = event(uuid4())
    await append(last.model_copy(update={"reason": last.reason + "!"}))
    return sum(counts) + 1


async def measure(app: FastAPI, append: Append, helpers: int, seconds: float) -> float:
    """Run helpers and producers against an application, and print what came of it.

    Returns the p95 of the latency in milliseconds.
    """
    context = multiprocessing.get_context("spawn")
    mine, theirs = context.Pipe()
    async with serving(app) as port:
        process = context.Process(target=follow_in_process, args=(port, helpers, theirs))
        process.start()
        loop = asyncio.get_running_loop()
        await loop.run_in_executor(None, mine.recv)
        sent = await produce(append, seconds)
        latencies, gaps = await loop.run_in_executor(None, mine.recv)
        process.join()
    expected = sent * helpers
    quantiles = statistics.quantiles(latencies, n=100)
    print(f"  events received   {len(latencies):,} of {expected:,}, gaps {gaps}")
    p50_ms, p95_ms = float(quantiles[49]) * 1e3, float(quantiles[94]) * 1e3
    max_ms = max(latencies) * 1e3
    print(f"  latency           p50 {p50_ms:.1f}, p95 {p95_ms:.1f}, max {max_ms:.1f} ms")
    return p95_ms


async def mend(folder: Path, helpers: int, seconds: float) -> float:
    """The service's own socket, journal and subscriptions."""
    journal = SqliteJournal(folder / "mend.db")
    app = FastAPI()
    app.include_router(helper_socket.router)
    runtime: Any = EmptyRuntime(journal)
    nothing: Any = None
    settings = Settings(subscriber_queue=QUEUE)
    access = Access(None, wall_time_s=time.time)
    used = {"runs": runtime, "journal": journal, "settings": settings, "access": access}
    needed = [each for each in fields(Services) if each.default is each.default_factory is MISSING]
    unused = {each.name: nothing for each in needed}
    app.state.services = Services(**(unused | used))
    print(f"Mend: {helpers} helpers and a stuck one, {RUNS} runs, {seconds:.0f} s")
    p95_ms = await measure(app, lambda each: journal.append(Entry(events=[each])), helpers, seconds)
    print(f"  cut off           {journal.subscribers.overflows}")
    journal.close()
    return p95_ms


async def peer(folder: Path, helpers: int, seconds: float) -> float:
    """The same journal, and a broadcast to one client after the other."""
    journal = SqliteJournal(folder / "peer.db")
    broadcast = Broadcast()
    order = asyncio.Lock()

    async def append(each: RunFailed) -> None:
        async with order:
            (numbered,) = await journal.append(Entry(events=[each]))
            await broadcast.send(numbered.model_dump_json())

    print("Broadcast to one after the other, the same clients")
    p95_ms = await measure(broadcast.app, append, helpers, seconds)
    journal.close()
    return p95_ms


def main() -> None:
    """Measure both in one run and print the ratio."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a smoke run")
    parser.add_argument("--helpers", type=int, default=200)
    parser.add_argument("--seconds", type=float, default=20.0)
    arguments = parser.parse_args()
    helpers, seconds = (20, 3.0) if arguments.quick else (arguments.helpers, arguments.seconds)
    with tempfile.TemporaryDirectory(dir=Path.cwd()) as folder:
        own_ms = asyncio.run(mend(Path(folder), helpers, seconds))
        peer_ms = asyncio.run(peer(Path(folder), helpers, seconds))
    print(f"ratio of the p95s   {peer_ms / own_ms:.1f}")


if __name__ == "__main__":
    main()
