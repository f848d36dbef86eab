"""A request whose target is a whole URL is the request for its path, at the host that it names."""

import asyncio

import pytest
from service_under_test import TOKEN, serving


async def answer_to(port: int, target: str, host: str) -> bytes:
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    head = f"GET {target} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n"
    writer.write(f"{head}Authorization: Bearer {TOKEN}\r\n\r\n".encode())
    async with asyncio.timeout(20):
        answer = await reader.read()
    writer.close()
    return answer


@pytest.mark.parametrize(
    ("target", "host", "status"),
    [
        ("http://localhost:1/healthz", "localhost", 200),
        ("HTTP://localhost/api/runs?limit=1", "localhost", 200),
        ("http://localhost/api/runs?limit=0", "localhost", 422),
        ("http://localhost/nowhere", "localhost", 404),
        ("http://localhost/healthz", "evil.example", 200),
        ("http://evil.example/healthz", "localhost", 421),
        ("http://[/healthz", "localhost", 404),
    ],
)
async def test_the_url_says_what_is_wanted_and_of_which_host(
    target: str, host: str, status: int
) -> None:
    async with serving(token=TOKEN) as service:
        port = int(service.url.rpartition(":")[2])
        answer = await answer_to(port, target, host)
    assert answer.startswith(b"HTTP/1.1 %d " % status)
