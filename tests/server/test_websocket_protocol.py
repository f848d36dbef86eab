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

from mend.server.websocket_protocol import READ_BYTES, WebSocketProtocol

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
    endpoint: Callable[[WebSocket], Awaitable[None]], **settings: Any
) -> AsyncIterator[tuple[WebSocketProtocol, asyncio.StreamWriter]]:
    """The server's end of the only connection, after the handshake, and the client's."""
    async with server_with(endpoint, **settings) as (server, listening):
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
    # What uvicorn logs is not passed on once anything has configured it.
    logger = logging.getLogger("uvicorn.error")
    async with server_with(refuse, log_config=None, log_level=None) as (server, listening):
        logger.addHandler(caplog.handler)
        reader, writer = await asyncio.open_connection(*listening.getsockname())
        writer.write(HELLO)
        async with asyncio.timeout(IN_TIME_S):
            answer = await reader.read()
        writer.close()
        await server.shutdown(sockets=[listening])
        logger.removeHandler(caplog.handler)
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


class Timer:
    """A callback of a stopped loop."""

    def __init__(self, due_s: float, callback: Callable[[], None]) -> None:
        self.due_s = due_s
        self.callback = callback
        self.is_cancelled = False

    def cancel(self) -> None:
        self.is_cancelled = True


class StoppedLoop:
    """A loop of which only the time and the timers matter, and which goes on when it is told."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self._timers: list[Timer] = []

    def time(self) -> float:
        return self.now_s

    def call_later(self, delay_s: float, callback: Callable[[], None]) -> Timer:
        self._timers.append(Timer(self.now_s + delay_s, callback))
        return self._timers[-1]

    def go_on_at(self, now_s: float) -> None:
        """Go on at a time, as if there had been no turn since the last."""
        self.now_s = now_s
        due = [each for each in self._timers if each.due_s <= now_s]
        self._timers = [each for each in self._timers if each.due_s > now_s]
        for timer in due:
            if not timer.is_cancelled:
                timer.callback()


@asynccontextmanager
async def pinged_client() -> AsyncIterator[tuple[WebSocketProtocol, asyncio.StreamWriter]]:
    """As `one_client`; at second 0 of a stopped loop it was asked whether it is there."""
    async with one_client(wait, ws_ping_interval=20.0, ws_ping_timeout=20.0) as (server, client):
        server.stop_keepalive()
        running, server.loop = server.loop, StoppedLoop()  # type: ignore[assignment]
        server.send_keepalive_ping()
        yield server, client
        server.stop_keepalive()
        server.loop = running


def go_on_at(connection: WebSocketProtocol, now_s: float) -> bool:
    """Let the loop of a connection go on; whether the connection is still there then."""
    assert isinstance(connection.loop, StoppedLoop)
    connection.loop.go_on_at(now_s)
    return not connection.transport.is_closing()


async def test_a_client_that_answers_no_ping_is_ended() -> None:
    async with pinged_client() as (connection, _):
        assert [go_on_at(connection, now_s) for now_s in (19.0, 20.5)] == [True, False]


async def test_a_client_that_answers_a_ping_stays() -> None:
    async with pinged_client() as (connection, client):
        assert connection.pending_ping_payload is not None
        pong = Frame(Opcode.PONG, connection.pending_ping_payload)
        client.write(pong.serialize(mask=True))
        async with asyncio.timeout(IN_TIME_S):
            while connection.pending_ping_payload is not None:  # noqa: ASYNC110
                await asyncio.sleep(0)
        assert go_on_at(connection, 20.5)


async def test_a_pong_that_came_while_the_service_stood_still_is_waited_for() -> None:
    async with pinged_client() as (connection, _):
        assert [go_on_at(connection, now_s) for now_s in (65.0, 85.0)] == [True, False]
