"""Bodies of requests: nobody holds the service up with what they send, least of all strangers."""

import json
from collections.abc import AsyncIterator
from typing import Any

import httpx
import pytest
from service_under_test import TOKEN, ServiceUnderTest, build

from mend.server.api.mistakes import KEY_CHARS, MOST_TOLD
from mend.server.limits import Limits
from mend.server.off_loop import MUCH_CHARS

OPEN_DOORS = pytest.mark.parametrize("path", ["/api/session", "/api/robots/enrol"])
JSON = {"content-type": "application/json"}
RUN = {"tree": "eket", "world": "tabletop"}
MOST = Limits().stranger_body_bytes


@pytest.fixture
def service() -> ServiceUnderTest:
    return build(token=TOKEN)


@pytest.fixture
async def stranger(service: ServiceUnderTest) -> AsyncIterator[httpx.AsyncClient]:
    async with service.client(headers=JSON) as client:
        yield client
    service.app.state.services.off_loop.close()
    service.journal.close()


@pytest.fixture
def operator(stranger: httpx.AsyncClient) -> httpx.AsyncClient:
    stranger.headers["Authorization"] = f"Bearer {TOKEN}"
    return stranger


def unknown_keys(count: int) -> dict[str, Any]:
    return {f"k{number}": 0 for number in range(count)}


@OPEN_DOORS
async def test_what_anybody_may_send_is_short(
    service: ServiceUnderTest, stranger: httpx.AsyncClient, path: str
) -> None:
    declared = await stranger.post(path, content=b" " * (MOST + 1))
    assert declared.status_code == 413
    assert declared.json()["detail"] == f"the body is larger than {MOST // 1024} KiB"

    async def in_pieces() -> AsyncIterator[bytes]:
        for _ in range(MOST // 1024 + 1):
            yield b" " * 1024

    assert (await stranger.post(path, content=in_pieces())).status_code == 413
    assert service.refusals.counts["stranger_body_bytes"] == 2


@OPEN_DOORS
async def test_a_stranger_is_told_of_some_mistakes_and_that_there_are_more(
    stranger: httpx.AsyncClient, path: str
) -> None:
    refused = await stranger.post(path, json=unknown_keys(1000))
    assert refused.status_code == 422
    errors = refused.json()["errors"]
    assert len(errors) == MOST_TOLD + 1
    assert errors[-1] == "there are more mistakes"
    assert refused.json()["detail"] == f"more than {MOST_TOLD} things are wrong"


async def test_of_an_endless_key_the_beginning_is_told(operator: httpx.AsyncClient) -> None:
    refused = await operator.post("/api/runs", json={**RUN, "k" * 10_000: 0})
    assert refused.json()["errors"] == [f"body.{'k' * KEY_CHARS}: is not known here"]


@pytest.mark.parametrize("count", [12_000, 100_000])
async def test_a_body_of_too_many_values_is_refused_before_its_mistakes_are_sought(
    service: ServiceUnderTest, operator: httpx.AsyncClient, count: int
) -> None:
    refused = await operator.post("/api/runs", json=unknown_keys(count))
    assert refused.status_code == 413
    assert refused.json()["detail"] == "the body has too many values: it may have 11100"
    assert service.refusals.counts["body_values"] == 1


async def test_punctuation_within_a_text_is_no_value(operator: httpx.AsyncClient) -> None:
    refused = await operator.post("/api/runs", json={**RUN, "scene": ",[{" * 10_000})
    assert refused.status_code == 422


async def test_a_large_body_is_read_beside_the_loop(
    service: ServiceUnderTest, operator: httpx.AsyncClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    off_loop, read = service.app.state.services.off_loop, []

    async def run(chars: int, work: Any, *given: Any) -> Any:
        read.append(chars)
        return work(*given)

    monkeypatch.setattr(off_loop, "run", run)
    large = json.dumps({**RUN, "scene": "x" * MUCH_CHARS}).encode()
    assert (await operator.post("/api/runs", content=large)).status_code == 422
    assert (await operator.post("/api/trees", content=large)).status_code == 422
    assert read == [len(large)] * 2


async def test_an_upload_with_very_many_mistakes_is_refused_with_some(
    operator: httpx.AsyncClient,
) -> None:
    refused = await operator.post("/api/trees", json={"text": "", **unknown_keys(50_000)})
    assert refused.status_code == 422
    assert len(refused.json()["errors"]) == MOST_TOLD + 1


@pytest.mark.parametrize("body", [b"\xff" * MUCH_CHARS, b"[" * MUCH_CHARS, b"{" * MUCH_CHARS])
async def test_what_is_large_and_no_json_is_refused_as_if_it_were_small(
    operator: httpx.AsyncClient, body: bytes
) -> None:
    assert (await operator.post("/api/runs", content=body)).status_code in (400, 422)
