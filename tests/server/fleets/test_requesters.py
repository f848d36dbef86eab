"""Requesters ask one after the other, for so much at a time, and hold nobody else up."""

import asyncio
from threading import Event as ThreadEvent
from typing import Any

import pytest
from dispatch_office import asked, visit
from languages_of_console import untold
from test_legs_as_runs import Work, working

from mend.errors import ConflictError
from mend.fleet.requests import Recurrence, RequestStatus

PATIENCE_S = 20.0


async def count_known(work: Work) -> int:
    return len(await work.fleet.requests())


async def test_no_more_is_taken_than_may_be_open_and_nothing_changes() -> None:
    async with working("a", most_open=2) as work:
        for name in ("one", "other"):
            await work.fleet.requesters.submit(asked(name), None)
        with pytest.raises(ConflictError, match="2 requests are open, and at most so") as refused:
            await work.fleet.requesters.submit(visit("third"), None)
        assert refused.value.limit == "open_requests"
        assert untold([str(refused.value)], ("clauses", "refusals")) == []
        assert await count_known(work) == 2


async def test_there_is_room_again_when_one_is_over() -> None:
    async with working("a", most_open=1) as work:
        await work.fleet.requesters.submit(visit("one"), None)
        (await work.runs.nth(1)).ended.set_result(("finished", True))
        await work.until("one", RequestStatus.DONE)
        await work.fleet.requesters.submit(visit("other", earliest_s=3600.0), None)
        await work.fleet.requesters.cancel("other", None)
        await work.fleet.requesters.submit(visit("third"), None)
        assert await count_known(work) == 3


async def test_what_recurs_counts_for_as_long_as_it_does() -> None:
    late = {"earliest_s": 86_400.0 * 3, "recurrence": Recurrence(every_s=86_400.0)}
    async with working("a", most_open=2) as work:
        await work.fleet.requesters.submit(visit("daily", **late), None)
        with pytest.raises(ConflictError, match="requests are open"):
            await work.fleet.requesters.submit(visit("other"), None)
        await work.fleet.requesters.cancel("daily", None)
        await work.fleet.requesters.submit(visit("other"), None)


async def test_who_says_something_of_a_robot_waits_for_one_request_at_most(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with working("a", "c") as work:
        of, told = work.fleet.dispatcher, list[str]()
        begun, may_end = ThreadEvent(), ThreadEvent()
        submit = of.submit

        def slowly(request: Any, now_s: float) -> Any:
            begun.set()
            may_end.wait(PATIENCE_S)
            told.append(request.name)
            return submit(request, now_s)

        monkeypatch.setattr(of, "submit", slowly)
        asking = [
            asyncio.create_task(work.fleet.requesters.submit(visit(f"v{number}"), None))
            for number in range(5)
        ]
        assert await asyncio.to_thread(begun.wait, PATIENCE_S)

        async def take_out() -> None:
            await work.fleet.operators.take_out("r1", "a flat tyre", None)
            told.append("r1 is out")

        taking_out = asyncio.create_task(take_out())
        await asyncio.sleep(0)
        may_end.set()
        await asyncio.gather(taking_out, *asking)
        assert told.index("r1 is out") <= 2
        assert sorted(told) == ["r1 is out", *(f"v{number}" for number in range(5))]
