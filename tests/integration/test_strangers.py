"""Clients that have shown no token: they may not stay for ever, nor come in any number."""

import asyncio
import json
import logging
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager
from typing import Any
from urllib.parse import urlsplit

import pytest
from raw_client import RawClient, raw_client
from service_under_test import TOKEN, ServiceUnderTest, serving
from websockets.asyncio.client import connect

from mend.server.limits import LimitName, Limits

SOON = Limits(head_s=0.3, body_s=0.3)
PATIENT = {"head_s": 60.0, "body_s": 60.0}
HEAD = b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n"
RIGHT = f"Authorization: Bearer {TOKEN}\r\n".encode()


def post(path: bytes, *headers: bytes) -> bytes:
    """The head of a request with a body of 100 bytes, and the first of them."""
    kind = b"Content-Type: application/json\r\n"
    length = b"Content-Length: 100\r\n"
    start = b"POST " + path + b" HTTP/1.1\r\nHost: localhost\r\n"
    return start + kind + length + b"".join(headers) + b"\r\n{"


@asynccontextmanager
async def client_of(service: ServiceUnderTest) -> AsyncIterator[RawClient]:
    async with raw_client(urlsplit(service.url).port or 0) as client:
        yield client


@pytest.mark.parametrize("sent", [b"", b"G", HEAD, HEAD + b"X-Slow: 1"], ids=repr)
async def test_a_head_that_does_not_come_ends_the_connection(sent: bytes) -> None:
    async with serving(token=TOKEN, limits=SOON) as service, client_of(service) as client:
        client.send(sent)
        answer = await client.answer()
        assert answer.status == 408
        assert answer.problem["detail"] == "no request came within 0.3 s"
        assert answer.headers["connection"] == "close"
        assert await client.end() == b""
        await service.left_alone()
        assert service.refusals.counts["head_s"] == 1


async def test_a_head_that_comes_byte_by_byte_gets_no_more_time() -> None:
    async with serving(token=TOKEN, limits=SOON) as service, client_of(service) as client:

        async def drip() -> None:
            while True:
                client.send(b"x")
                await asyncio.sleep(0.02)

        client.send(HEAD + b"X-Slow: ")
        dripping = asyncio.create_task(drip())
        assert (await client.answer()).status == 408
        dripping.cancel()


async def test_the_next_request_of_a_connection_has_its_time_too() -> None:
    async with serving(token=TOKEN, limits=SOON) as service, client_of(service) as client:
        client.send(HEAD + b"\r\n")
        assert (await client.answer()).status == 200
        client.send(HEAD)
        assert (await client.answer()).status == 408
        assert await client.end() == b""


@pytest.mark.parametrize("path", [b"/api/runs", b"/api/trees", b"/api/session"])
async def test_a_body_that_does_not_come_ends_the_connection(
    path: bytes, caplog: pytest.LogCaptureFixture
) -> None:
    async with serving(token=TOKEN, limits=SOON) as service, client_of(service) as client:
        client.send(post(path, RIGHT))
        answer = await client.answer()
        assert answer.status == 408
        assert answer.problem["detail"] == "the request's body did not come within 0.3 s"
        assert await client.end() == b""
        await service.left_alone()
        assert service.journal.head == 0
    assert [each for each in caplog.records if each.levelno >= logging.ERROR] == []


async def test_a_refused_request_need_not_be_sent_to_its_end() -> None:
    async with serving(token=TOKEN, limits=SOON) as service, client_of(service) as client:
        client.send(post(b"/api/runs"))
        assert (await client.answer()).status == 401

        async def drip() -> None:
            while True:
                client.send(b" ")
                await asyncio.sleep(0.02)

        dripping = asyncio.create_task(drip())
        await client.end()
        dripping.cancel()
        await service.left_alone()
        assert service.refusals.counts["body_s"] == 1


