"""Clients that mean no good: slow ones, silent ones, such with wrong tokens, and hostile robots.

They come from an address of their own on this machine, as strangers would.
"""

import asyncio
import json
import secrets
import socket
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import AsyncExitStack, asynccontextmanager, suppress
from typing import Any

import numpy as np
from websockets.asyncio.client import connect
from websockets.exceptions import WebSocketException

STRANGE_ADDRESS = "127.0.0.2"

HEAD = b"POST /api/runs HTTP/1.1\r\nHost: localhost\r\n"


class Strangers:
    """What they do to the service on `port`. `credentials` are those of hostile robots."""

    def __init__(self, port: int, token: str, credentials: dict[str, str]) -> None:
        self._port = port
        self._token = token
        self._credentials = credentials

    # --- Clients ------------------------------------------------------------------------------

    @asynccontextmanager
    async def crowd(self, many: int) -> AsyncIterator[None]:
        """So many connections on which nothing is said."""
        sockets = []
        try:
            for _ in range(many):
                each = socket.socket()
                each.setblocking(False)
                each.bind((STRANGE_ADDRESS, 0))
                sockets.append(each)
                with suppress(OSError, TimeoutError):
                    async with asyncio.timeout(0.5):
                        await asyncio.get_running_loop().sock_connect(
                            each, ("127.0.0.1", self._port)
                        )
            yield
        finally:
            for each in sockets:
                each.close()

    async def half_sent(self, many: int, for_s: float) -> None:
        """Requests whose head, or whose body, ends in the middle."""
        right = f"Authorization: Bearer {self._token}\r\n".encode()
        body = b"Content-Type: application/json\r\nContent-Length: 1000\r\n\r\n{"
        with suppress(OSError):
            async with AsyncExitStack() as stack:
                for number in range(many):
                    writer = await stack.enter_async_context(self._connected())
                    writer.write(HEAD if number % 2 else HEAD + right + body)
                await asyncio.sleep(for_s)

    async def stuck(self, many: int, for_s: float) -> None:
        """Helpers who let events come, and read none."""
        key = "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: c3R1Y2tjbGllbnRzdHVjaw==\r\n"
        with suppress(OSError):
            async with AsyncExitStack() as stack:
                for number in range(many):
                    writer = await stack.enter_async_context(self._connected())
                    writer.transport.pause_reading()  # type: ignore[attr-defined]
                    writer.write(
                        f"GET /ws/helper?helper=stuck-{number}&after=0 HTTP/1.1\r\n"
                        f"Host: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n{key}"
                        f"Authorization: Bearer {self._token}\r\n\r\n".encode()
                    )
                await asyncio.sleep(for_s)

    async def wrong_tokens(self, many: int) -> None:
        """Guesses."""
        for _ in range(many):
            with suppress(OSError):
                await self._guess()

    async def _guess(self) -> None:
        async with self._connected() as writer:
            guess = f"Authorization: Bearer {secrets.token_urlsafe(16)}\r\n\r\n"
            writer.write(b"GET /api/runs HTTP/1.1\r\nHost: localhost\r\n" + guess.encode())
            await writer.drain()
            await asyncio.sleep(0.01)

    @asynccontextmanager
    async def _connected(self) -> AsyncIterator[asyncio.StreamWriter]:
        """A connection. Raises `OSError` where there is no service just now."""
        _, writer = await asyncio.open_connection(
            "127.0.0.1", self._port, local_addr=(STRANGE_ADDRESS, 0)
        )
        try:
            yield writer
        finally:
            writer.transport.abort()

    # --- Robots -------------------------------------------------------------------------------

    async def hostile_robot(self, rng: np.random.Generator, for_s: float) -> None:
        """A robot with a valid credential, which says hello and then what it should not."""
        name = str(rng.choice(sorted(self._credentials)))
        deeds: list[Callable[[Any], Awaitable[None]]] = [
            _flood_of_reports, _flood_of_heartbeats, _nonsense, _gaps, _lies_about_time,
            _many_boots, _huge, self._another_name, _says_nothing_more, _repeats_its_steps,
        ]  # fmt: skip
        deed = deeds[int(rng.integers(len(deeds)))]
        headers = {"Authorization": f"Bearer {self._credentials[name]}"}
        url = f"ws://127.0.0.1:{self._port}/ws/robot"
        with suppress(OSError, WebSocketException, TimeoutError):
            async with (
                asyncio.timeout(for_s),
                connect(url, additional_headers=headers, close_timeout=0.1) as robot,
            ):
                await robot.send(json.dumps(hello(name)))
                await deed(robot)

    async def _another_name(self, robot: Any) -> None:
        await robot.send(json.dumps(hello("arm-1")))
        url = f"ws://127.0.0.1:{self._port}/ws/robot"
        for token in self._credentials.values():
            headers = {"Authorization": f"Bearer {token}"}
            async with connect(url, additional_headers=headers, close_timeout=0.1) as other:
                await other.send(json.dumps(hello("arm-1")))
                await other.recv()


