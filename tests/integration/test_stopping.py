"""A service that is to end does so soon, whatever its clients have begun and not finished."""

import asyncio
import logging
from collections.abc import AsyncIterator, Iterator
from contextlib import AsyncExitStack, asynccontextmanager, contextmanager
from pathlib import Path
from urllib.parse import urlsplit

import httpx
import pytest
from raw_client import RawClient, raw_client
from service_under_test import ServiceUnderTest, serving, until

from mend.server.composition import open_service
from mend.server.journal.journal import Document, Entry
from mend.server.rendered import Rendered
from mend.server.settings import Settings

MORE_THAN_IS_BUFFERED = 32 * 1024**2
HALF = (
    "POST {path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: {kind}\r\nContent-Length: 100\r\n"
    "{more}\r\n{{"
)


@asynccontextmanager
async def faultless(caplog: pytest.LogCaptureFixture) -> AsyncIterator[ServiceUnderTest]:
    """A service that logs nothing of what its clients do, or leave undone, as its own mistake."""
    async with serving() as service:
        with heard(caplog):
            yield service
    assert errors(caplog) == []


@contextmanager
def heard(caplog: pytest.LogCaptureFixture) -> Iterator[None]:
    """While what uvicorn logs is caught, too, which it does not pass on."""
    logger = logging.getLogger("uvicorn.error")
    logger.addHandler(caplog.handler)
    try:
        yield
    finally:
        logger.removeHandler(caplog.handler)


def errors(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [each.getMessage() for each in caplog.records if each.levelno >= logging.ERROR]


@pytest.fixture
def endless_grace(monkeypatch: pytest.MonkeyPatch) -> None:
    """What would be waited for now is waited for in vain."""
    monkeypatch.setattr("mend.server.serving.GRACE_S", 3600.0)


@asynccontextmanager
async def ending(service: ServiceUnderTest) -> AsyncIterator[None]:
    """While the service ends; at the end it has."""
    async with asyncio.timeout(60):
        stopping = asyncio.create_task(service.server.shutdown())
        yield
        await stopping


def port_of(url: str) -> int:
    return urlsplit(url).port or 0


@pytest.mark.usefixtures("endless_grace")
@pytest.mark.parametrize(
    ("path", "kind", "more"),
    [
        ("/api/runs", "application/json", ""),
        ("/api/runs", "application/json", "Idempotency-Key: one\r\n"),
        ("/api/trees", "application/yaml", ""),
        ("/api/session", "application/json", ""),
    ],
)
async def test_a_half_sent_body_is_not_waited_for(
    path: str, kind: str, more: str, caplog: pytest.LogCaptureFixture
) -> None:
    async with faultless(caplog) as service, raw_client(port_of(service.url)) as client:
        client.send(HALF.format(path=path, kind=kind, more=more).encode())
        await until(lambda: len(service.server.server_state.tasks) == 1)
        async with ending(service):
            refused = await client.answer()
        assert (refused.status, refused.problem["detail"]) == (503, "the service is shutting down")


@pytest.mark.usefixtures("endless_grace")
async def test_connections_without_a_whole_head_are_not_waited_for(
    caplog: pytest.LogCaptureFixture,
) -> None:
    async with faultless(caplog) as service, AsyncExitStack() as clients:
        for begun in (b"", b"POST /api/ru", b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n"):
            client: RawClient = await clients.enter_async_context(raw_client(port_of(service.url)))
            client.send(begun)
        await until(lambda: len(service.server.visitors) == 3)
        async with ending(service):
            pass


class Large:
    """A library of which each document is longer than any buffer."""

    async def get(self, _: str) -> Rendered:
        return Rendered(dict, b"x" * MORE_THAN_IS_BUFFERED)  # type: ignore[type-var]


class Stuck:
    """A library that never answers."""

    def __init__(self) -> None:
        self.asked = asyncio.Event()

    async def get(self, _: str) -> Rendered:
        self.asked.set()
        await asyncio.Event().wait()
        raise AssertionError("nobody sets that event")


GET = b"GET /api/trees/eket HTTP/1.1\r\nHost: localhost\r\n\r\n"


async def test_who_reads_nothing_of_a_large_answer_is_not_waited_for(
    caplog: pytest.LogCaptureFixture,
) -> None:
    async with faultless(caplog) as service, raw_client(port_of(service.url)) as client:
        object.__setattr__(service.app.state.services, "trees", Large())
        client.send(GET)
        await client.reader.readuntil(b"\r\n\r\n")
        async with ending(service):
            pass
        assert len(await client.end()) < MORE_THAN_IS_BUFFERED


async def test_an_answer_that_takes_long_is_not_waited_for(
    caplog: pytest.LogCaptureFixture,
) -> None:
    async with faultless(caplog) as service, raw_client(port_of(service.url)) as client:
        library = Stuck()
        object.__setattr__(service.app.state.services, "trees", library)
        client.send(GET)
        await library.asked.wait()
        async with ending(service):
            refused = await client.answer()
        assert (refused.status, refused.problem["detail"]) == (503, "the service is shutting down")


async def test_who_hangs_up_in_the_middle_of_a_large_answer_is_no_defect(
    caplog: pytest.LogCaptureFixture,
) -> None:
    async with faultless(caplog) as service:
        object.__setattr__(service.app.state.services, "trees", Large())
        async with raw_client(port_of(service.url)) as client:
            client.send(GET)
            await client.reader.readuntil(b"\r\n\r\n")
        await until(lambda: not service.server.server_state.tasks)


@pytest.mark.slow
@pytest.mark.usefixtures("endless_grace")
async def test_checks_that_take_long_are_abandoned(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    leaf = "    - {behavior: pick_and_place, object: a, place: b}\n"
    large = "name: large\ntree:\n  and:\n" + leaf * 40_000
    settings = Settings(port=0, data_dir=tmp_path, speech_voice="none", log_level="error")
    async with AsyncExitStack() as stack, httpx.AsyncClient() as client:
        service = await stack.enter_async_context(open_service(settings))
        await service.journal.append(Entry(document=Document("tree", "large", large)))
        off_loop = service.library.off_loop
        asked = [
            asyncio.create_task(client.get(f"{service.url}/api/trees/large", timeout=60))
            for _ in range(3)
        ]
        await until(lambda: off_loop._pool is not None)
        async with asyncio.timeout(60):
            with heard(caplog):
                await stack.aclose()
            answers = await asyncio.gather(*asked)
    assert errors(caplog) == []
    assert [each.status_code for each in answers] == [503] * 3