async def test_what_is_no_http_is_refused_with_a_problem() -> None:
    async with serving(limits=SOON) as service, client_of(service) as client:
        client.send(b"\x16\x03\x01\x02\x00\x01\x00\r\n\r\n")
        answer = await client.answer()
        assert answer.status == 400
        assert answer.problem["detail"] == "Invalid HTTP request received."
        assert await client.end() == b""


async def test_there_may_be_only_so_many_connections() -> None:
    limits = Limits(connections=2, **PATIENT)
    async with serving(limits=limits) as service, AsyncExitStack() as stack:
        clients = [await stack.enter_async_context(client_of(service)) for _ in range(3)]
        answer = await clients[2].answer()
        assert answer.status == 503
        assert answer.problem["detail"] == "the service has 2 connections and takes no more"
        assert service.refusals.counts["connections"] == 1


@pytest.mark.parametrize("limit", ["strangers", "strangers_per_address"])
async def test_who_shows_the_token_at_once_comes_in_however_many_wait(limit: LimitName) -> None:
    limits = Limits(**{limit: 2}, **PATIENT)
    async with serving(token=TOKEN, limits=limits) as service, AsyncExitStack() as stack:
        waiting = [await stack.enter_async_context(client_of(service)) for _ in range(2)]
        for client in waiting:
            # One that asks for what anybody may have stays a stranger, however often it asks.
            client.send(HEAD + b"\r\n")
            assert (await client.answer()).status == 200
        late = await stack.enter_async_context(client_of(service))
        late.send(b"GET /api/runs HTTP/1.1\r\nHost: localhost\r\n" + RIGHT + b"\r\n")
        assert (await late.answer()).status == 200
        assert await waiting[0].end() == b""
        assert service.refusals.counts[limit] == 1
        waiting[1].send(HEAD + b"\r\n")
        assert (await waiting[1].answer()).status == 200


async def first_message(socket: Any) -> Any:
    async with asyncio.timeout(60):
        return json.loads(await socket.recv())


async def test_websockets_that_never_show_the_token_are_strangers_until_they_are_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("mend.server.api.helper_connection.FIRST_MESSAGE_S", 1.0)
    limits = Limits(strangers_per_address=2, **PATIENT)
    async with serving(token=TOKEN, limits=limits) as service, AsyncExitStack() as stack:
        for _ in range(2):
            client = await stack.enter_async_context(client_of(service))
            await client.upgraded("/ws/helper?helper=anna")
        await stack.enter_async_context(client_of(service))
        await service.refused("strangers_per_address")
        # The others neither say anything nor answer the close frame; they just hang up.
        assert b"the first message must show the token" in await client.reader.read(100)
    # Whoever has shown it counts no more.
    async with serving(token=TOKEN, limits=limits) as service, AsyncExitStack() as stack:
        for _ in range(4):
            socket = await stack.enter_async_context(connect(f"{service.ws}?helper=anna"))
            await socket.send(json.dumps({"type": "auth", "token": TOKEN}))
            assert (await first_message(socket))["type"] == "snapshot"


async def test_what_a_stranger_says_is_short(service_with_token: ServiceUnderTest) -> None:
    long = json.dumps({"type": "ping", "id": "x" * 100_000})
    async with connect(f"{service_with_token.ws}?helper=anna") as socket, asyncio.timeout(60):
        await socket.send(long)
        await socket.wait_closed()
        assert socket.close_code == 1009
    headers = {"Authorization": f"Bearer {TOKEN}"}
    async with connect(
        f"{service_with_token.ws}?helper=anna", additional_headers=headers
    ) as socket:
        assert (await first_message(socket))["type"] == "snapshot"
        await socket.send(long)
        assert (await first_message(socket))["status"] == 413
        await socket.send("x" * (1024**2 + 1))
        await socket.wait_closed()
        assert socket.close_code == 1009
    counts = service_with_token.refusals.counts
    for limit in ("stranger_message_bytes", "helper_message_chars", "message_bytes"):
        assert counts[limit] == 1


@pytest.fixture
async def service_with_token() -> AsyncIterator[ServiceUnderTest]:
    async with serving(token=TOKEN) as service:
        yield service
