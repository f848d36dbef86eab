"""However long events are, so many are never read at a time that they fill the memory."""

from collections.abc import AsyncIterator
from datetime import UTC, datetime

import pytest
from sample_events import RUN, paused
from service_under_test import build

import mend.server.journal.pages
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry
from mend.server.journal.sqlite import SqliteJournal

LONG = 1000
PAGE = 2500
EVENTS = 10


@pytest.fixture
async def journal(monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[SqliteJournal]:
    """A journal of long events; two of them are a page."""
    monkeypatch.setattr(mend.server.journal.pages, "PAGE_CHARS", PAGE)
    journal = SqliteJournal(":memory:")
    await journal.append(Entry(events=[long() for _ in range(EVENTS)]))
    yield journal
    journal.close()


def long(chars: int = LONG) -> ev.DocumentDeleted:
    name = "x" * chars
    return ev.DocumentDeleted(
        wall_time=datetime(2026, 1, 1, tzinfo=UTC), kind="tree", name=name, author=None
    )


async def test_a_page_of_long_events_has_fewer_than_were_asked_for(journal: SqliteJournal) -> None:
    assert [each.seq for each in await journal.read_records(0, 1000)] == [1, 2]
    assert [each.seq for each in await journal.read_records(2, 1)] == [3]
    assert [each.seq for each in await journal.read_readable(4, 1000)] == [5, 6]
    assert await journal.read_records(EVENTS, 1000) == []


async def test_an_event_that_is_longer_than_a_page_is_one(journal: SqliteJournal) -> None:
    await journal.append(Entry(events=[long(2 * PAGE), paused()]))
    (record,) = await journal.read_records(EVENTS, 1000)
    assert len(record.text) > PAGE
    assert [each.seq for each in await journal.read_records(EVENTS + 1, 10, RUN)] == [EVENTS + 2]


async def test_all_are_read_that_were_asked_for(journal: SqliteJournal) -> None:
    assert [each.seq for each in await journal.read(3, 5)] == [4, 5, 6, 7, 8]
    assert len(await journal.read(0, 1000)) == EVENTS


async def test_a_subscriber_who_missed_long_events_gets_them_all(journal: SqliteJournal) -> None:
    taken: list[int] = []
    with journal.subscribe(0) as subscription:
        while len(taken) < EVENTS:
            page = await subscription.take()
            assert len(page) <= 2
            taken += [each.seq for each in page]
    assert taken == list(range(1, EVENTS + 1))


async def test_deeds_that_are_long_come_all_in_one_page_of_the_audit(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(mend.server.journal.pages, "PAGE_CHARS", PAGE)
    service = build()
    await service.journal.append(Entry(events=[long() for _ in range(EVENTS)]))
    async with service.client() as client:
        page = (await client.get("/api/access/deeds", params={"limit": 7})).json()
        rest = (await client.get("/api/access/deeds", params={"after": page["seq"]})).json()
    service.journal.close()
    assert [each["seq"] for each in page["deeds"]] == [1, 2, 3, 4, 5, 6, 7]
    assert page["more"]
    assert [each["seq"] for each in rest["deeds"]] == [8, 9, 10]
    assert not rest["more"]
