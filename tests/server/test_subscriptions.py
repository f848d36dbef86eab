import asyncio
import json
from collections.abc import AsyncIterator

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_events import paused

from mend.server.journal.journal import Entry
from mend.server.journal.sqlite import SqliteJournal
from mend.server.journal.subscriptions import SubscriptionOverflowError


@pytest.fixture
async def journal() -> AsyncIterator[SqliteJournal]:
    journal = SqliteJournal(":memory:")
    yield journal
    journal.close()


async def append(journal: SqliteJournal, count: int) -> None:
    await journal.append(Entry(events=[paused() for _ in range(count)]))


async def take(journal: SqliteJournal, after: int, count: int) -> list[int]:
    """The numbers of the first `count` events that a subscriber gets."""
    numbers: list[int] = []
    with journal.subscribe(after) as subscription:
        while len(numbers) < count:
            numbers += [record.seq for record in await subscription.take()]
    return numbers


async def test_replay_then_live(journal: SqliteJournal) -> None:
    await append(journal, 3)
    with journal.subscribe(after=1) as subscription:
        assert [record.seq for record in await subscription.take()] == [2, 3]
        await append(journal, 2)
        assert [record.seq for record in await subscription.take()] == [4, 5]


async def test_text_is_the_event_and_shared_by_every_subscriber(journal: SqliteJournal) -> None:
    with journal.subscribe(0) as one, journal.subscribe(0) as other:
        waiting = asyncio.gather(one.take(), other.take())
        await asyncio.sleep(0)
        await append(journal, 1)
        (mine,), (theirs,) = await waiting
        assert mine.text is theirs.text
        assert json.loads(mine.text)["seq"] == 1
        assert json.loads(mine.text)["type"] == "run_paused"


@settings(deadline=None, max_examples=25)
@given(
    batches=st.lists(st.integers(1, 40), min_size=1, max_size=15),
    afters=st.lists(st.integers(0, 60), min_size=1, max_size=6),
    head_start=st.integers(0, 8),
)
def test_no_gap_and_no_duplicate_while_others_append(
    batches: list[int], afters: list[int], head_start: int
) -> None:
    async def scenario() -> None:
        journal = SqliteJournal(":memory:")
        total = sum(batches)
        for count in batches[:head_start]:
            await append(journal, count)
        afters_here = [min(after, total) for after in afters]
        followers = [
            asyncio.ensure_future(take(journal, after, total - after)) for after in afters_here
        ]
        await asyncio.gather(*(append(journal, count) for count in batches[head_start:]))
        for after, numbers in zip(afters_here, await asyncio.gather(*followers), strict=True):
            assert numbers == list(range(after + 1, total + 1))
        journal.close()

    asyncio.run(scenario())


async def test_slow_subscriber_is_cut_off_and_the_others_are_not(journal: SqliteJournal) -> None:
    with journal.subscribe(0, capacity=5) as slow, journal.subscribe(0, capacity=100) as good:
        first = asyncio.gather(slow.take(), good.take())
        await asyncio.sleep(0)
        await append(journal, 1)
        await first
        await append(journal, 6)
        assert [record.seq for record in await good.take()] == [2, 3, 4, 5, 6, 7]
        with pytest.raises(SubscriptionOverflowError, match="after=1"):
            await slow.take()
        assert len(journal.subscribers) == 1
        assert journal.subscribers.overflows == 1
    assert await take(journal, 1, 6) == [2, 3, 4, 5, 6, 7]


async def test_replay_longer_than_the_queue_does_not_cut_off(journal: SqliteJournal) -> None:
    await append(journal, 1200)
    with journal.subscribe(0, capacity=10) as subscription:
        numbers = [record.seq for record in await subscription.take()]
        await append(journal, 300)
        while len(numbers) < 1500:
            numbers += [record.seq for record in await subscription.take()]
    assert numbers == list(range(1, 1501))


async def test_closing_the_journal_ends_the_iteration(journal: SqliteJournal) -> None:
    await append(journal, 2)
    seen: list[int] = []

    async def follow() -> None:
        async for record in journal.subscribe(0):
            seen.append(record.seq)
            if record.seq == 3:
                journal.close()

    following = asyncio.ensure_future(follow())
    await append(journal, 1)
    await following
    assert seen == [1, 2, 3]
