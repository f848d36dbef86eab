"""The Python client sends again what it does not know the end of; it is done once all the same."""

from collections.abc import AsyncIterator, Callable

import httpx
import pytest
from service_under_test import ServiceUnderTest, build

from mend.server.client import MendClient
from mend.server.client_errors import RefusedError, UnreachableError
from mend.server.client_retries import PAUSES_S
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest

REQUEST = RunRequest(tree="eket", world="tabletop", speed="max")


class LosingTransport(httpx.AsyncBaseTransport):
    """Loses the answers to the first few requests, or the requests themselves."""

    def __init__(self, service: ServiceUnderTest) -> None:
        self._inner = httpx.ASGITransport(service.app, raise_app_exceptions=False)
        self.lose_answers = 0
        self.refuse_connections = 0
        self.under_way = 0
        self.requests: list[httpx.Request] = []

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        self.requests.append(request)
        if self.refuse_connections > 0:
            self.refuse_connections -= 1
            raise httpx.ConnectError("nobody listens")
        if self.under_way > 0:
            self.under_way -= 1
            return httpx.Response(409, headers={"Retry-After": "1"})
        answer = await self._inner.handle_async_request(request)
        if self.lose_answers > 0:
            self.lose_answers -= 1
            raise httpx.ReadError("the connection was lost")
        return answer


class Bench:
    def __init__(self) -> None:
        self.service = build()
        self.pauses_s: list[float] = []
        self.client = MendClient(self.service.url, sleep=self._sleep)
        self.transport = LosingTransport(self.service)
        self.client._http = httpx.AsyncClient(base_url=self.service.url, transport=self.transport)
        self.meanwhile: Callable[[], None] = lambda: None

    async def _sleep(self, delay: float, /) -> None:
        self.pauses_s.append(delay)
        self.meanwhile()

    async def runs(self) -> int:
        found = await self.service.journal.read(0, 1000)
        return sum(isinstance(each, ev.RunStarted) for each in found)


@pytest.fixture
async def bench() -> AsyncIterator[Bench]:
    bench = Bench()
    async with bench.client:
        yield bench
    bench.service.journal.close()


async def test_a_lost_answer_starts_no_second_run(bench: Bench) -> None:
    bench.transport.lose_answers = 2
    view = await bench.client.start_run(REQUEST)
    assert [each.id for each in await bench.client.runs()] == [view.id]
    assert await bench.runs() == 1
    assert bench.pauses_s == list(PAUSES_S[:2])
    (key,) = {each.headers["idempotency-key"] for each in bench.transport.requests[:3]}
    assert key.strip('"')


async def test_it_is_tried_again_while_the_service_is_started_anew(bench: Bench) -> None:
    def restarting() -> None:
        bench.transport.refuse_connections = int(len(bench.pauses_s) == 1)

    bench.meanwhile = restarting
    bench.transport.lose_answers = 1
    await bench.client.start_run(REQUEST)
    assert await bench.runs() == 1


async def test_it_waits_for_the_first_that_is_under_way(bench: Bench) -> None:
    bench.transport.under_way = 1
    await bench.client.start_run(REQUEST)
    assert bench.pauses_s == [PAUSES_S[0]]
    assert await bench.runs() == 1


async def test_a_refusal_is_not_tried_again(bench: Bench) -> None:
    with pytest.raises(RefusedError):
        await bench.client.start_run(REQUEST.model_copy(update={"tree": "unknown"}))
    assert bench.pauses_s == []


async def test_where_nobody_listens_it_is_told_at_once(bench: Bench) -> None:
    bench.transport.refuse_connections = 1
    with pytest.raises(UnreachableError):
        await bench.client.start_run(REQUEST)
    assert bench.pauses_s == []


async def test_it_gives_up_in_the_end(bench: Bench) -> None:
    bench.transport.lose_answers = 100
    with pytest.raises(UnreachableError):
        await bench.client.start_run(REQUEST)
    assert bench.pauses_s == list(PAUSES_S)
    assert await bench.runs() == 1
