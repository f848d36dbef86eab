"""How large the body of a request may be at each door, and all that come at once together."""

import asyncio
import contextlib
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any
from uuid import UUID

import httpx
import pytest
from people import People
from service_under_test import build

from mend.server.access.permissions import ENDPOINTS
from mend.server.access.roles import Role
from mend.server.api.body_sizes import (
    LARGE_BODY_BYTES,
    MODEL_BODY_BYTES,
    SHORT_BODY_BYTES,
    TAKE_LARGE_BODIES,
    TAKE_MODELS,
    most_bytes,
)

YAML = {"content-type": "application/yaml"}


def test_every_door_for_large_bodies_is_there() -> None:
    assert {each.operation for each in ENDPOINTS} >= TAKE_LARGE_BODIES | TAKE_MODELS


@pytest.mark.parametrize(
    ("method", "path", "most"),
    [
        ("POST", "/api/trees", LARGE_BODY_BYTES),
        ("PUT", "/api/scenes/bench", LARGE_BODY_BYTES),
        ("POST", "/api/scenarios/check", LARGE_BODY_BYTES),
        ("POST", "/api/runs", LARGE_BODY_BYTES),
        ("POST", f"/api/dialogues/{UUID(int=7)}/answers", SHORT_BODY_BYTES),
        ("POST", "/api/access/principals", SHORT_BODY_BYTES),
        ("PUT", "/api/models/lamp", MODEL_BODY_BYTES),
        ("PUT", "/api/robots/own_model", MODEL_BODY_BYTES),
        ("DELETE", "/api/trees/eket", SHORT_BODY_BYTES),
        ("POST", "/api/nothing/here", SHORT_BODY_BYTES),
    ],
)
def test_who_sends_no_file_sends_little(method: str, path: str, most: int) -> None:
    assert most_bytes(method, path) == most


async def test_a_long_answer_is_refused_before_it_has_come() -> None:
    service = build()
    path = f"/api/dialogues/{UUID(int=7)}/answers"
    async with service.client() as client:
        refused = await client.post(path, content=b" " * (SHORT_BODY_BYTES + 1))
    assert refused.status_code == 413
    assert refused.json()["detail"] == "the body is larger than 64 KiB"
    assert service.refusals.counts["body_bytes"] == 1
    service.journal.close()


class Slow:
    """A body that comes in two parts, the second of which is awaited for long."""

    def __init__(self, first_bytes: int) -> None:
        self._first_bytes = first_bytes
        self.half = asyncio.Event()
        self.rest = asyncio.Event()

    async def content(self) -> AsyncIterator[bytes]:
        yield b"#" * self._first_bytes
        self.half.set()
        await self.rest.wait()
        yield b"\n"


@contextlib.asynccontextmanager
async def half_sent(client: httpx.AsyncClient, size: int, role: Any) -> AsyncIterator[None]:
    slow = Slow(size)
    request = client.post("/api/trees/check", content=slow.content(), headers={**YAML, **role})
    sending = asyncio.create_task(request)
    async with asyncio.timeout(60):
        await slow.half.wait()
        yield
        slow.rest.set()
        assert (await sending).status_code in (200, 422)


async def test_bodies_that_come_at_once_have_so_much_room_together(tmp_path: Path) -> None:
    people = People(tmp_path)
    service = build(principals=people.file, limits={"incoming_bytes": 4 * SHORT_BODY_BYTES})
    operator, admin = (people.headers(role) for role in (Role.OPERATOR, Role.ADMIN))

    async def check(size: int, who: dict[str, str]) -> httpx.Response:
        return await client.post("/api/trees/check", content=b"#" * size, headers={**YAML, **who})

    async with service.client() as client:
        # All the room there is, but for what is short.
        async with half_sent(client, 5 * SHORT_BODY_BYTES, operator):
            refused = await check(3 * SHORT_BODY_BYTES, operator)
            assert (refused.status_code, refused.headers["retry-after"]) == (503, "5")
            assert "too many large bodies" in refused.json()["detail"]
            assert service.refusals.counts["incoming_bytes"] == 1
            # What is short always comes in, and so does one of each other principal.
            assert (await check(SHORT_BODY_BYTES, operator)).status_code == 200
            assert (await check(3 * SHORT_BODY_BYTES, admin)).status_code == 200
        assert (await check(3 * SHORT_BODY_BYTES, operator)).status_code == 200
    service.journal.close()
