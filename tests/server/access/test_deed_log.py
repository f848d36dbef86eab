"""What people do to the service is journaled, and nobody can flood the journal with sign-ins."""

import asyncio
from collections.abc import AsyncIterator
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import cast
from uuid import uuid4

import pytest

from mend.server.access.changes import PrincipalsEditor
from mend.server.access.deed_log import DeedLog
from mend.server.access.principal import Caller, Principal
from mend.server.access.principals_file import KEPT_CHANGES, PrincipalChange, read_principals
from mend.server.access.roles import Role
from mend.server.access.sessions import Sessions
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry, Journal, UnreadableEvent
from mend.server.journal.sqlite import SqliteJournal

ANNA = Principal("anna", Role.HELPER, "key")


class Clock:
    def __init__(self) -> None:
        self.now = datetime(2026, 5, 4, 12, tzinfo=UTC)

    def __call__(self) -> datetime:
        return self.now


@pytest.fixture
async def journal() -> AsyncIterator[SqliteJournal]:
    journal = SqliteJournal(":memory:")
    yield journal
    journal.close()


async def test_ten_thousand_wrong_tokens_make_two_events(journal: SqliteJournal) -> None:
    clock = Clock()
    deeds = DeedLog(journal, clock)
    for number in range(10_000):
        deeds.failed(f"10.0.{number // 256}.{number % 256}")
    clock.now += timedelta(minutes=1)
    deeds.tell_due()
    await deeds.written()
    first, second = await journal.read(0, 10, ev.NO_RUN)
    assert isinstance(first, ev.SignInFailed)
    assert isinstance(second, ev.SignInFailed)
    assert (first.times, second.times) == (1, 9_999)
    assert len(second.addresses) == 20
    assert second.elsewhere == 9_979


async def test_sign_ins_of_one_principal_are_told_once_a_minute(journal: SqliteJournal) -> None:
    clock = Clock()
    deeds = DeedLog(journal, clock)
    for _ in range(5):
        deeds.signed_in(ANNA, "10.0.0.1")
    await deeds.close()
    told = [each for each in await journal.read(0, 10) if isinstance(each, ev.SignedIn)]
    assert [(each.principal, each.times) for each in told] == [("anna", 1), ("anna", 4)]
    assert told[1].addresses == [ev.AddressCount(address="10.0.0.1", times=4)]


async def test_a_session_that_was_ended_stays_so_after_a_restart(journal: SqliteJournal) -> None:
    clock = Clock()
    key, wall = b"k" * 32, clock.now.timestamp
    sessions = Sessions(key, wall)
    session, cookie = sessions.new(ANNA)
    deeds = DeedLog(journal, clock)
    await deeds.signed_out(session, Caller(ANNA, "10.0.0.1", session.id), lambda: None)
    again = Sessions(key, wall)
    assert again.read(cookie) is not None
    await DeedLog(journal, clock).recover(again)
    assert again.read(cookie) is None


async def test_a_change_of_the_file_is_journaled_once_also_after_a_restart(
    journal: SqliteJournal,
) -> None:
    clock = Clock()
    change = PrincipalChange(
        id=uuid4(), when=clock.now, by="root", what="revoked", name="anna", role=Role.HELPER
    )
    for _ in range(2):
        deeds = DeedLog(journal, clock)
        await deeds.recover(Sessions(b"k" * 32, clock.now.timestamp))
        deeds.take_changes([change])
        deeds.take_changes([change])
        await deeds.close()
    (event,) = await journal.read(0, 10)
    assert isinstance(event, ev.AccessChanged)
    assert (event.what, event.principal, event.author.principal) == ("revoked", "anna", "root")


def revoked(clock: Clock) -> PrincipalChange:
    return PrincipalChange(
        id=uuid4(), when=clock.now, by="root", what="revoked", name="anna", role=Role.HELPER
    )


async def test_only_so_many_changes_are_remembered_but_all_that_the_file_has_or_may_get_back(
    journal: SqliteJournal,
) -> None:
    clock = Clock()
    deeds = DeedLog(journal, clock)
    first = revoked(clock)
    made = [revoked(clock) for _ in range(2 * KEPT_CHANGES)]
    for change in made:
        deeds.take_changes([first, change])
    assert len(deeds._journaled) <= KEPT_CHANGES + 2
    await deeds.written()
    journaled = journal.head
    deeds.take_changes([])
    deeds.take_changes([first, *made[-KEPT_CHANGES + 1 :]])
    await deeds.close()
    assert journal.head == journaled == 2 * KEPT_CHANGES + 1


