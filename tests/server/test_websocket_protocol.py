"""A server can end whatever its clients are just doing, and reads and answers only so much."""

import asyncio
import logging
import socket
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from typing import Any

import pytest
import uvicorn
from starlette.applications import Starlette
from starlette.responses import PlainTextResponse
from starlette.routing import WebSocketRoute
from starlette.websockets import WebSocket
from uvicorn.protocols.utils import ClientDisconnected
from websockets.frames import Close, Frame, Opcode

from server.websocket_protocol import READ_BYTES, WebSocketProtocol

HELLO = (
    b"GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n"
)
MORE_THAN_IS_BUFFERED = 32 << 20
IN_TIME_S = 20.0


async def flood(websocket: WebSocket) -> None:
    await websocket.accept()
    await websocket.send_bytes(bytes(MORE_THAN_IS_BUFFERED))
    await websocket.receive()


async def wait(websocket: WebSocket) -> None:
    await websocket.accept()
    await websocket.receive()


async def refuse(websocket: WebSocket) -> None:
    await websocket.send_denial_response(PlainTextResponse("not you", 401))


async def connected(port: int) -> asyncio.StreamWriter:
    """A client that reads nothing after the handshake."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port, limit=1024)
    writer.write(HELLO)
    await reader.readuntil(b"\r\n\r\n")
    return writer


@asynccontextmanager
async def server_with(
    endpoint: Callable[[WebSocket], Awaitable[None]], **settings: Any
) -> AsyncIterator[tuple[uvicorn.Server, socket.socket]]:
    """A started server and the socket on which it listens; whoever wants it ended does that."""
    listening = socket.create_server(("127.0.0.1", 0))
    how = {"ws": WebSocketProtocol, "lifespan": "off", "log_level": "critical", **settings}
    config = uvicorn.Config(Starlette(routes=[WebSocketRoute("/", endpoint)]), **how)
    config.load()
    server = uvicorn.Server(config)
    server.lifespan = config.lifespan_class(config)
    await server.startup(sockets=[listening])
    yield server, listening


@asynccontextmanager
async def one_client(
    endpoint: Callable[[WebSocket], Awaitable[None]],
) -> AsyncIterator[tuple[WebSocketProtocol, asyncio.StreamWriter]]:
    """The server's end of the only connection, after the handshake, and the client's."""
    async with server_with(endpoint) as (server, listening):
        client = await connected(listening.getsockname()[1])
        (connection,) = server.server_state.connections
        assert isinstance(connection, WebSocketProtocol)
        yield connection, client
        client.transport.abort()
        await server.shutdown(sockets=[listening])


@pytest.mark.parametrize("closing", [False, True])
async def test_a_server_ends_while_a_client_closes_and_has_not_read_all(closing: bool) -> None:
    async with server_with(flood, timeout_graceful_shutdown=30) as (server, listening):
        clients = [await connected(listening.getsockname()[1]) for _ in range(2)]
        connections = list(server.server_state.connections)
        if closing:
            frame = Frame(Opcode.CLOSE, Close(1000, "").serialize())
            clients[0].write(frame.serialize(mask=True))
            while not any(each.transport.is_closing() for each in connections):  # noqa: ASYNC110
                await asyncio.sleep(0)
        ending = asyncio.create_task(server.shutdown(sockets=[listening]))
        while not all(each.transport.is_closing() for each in connections):
            assert not ending.done()
            await asyncio.sleep(0)
        for client in clients:
            client.transport.abort()
        await ending
    assert not server.server_state.connections


async def test_who_is_just_sending_to_a_client_that_was_sent_away_hears_that_it_is_gone() -> None:
    async with one_client(wait) as (connection, _):
        connection._pings_left, connection._pinged_at_s = 0.0, connection.loop.time()
        connection.handle_ping()
        # In the same turn of the loop: the connection is not lost yet.
        with pytest.raises(ClientDisconnected):
            await connection.send({"type": "websocket.send", "text": "late"})


async def test_a_refused_handshake_is_no_error_in_the_log(
    caplog: pytest.LogCaptureFixture,
) -> None:
    async with server_with(refuse, log_config=None, log_level=None) as (server, listening):
        reader, writer = await asyncio.open_connection(*listening.getsockname())
        writer.write(HELLO)
        async with asyncio.timeout(IN_TIME_S):
            answer = await reader.read()
        writer.close()
        await server.shutdown(sockets=[listening])
    assert answer.startswith(b"HTTP/1.1 401 ")
    assert answer.endswith(b"not you")
    assert [each.message for each in caplog.records if each.levelno >= logging.WARNING] == []


async def test_little_is_read_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[int] = []
    done = asyncio.Event()
    async with one_client(wait) as (connection, client):

        def note(data: bytes) -> None:
            read.append(len(data))
            if sum(read) == 40 * READ_BYTES:
                done.set()

        monkeypatch.setattr(connection, "data_received", note)
        client.write(bytes(40 * READ_BYTES))
        async with asyncio.timeout(IN_TIME_S):
            await done.wait()
    assert max(read) <= READ_BYTES


@pytest.mark.parametrize("full", [False, True])
async def test_a_client_for_whom_much_waits_already_gets_no_pong(
    full: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    written: list[bytes] = []
    answered = asyncio.Event()
    async with one_client(wait) as (connection, client):
        monkeypatch.setattr(connection.transport, "write", written.append)
        handle = connection.handle_ping

        def handle_ping() -> None:
            handle()
            answered.set()

        monkeypatch.setattr(connection, "handle_ping", handle_ping)
        if full:
            connection.writable.clear()
        client.write(Frame(Opcode.PING, b"are you there?").serialize(mask=True))
        async with asyncio.timeout(IN_TIME_S):
            await answered.wait()
        connection.writable.set()
        sent, late = list(written), connection.conn.data_to_send()
    pong = Frame(Opcode.PONG, b"are you there?").serialize(mask=False)
    assert sent == ([] if full else [pong])
    assert late == []


class StubLoop:
    """A loop of which only the time and the timers matter."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self.timers: list[float] = []

    def time(self) -> float:
        return self.now_s

    def call_later(self, delay_s: float, _: object) -> None:
        self.timers.append(delay_s)


def test_a_pong_that_came_while_the_service_stood_still_is_waited_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ended: list[float] = []
    loop = StubLoop()
    monkeypatch.setattr(
        WebSocketProtocol.__mro__[1], "keepalive_timeout", lambda _: ended.append(loop.now_s)
    )
    protocol = WebSocketProtocol.__new__(WebSocketProtocol)
    protocol.loop = loop
    protocol.ping_timeout = protocol._pong_within_s = 20.0
    protocol.ping_sent_at = 0.0
    loop.now_s = 65.0
    protocol.keepalive_timeout()
    assert (loop.timers, ended) == ([20.0], [])
    loop.now_s = 85.0
    protocol.keepalive_timeout()
    assert (loop.timers, ended) == ([20.0], [85.0])
