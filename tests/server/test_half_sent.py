"""Requests whose body is still coming when the service stops."""

import asyncio
from typing import Any

import pytest
from service_under_test import build


@pytest.mark.parametrize(
    ("path", "kind"), [("/api/runs", b"application/json"), ("/api/trees", b"application/yaml")]
)
async def test_a_half_sent_body_is_refused_when_the_service_stops(path: str, kind: bytes) -> None:
    service = build()
    sent: list[Any] = []
    waiting = asyncio.Event()
    parts = [{"type": "http.request", "body": b"{", "more_body": True}]

    async def receive() -> Any:
        if parts:
            return parts.pop()
        waiting.set()
        await asyncio.Event().wait()

    async def send(message: Any) -> None:
        sent.append(message)

    headers = [(b"host", b"localhost"), (b"content-type", kind), (b"content-length", b"100")]
    scope = {
        "type": "http",
        "method": "POST",
        "path": path,
        "raw_path": path.encode(),
        "headers": headers,
        "query_string": b"",
        "http_version": "1.1",
        "scheme": "http",
        "root_path": "",
        "server": ("localhost", 80),
        "client": ("localhost", 1),
    }
    handling = asyncio.create_task(service.app(scope, receive, send))
    await asyncio.wait_for(waiting.wait(), timeout=60)
    handling.cancel()
    await asyncio.wait_for(handling, timeout=60)
    assert sent[0]["status"] == 503
    assert b"shutting down" in sent[1]["body"]
    service.journal.close()
