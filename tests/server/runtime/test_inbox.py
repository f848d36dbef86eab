"""A run's inbox: nothing in it is lost, and who stops waiting for it stops."""

import asyncio

import pytest

from mend.server.runtime.inbox import Inbox


async def nothing() -> None:
    """What there is to do."""


@pytest.mark.parametrize("timeout_s", [None, 3600.0])
@pytest.mark.parametrize("turns", range(5))
async def test_who_is_cancelled_just_as_something_comes_stops_and_loses_nothing(
    timeout_s: float | None, turns: int
) -> None:
    inbox = Inbox()
    waiting = asyncio.create_task(inbox.next(timeout_s))
    for _ in range(3):
        await asyncio.sleep(0)
    inbox.tell(nothing)
    for _ in range(turns):
        await asyncio.sleep(0)
    taken = waiting.done()
    waiting.cancel()
    (came,) = await asyncio.gather(waiting, return_exceptions=True)
    if taken:
        assert came.task is nothing
    else:
        assert isinstance(came, asyncio.CancelledError)
        item = await inbox.next(0.0)
        assert item is not None
        assert item.task is nothing


async def test_who_waits_in_vain_is_told_in_time() -> None:
    assert await Inbox().next(0.0) is None