def hello(name: str) -> dict[str, Any]:
    """What a robot says first; its boot is a new one."""
    return {
        "type": "hello", "protocol": 1, "robot": name, "boot": secrets.token_hex(8),
        "behaviors": ["pick_and_place"], "cameras": ["head"], "time": 0.0,
        "reach": {"x": 0.0, "y": 0.0, "min_m": 0.2, "max_m": 1.2},
    }  # fmt: skip


def report(seq: int, body: dict[str, Any], time: float = 0.0, **more: Any) -> str:
    return json.dumps({"type": "report", "seq": seq, "time": time, "body": body, **more})


async def _flood_of_reports(robot: Any) -> None:
    seq = 0
    while True:
        seq += 1
        body = {"type": "step_started", "execution": "none", "step": 1, "name": "above pick"}
        await robot.send(report(seq, body, time=float(seq)))
        await asyncio.sleep(0)


async def _flood_of_heartbeats(robot: Any) -> None:
    while True:
        await robot.send(json.dumps({"type": "heartbeat", "time": 1.0}))
        await asyncio.sleep(0)


async def _nonsense(robot: Any) -> None:
    deep = "[" * 100_000
    for text in ("", "null", "{}", deep, '{"type": "report"}', '{"type": "hello"}', "\x00" * 1000):
        await robot.send(text)
    await robot.send(bytes(range(256)))
    await robot.recv()


async def _gaps(robot: Any) -> None:
    for seq in (5, 2, 9, 9, 1, 2**53 - 1, 10**6):
        await robot.send(report(seq, {"type": "rejected", "command": "none", "reason": "no"}))
    await robot.recv()


async def _lies_about_time(robot: Any) -> None:
    for time in (1e300, -1e300, float("nan"), float("inf")):
        await robot.send(report(1, {"type": "finished", "execution": "none"}, time=time))
    await robot.recv()


async def _many_boots(robot: Any) -> None:
    while True:
        body = {"type": "rejected", "command": "none", "reason": "no"}
        await robot.send(report(1, body, boot=secrets.token_hex(16)))
        await asyncio.sleep(0)


async def _huge(robot: Any) -> None:
    await robot.send("x" * (3 << 20))
    await robot.recv()


async def _says_nothing_more(_: Any) -> None:
    await asyncio.sleep(60.0)


async def _repeats_its_steps(robot: Any) -> None:
    """In a run of its own: begins what it is told to do, again and again."""
    seq = 0
    while True:
        message = json.loads(await robot.recv())
        if message["type"] != "command":
            continue
        await robot.send(json.dumps({"type": "taken", "command": message["id"]}))
        for _ in range(500):
            seq += 1
            await robot.send(report(seq, _done(message["id"], message["body"]), time=float(seq)))


def _done(command: str, body: dict[str, Any]) -> dict[str, Any]:
    """What a robot could say next to a command."""
    if body["type"] == "start":
        return {"type": "step_started", "execution": body["execution"], "step": 1, "name": "lie"}
    if body["type"] == "look":
        gripper = {"x": 0.0, "y": 0.0, "z": 1.0}
        return {
            "type": "looked",
            "command": command,
            "objects": {},
            "gripper": gripper,
            "there": [],
        }
    return {"type": "holding", "execution": None, "at": "neutral"}
