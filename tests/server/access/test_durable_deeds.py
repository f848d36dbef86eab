"""What is answered is in the journal; what a kill kept out of it comes in at the next start."""

import asyncio
from collections.abc import AsyncIterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import httpx
import pytest
from full_disk import FailingConnection, Never, failing
from people import People
from service_under_test import ServiceUnderTest, build

from mend.server.access.deed_log import DeedLog
from mend.server.access.known_principals import KnownPrincipals
from mend.server.access.roles import Role
from mend.server.access.sessions import Sessions
from mend.server.journal import events as ev
from mend.server.journal.sqlite import SqliteJournal
from mend.server.journal.trouble import Trouble

FULL = "database or disk is full"
NINA = {"name": "nina", "role": "helper"}


@dataclass
class Place:
    service: ServiceUnderTest
    people: People
    disk: FailingConnection
    client: httpx.AsyncClient

    async def send(self, method: str, path: str, body: Any = None) -> httpx.Response:
        headers = self.people.headers(Role.ADMIN)
        return await self.client.request(method, path, json=body, headers=headers)

    async def changes(self) -> list[ev.AccessChanged]:
        events = await self.service.journal.read(0, 100)
        return [each for each in events if isinstance(each, ev.AccessChanged)]


@pytest.fixture
async def place(tmp_path: Path) -> AsyncIterator[Place]:
    """A service whose journal cannot be written while `disk.error` is set."""
    people = People(tmp_path)
    service = build(principals=people.file)
    journal = service.journal
    journal._trouble = Trouble(journal._probe, Never())
    async with service.client() as client:
        yield Place(service, people, failing(journal), client)
    journal.close()


async def journaled_at_starts(folder: Path, file: Path, starts: int) -> list[ev.AccessChanged]:
    """What a service that is started so often journals of the file of principals."""
    for _ in range(starts):
        journal = SqliteJournal(folder / "journal.db")
        deeds = DeedLog(journal, lambda: datetime.now(UTC))
        await deeds.recover(Sessions(b"k" * 32, lambda: 0.0))
        deeds.take_changes(KnownPrincipals(file, lambda: 0.0).changes)
        await deeds.close()
        events = await journal.read(0, 100)
        journal.close()
    return [each for each in events if isinstance(each, ev.AccessChanged)]


async def test_a_change_that_a_kill_kept_from_the_journal_is_journaled_at_the_next_start_once(
    place: Place, tmp_path: Path
) -> None:
    place.disk.error = FULL
    assert (await place.send("POST", "/api/access/principals", NINA)).status_code == 503
    found = await journaled_at_starts(tmp_path, place.people.file, 2)
    (added,) = [each for each in found if each.principal == "nina"]
    author = ev.Author(principal="ada", role=Role.ADMIN, address="127.0.0.1")
    assert (added.what, added.author) == ("added", author)
    assert await place.changes() == []


async def test_a_change_that_was_answered_is_journaled_then_and_not_again(place: Place) -> None:
    assert (await place.send("POST", "/api/access/principals", NINA)).status_code == 201
    (added,) = await place.changes()
    assert (added.what, added.principal, added.author.principal) == ("added", "nina", "ada")
    # As the service does every second, also while a request is under way.
    place.service.deeds.take_changes(KnownPrincipals(place.people.file, lambda: 0.0).changes)
    await place.service.deeds.written()
    assert [each.principal for each in await place.changes()].count("nina") == 1
    assert added.change is not None


async def test_a_change_that_is_on_its_way_into_the_journal_is_not_taken_from_the_file_as_well(
    place: Place, monkeypatch: pytest.MonkeyPatch
) -> None:
    look = place.service.access.look

    async def look_and_take() -> None:
        await look()
        place.service.deeds.take_changes(place.service.access.principals.changes)

    monkeypatch.setattr(place.service.access, "look", look_and_take)
    assert (await place.send("POST", "/api/access/principals", NINA)).status_code == 201
    await place.service.deeds.written()
    assert [each.principal for each in await place.changes()].count("nina") == 1


@pytest.mark.parametrize(
    ("method", "path", "body"),
    [
        ("POST", "/api/access/principals", NINA),
        ("POST", "/api/access/principals/henri/rotate", {}),
        ("DELETE", "/api/access/principals/henri", None),
        ("POST", "/api/access/enrolments", {"robot": "arm-7"}),
    ],
)
async def test_a_change_that_cannot_be_journaled_is_not_answered_as_done_but_journaled_later(
    place: Place, method: str, path: str, body: Any
) -> None:
    place.disk.error = FULL
    answer = await place.send(method, path, body)
    assert answer.status_code == 503
    assert "it is done, but the journal has yet to be told" in answer.json()["detail"]
    assert FULL in answer.json()["detail"]
    place.disk.error = None
    place.service.journal.trouble.ended(probed=False)
    await place.service.deeds.written()
    (change,) = await place.changes()
    assert change.author.principal == "ada"


async def test_while_it_is_known_that_nothing_can_be_journaled_access_is_only_taken(
    place: Place,
) -> None:
    place.service.journal.trouble.began("the journal could not be written")
    before = place.people.file.read_text()
    for path, body in [
        ("/api/access/principals", NINA),
        ("/api/access/principals/henri/rotate", {}),
        ("/api/access/enrolments", {"robot": "arm-7"}),
        ("/api/robots/enrol", {"robot": "arm-7", "code": "ABCD"}),
    ]:
        assert (await place.send("POST", path, body)).status_code == 503
    assert place.people.file.read_text() == before
    place.disk.error = FULL
    assert (await place.send("DELETE", "/api/access/principals/henri")).status_code == 503
    assert place.service.access.of_token(place.people.tokens[Role.HELPER]) is None


async def test_a_sign_out_that_cannot_be_journaled_is_refused_and_the_session_lasts(
    place: Place,
) -> None:
    sessions, cookie = place.service.access.sessions, await signed_in(place)
    place.disk.error = FULL
    refused = await place.client.delete("/api/session")
    assert refused.status_code == 503
    assert "the session lasts, as it cannot be ended now" in refused.json()["detail"]
    assert FULL in refused.json()["detail"]
    assert sessions.read(cookie) is not None
    place.disk.error = None
    assert (await place.client.delete("/api/session")).status_code == 204
    assert sessions.read(cookie) is None


async def test_a_sign_out_that_was_answered_holds_after_a_kill(place: Place) -> None:
    cookie = await signed_in(place)
    answers = await asyncio.gather(*(place.client.delete("/api/session") for _ in range(5)))
    assert [each.status_code for each in answers] == [204] * 5
    place.disk.error = FULL
    again = Sessions(b"k" * 32, lambda: 0.0)
    await DeedLog(place.service.journal, lambda: datetime.now(UTC)).recover(again)
    assert again.read(cookie) is None
    events = await place.service.journal.read(0, 100)
    assert [type(each) for each in events].count(ev.SignedOut) == 1


async def signed_in(place: Place) -> str:
    token = place.people.tokens[Role.HELPER]
    answer = await place.client.post("/api/session", json={"token": token})
    assert answer.status_code == 204
    await place.service.deeds.written()
    return answer.cookies["mend_session"]