async def test_who_signed_in_more_than_a_minute_ago_is_not_remembered(
    journal: SqliteJournal,
) -> None:
    clock = Clock()
    deeds = DeedLog(journal, clock)
    for number in range(20):
        deeds.signed_in(Principal(f"helper {number}", Role.HELPER, "key"), "10.0.0.1")
        clock.now += timedelta(seconds=30)
    assert len(deeds._told) == 2
    await deeds.close()


async def test_what_cannot_be_read_takes_nothing_else_with_it(journal: SqliteJournal) -> None:
    clock = Clock()
    key, wall = b"k" * 32, clock.now.timestamp
    session, cookie = Sessions(key, wall).new(ANNA)
    deeds = DeedLog(journal, clock)
    await deeds.access_changed(revoked(clock), ev.Author(principal="root", role=Role.ADMIN))
    await deeds.signed_out(session, Caller(ANNA, "10.0.0.1", session.id), lambda: None)
    journal._write_connection.execute("UPDATE events SET body = '{}' WHERE seq = 1")
    again = Sessions(key, wall)
    recovered = DeedLog(journal, clock)
    await recovered.recover(again)
    assert again.read(cookie) is None
    (sentence,) = recovered.unreadable
    assert sentence.startswith("event 1 cannot be read")


async def test_a_row_on_a_damaged_page_is_passed_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A page of the table is overwritten; the index over the runs still has the numbers."""
    path = tmp_path / "journal.db"
    opened = SqliteJournal(path)
    count = 400
    for number in range(count):
        change = ev.AccessChanged(
            wall_time=Clock().now, what="added", principal=f"{number:0>60}", role=Role.VIEWER,
            author=ev.Author(principal="root", role=Role.ADMIN),
        )  # fmt: skip
        await opened.append(Entry(events=[change]))
    opened.close()
    content = path.read_bytes()
    page = content.index(f"{count // 2:0>60}".encode()) // 4096
    path.write_bytes(content[: page * 4096] + b"\xff" * 4096 + content[(page + 1) * 4096 :])
    monkeypatch.setattr("mend.server.journal.opening.quick_check", lambda *_: [])
    damaged = SqliteJournal(path)
    found = await damaged.read_readable(0, 2 * count, ev.NO_RUN)
    damaged.close()
    unreadable = [each for each in found if isinstance(each, UnreadableEvent)]
    assert len(found) == count
    assert 0 < len(unreadable) < count // 10


async def test_a_clock_that_is_set_back_keeps_nothing_from_being_told(
    journal: SqliteJournal,
) -> None:
    clock = Clock()
    deeds = DeedLog(journal, clock)
    deeds.failed("10.0.0.1")
    clock.now -= timedelta(days=1)
    deeds.failed("10.0.0.2")
    await deeds.written()
    told = await journal.read(0, 10, ev.NO_RUN)
    assert [each.times for each in told if isinstance(each, ev.SignInFailed)] == [1, 1]


async def test_a_service_that_stops_waits_only_so_long_for_a_journal_that_takes_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    class Stuck:
        async def append(self, *_: object, **__: object) -> None:
            await asyncio.Event().wait()

    monkeypatch.setattr("mend.server.access.deed_log.LAST_WORDS_S", 0.01)
    deeds = DeedLog(cast(Journal, Stuck()), Clock())
    deeds.failed("10.0.0.1")
    async with asyncio.timeout(60):
        await deeds.close()


async def test_a_change_that_a_kill_kept_from_the_journal_is_journaled_at_the_next_start_once(
    journal: SqliteJournal, tmp_path: Path
) -> None:
    clock, path = Clock(), tmp_path / "principals.yaml"
    # What the API does is in the file first, and the service is killed then.
    PrincipalsEditor(path, "ada", Role.ADMIN, "10.0.0.1").add("bert", Role.VIEWER, clock.now)
    for _ in range(2):
        deeds = DeedLog(journal, clock)
        await deeds.recover(Sessions(b"k" * 32, clock.now.timestamp))
        deeds.take_changes(read_principals(path).changes)
        await deeds.close()
    (told,) = await journal.read(0, 10)
    assert isinstance(told, ev.AccessChanged)
    assert (told.what, told.principal) == ("added", "bert")
    assert told.author == ev.Author(principal="ada", role=Role.ADMIN, address="10.0.0.1")
