"""A client that sends bytes as it likes, and reads when it likes."""

import asyncio
import contextlib
import json
import socket
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any

from websockets.frames import Frame, Opcode

SMALL_BUFFER_BYTES = 4096

UPGRADE = (
    "GET {path} HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: c3R1Y2tjbGllbnRzdHVjaw==\r\n{more}\r\n"
)


@dataclass(frozen=True, slots=True)
class Answer:
    """An HTTP answer; `headers` by their names in small letters."""

    status: int
    headers: dict[str, str]
    body: bytes

    @property
    def problem(self) -> Any:
        assert self.headers["content-type"] == "application/problem+json"
        return json.loads(self.body)


def text_frame(text: str) -> bytes:
    """A client's WebSocket frame."""
    return Frame(Opcode.TEXT, text.encode()).serialize(mask=True)


class RawClient:
    """One connection."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.reader = reader
        self._writer = writer

    def send(self, data: bytes) -> None:
        self._writer.write(data)

    async def drained(self) -> None:
        """Wait until little of what was sent still waits here; not for long."""
        with contextlib.suppress(TimeoutError, ConnectionError):
            async with asyncio.timeout(0.1):
                await self._writer.drain()

    async def answer(self) -> Answer:
        """The next answer, whose length has to be declared."""
        async with asyncio.timeout(60):
            head = (await self.reader.readuntil(b"\r\n\r\n")).decode()
            status, *lines = head.strip().split("\r\n")
            headers = {
                name.lower(): value.strip()
                for name, _, value in (line.partition(":") for line in lines)
            }
            body = await self.reader.readexactly(int(headers.get("content-length", 0)))
        return Answer(int(status.split()[1]), headers, body)

    async def upgraded(self, path: str, *headers: str) -> None:
        """Open a WebSocket, and read nothing that comes on it."""
        more = "".join(f"{header}\r\n" for header in headers)
        self.send(UPGRADE.format(path=path, more=more).encode())
        assert (await self.answer()).status == 101

    async def end(self) -> bytes:
        """Everything until the other side ends the connection."""
        read = b""
        async with asyncio.timeout(60):
            while True:
                try:
                    some = await self.reader.read(1 << 16)
                except ConnectionError:
                    return read
                if not some:
                    return read
                read += some


@asynccontextmanager
async def raw_client(port: int) -> AsyncIterator[RawClient]:
    """A client that takes little ahead of what it reads."""
    connection = socket.socket()
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, SMALL_BUFFER_BYTES)
    connection.setblocking(False)
    await asyncio.get_running_loop().sock_connect(connection, ("127.0.0.1", port))
    reader, writer = await asyncio.open_connection(sock=connection, limit=SMALL_BUFFER_BYTES)
    try:
        yield RawClient(reader, writer)
    finally:
        writer.transport.abort()
