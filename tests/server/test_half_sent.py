"""Requests whose body is still coming when something else happens."""

import json
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest
from people import People
from service_under_test import TOKEN, ServiceUnderTest, build

from mend.server.access.principals_file import read_principals
from mend.server.access.roles import Role

Receive = Callable[[], Awaitable[Any]]


async def answer_to(
    service: ServiceUnderTest, path: str, receive: Receive, *headers: tuple[bytes, bytes]
) -> tuple[int, bytes]:
    """The status and body of the answer to a POST whose body `receive` gives."""
    sent: list[Any] = []

    async def send(message: Any) -> None:
        sent.append(message)

    scope = {
        "type": "http",
        "method": "POST",
        "path": path,
        "raw_path": path.encode(),
        "headers": [(b"host", b"localhost"), *headers],
        "query_string": b"",
        "http_version": "1.1",
        "scheme": "http",
        "root_path": "",
        "server": ("localhost", 80),
        "client": ("localhost", 1),
    }
    await service.app(scope, receive, send)
    return sent[0]["status"], sent[1]["body"]


@pytest.mark.parametrize("late", [True, False])
async def test_what_was_half_sent_before_a_revocation_is_not_done_after_it(
    tmp_path: Path, late: bool
) -> None:
    people = People(tmp_path)
    service = build(principals=people.file, token=TOKEN)
    body = json.dumps({"name": "sleeper", "role": "admin"}).encode()
    parts = [body[:-1], body[-1:]]

    async def receive() -> Any:
        part = parts.pop(0)
        if late and not parts:
            people.revoke(Role.ADMIN)
        return {"type": "http.request", "body": part, "more_body": bool(parts)}

    authorization = b"authorization", f"Bearer {people.tokens[Role.ADMIN]}".encode()
    status, _ = await answer_to(
        service, "/api/access/principals", receive,
        authorization, (b"content-type", b"application/json"),
    )  # fmt: skip
    assert status == (401 if late else 201)
    assert (read_principals(people.file).named("sleeper") is None) == late
    service.journal.close()
