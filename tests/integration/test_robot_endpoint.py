"""Who may open `/ws/robot`, and what happens to frames that are no messages."""

import json
import time
from collections.abc import AsyncIterator

import pytest
from loopback import served
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidStatus

from mend.server.journal.sqlite import SqliteJournal
from mend.server.robots.registry import RobotRegistry
from mend.server.websocket_protocol import TOO_BIG

RIGHT = {"Authorization": "Bearer secret"}


@pytest.fixture
async def url() -> AsyncIterator[str]:
    journal = SqliteJournal(":memory:")
    registry = RobotRegistry(journal, time.monotonic)
    async with served(registry, "secret") as url:
        yield url
    journal.close()


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({}, 401),
        ({"Authorization": "Bearer wrong"}, 401),
        ({"Authorization": "Bearer"}, 401),
        ({"Authorization": "Basic secret"}, 401),
        (RIGHT | {"Origin": "https://evil.example"}, 403),
    ],
)
async def test_who_is_not_to_connect_is_refused_before_the_socket_opens(
    url: str, headers: dict[str, str], status: int
) -> None:
    with pytest.raises(InvalidStatus) as refused:
        await connect(url, additional_headers=headers)
    assert refused.value.response.status_code == status


async def test_who_has_the_token_is_heard(url: str) -> None:
    async with connect(url, additional_headers=RIGHT) as socket:
        await socket.send("{}")
        assert json.loads(await socket.recv())["type"] == "error"


async def test_a_binary_frame_is_answered_like_any_mistake(url: str) -> None:
    async with connect(url, additional_headers=RIGHT) as socket:
        await socket.send(b"\xff\x00")
        assert json.loads(await socket.recv())["type"] == "error"


async def test_a_message_that_is_just_not_too_big_is_read(url: str) -> None:
    async with connect(url, additional_headers=RIGHT) as socket:
        await socket.send("x" * (1 << 20))
        assert "a hello may have" in json.loads(await socket.recv())["detail"]


async def test_a_message_that_is_too_big_ends_the_connection(url: str) -> None:
    async with connect(url, additional_headers=RIGHT) as socket:
        await socket.send("x" * ((1 << 20) + 1))
        with pytest.raises(ConnectionClosed):
            await socket.recv()
        assert socket.close_code == TOO_BIG
