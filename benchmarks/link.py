# ruff: noqa: T201
"""The robot link over loopback WebSockets: round trip of one robot, durable reports of many.

    python benchmarks/link.py [--quick] [--robots 50] [--seconds 5]

A report is acknowledged after the SQLite journal has synced it. The naive way in the same run is
an echo that keeps nothing, and one commit per report.
"""

import argparse
import asyncio
import json
import sqlite3
import statistics
import tempfile
import time
from collections.abc import Awaitable, Callable
from contextlib import AbstractAsyncContextManager
from pathlib import Path

import uvicorn
from fastapi import FastAPI, WebSocket
from websockets.asyncio.client import ClientConnection, connect

from mend.robots.link.messages import Held, Hello, ReachLimits, Report
from mend.server.access.access import Access
from mend.server.api.robot_socket import add_robot_route
from mend.server.journal.sqlite import SqliteJournal
from mend.server.robots.registry import RobotRegistry
from mend.server.websocket_protocol import WebSocketProtocol

PADDING = "x" * 900
"""Makes a report about 1 KB."""


def hello(robot: str) -> str:
    reach = ReachLimits(x=0.0, y=0.0, min_m=0.1, max_m=1.0)
    return Hello(
        protocol=1, robot=robot, boot="b1", behaviors=[], cameras=[], reach=reach, time=0.0
    ).model_dump_json()


def report(seq: int) -> str:
    return Report(seq=seq, time=0.0, body=Held(command=PADDING)).model_dump_json()


async def acknowledged(socket: ClientConnection) -> int:
    """The `seq` of the next acknowledgement."""
    while True:
        message = json.loads(await socket.recv())
        if message["type"] == "ack":
            return int(message["seq"])


class Loopback(AbstractAsyncContextManager["Loopback"]):
    """The robot endpoint and an echo on a port of this machine."""

    def __init__(self, journal: SqliteJournal) -> None:
        self._registry = RobotRegistry(journal, time.monotonic)
        app = FastAPI()
        add_robot_route(app, self._registry, Access(None, wall_time_s=time.time))
        app.add_api_websocket_route("/echo", echo)
        config = uvicorn.Config(
            app, port=0, log_level="warning", ws=WebSocketProtocol, ws_ping_interval=None
        )
        self._server = uvicorn.Server(config)

    async def __aenter__(self) -> "Loopback":
        self._serving = asyncio.create_task(self._server.serve())
        while not self._server.started:  # noqa: ASYNC110 - uvicorn has no event for it
            await asyncio.sleep(0.01)
        port = self._server.servers[0].sockets[0].getsockname()[1]
        self.url = f"ws://127.0.0.1:{port}"
        return self

    async def __aexit__(self, *_: object) -> None:
        self._registry.close()
        self._server.should_exit = True
        await self._serving


async def echo(websocket: WebSocket) -> None:
    await websocket.accept()
    async for text in websocket.iter_text():
        await websocket.send_text(text)


async def round_trips(
    socket: ClientConnection, count: int, once: Callable[[int], Awaitable[object]]
) -> list[float]:
    taken = []
    for seq in range(1, count + 1):
        began = time.perf_counter()
        await socket.send(report(seq))
        await once(seq)
        taken.append((time.perf_counter() - began) * 1e3)
    return taken


def show(name: str, taken_ms: list[float]) -> float:
    cuts = statistics.quantiles(taken_ms, n=100)
    print(f"  {name:<38} p50 {cuts[49]:7.2f} ms   p99 {cuts[98]:7.2f} ms")
    return cuts[49]


async def measure_round_trip(url: str, count: int) -> None:
    print(f"round trip of one report ({count} times)")
    async with connect(f"{url}/echo", compression=None) as socket:
        plain = show(
            "echo, nothing kept", await round_trips(socket, count, lambda _: socket.recv())
        )
    async with connect(f"{url}/ws/robot", compression=None) as socket:
        await socket.send(hello("single"))
        await socket.recv()
        durable = show(
            "committed, synced and acknowledged",
            await round_trips(socket, count, lambda _: acknowledged(socket)),
        )
    print(f"  durability costs {durable / plain:.1f} x the echo\n")


async def produce(url: str, robot: str, until: float, window: int = 64) -> int:
    """Deliver reports until then, `window` on their way; returns how many were acknowledged."""
    async with connect(f"{url}/ws/robot", compression=None) as socket:
        await socket.send(hello(robot))
        await socket.recv()
        sent = done = 0
        while time.perf_counter() < until:
            while sent - done < window:
                sent += 1
                await socket.send(report(sent))
            done = await acknowledged(socket)
        return done


async def measure_throughput(url: str, robots: int, seconds: float) -> float:
    began = time.perf_counter()
    counts = await asyncio.gather(
        *(produce(url, f"robot-{n}", began + seconds) for n in range(robots))
    )
    rate = sum(counts) / (time.perf_counter() - began)
    print(f"durable reports of {robots} robots: {rate:,.0f} per second")
    return rate


def measure_naive(path: Path, seconds: float) -> float:
    """One synced commit per report, on one thread."""
    database = sqlite3.connect(path, isolation_level=None)
    database.execute("PRAGMA journal_mode=WAL")
    database.execute("PRAGMA synchronous=FULL")
    database.execute("CREATE TABLE receipts (robot TEXT, boot TEXT, seq INTEGER, text TEXT)")
    text, count, until = report(1), 0, time.perf_counter() + seconds
    while time.perf_counter() < until:
        database.execute("INSERT INTO receipts VALUES ('r', 'b', ?, ?)", (count, text))
        count += 1
    database.close()
    print(f"one commit per report, no network: {count / seconds:,.0f} per second")
    return count / seconds


async def main(robots: int, seconds: float, trips: int) -> None:
    with tempfile.TemporaryDirectory() as folder:
        journal = SqliteJournal(Path(folder) / "journal.db")
        async with Loopback(journal) as loopback:
            await measure_round_trip(loopback.url, trips)
            rate = await measure_throughput(loopback.url, robots, seconds)
        journal.close()
        naive = measure_naive(Path(folder) / "naive.db", seconds)
        print(f"ratio: {rate / naive:.2f}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--quick", action="store_true", help="a smoke run")
    parser.add_argument("--robots", type=int, default=50)
    parser.add_argument("--seconds", type=float, default=5.0)
    told = parser.parse_args()
    if told.quick:
        asyncio.run(main(5, 0.5, 100))
    else:
        asyncio.run(main(told.robots, told.seconds, 2000))
