"""What the API dates, it dates by the service's own wall clock."""

from collections.abc import AsyncIterator
from datetime import UTC, datetime, timedelta
from typing import Any

import httpx
import pytest
from service_under_test import TOKEN, ServiceUnderTest, build

from mend.server.journal import events as ev

LONG_AGO = datetime(2001, 2, 3, 4, 5, 6, tzinfo=UTC)
SCENE = """\
name: bench
objects:
  cup: {color: [1.0, 0.1, 0.1], size: [0.05, 0.05, 0.05], pose: {x: 0.5, y: -0.3}}
places:
  tray: {pose: {x: 0.5, y: 0.0}}
"""
TREE = """\
name: own
tree: {behavior: pick_and_place, object: red_box, place: left}
"""


class Clock:
    """A service whose wall clock the test sets, and an admin at it."""

    def __init__(self) -> None:
        self.now = LONG_AGO
        self.service: ServiceUnderTest = build(
            token=TOKEN, wall_time_s=lambda: self.now.timestamp()
        )
        headers = {"Authorization": f"Bearer {TOKEN}"}
        self.admin: httpx.AsyncClient = self.service.client(headers=headers)

    async def ask(self, method: str, path: str, **body: Any) -> Any:
        answer = await self.admin.request(method, path, json=body or None)
        assert answer.is_success, answer.text
        return answer.json() if answer.content else None

    async def events(self) -> list[ev.Event]:
        await self.service.deeds.written()
        return list(await self.service.journal.read(0, 100))

    async def principal(self, name: str) -> Any:
        every = await self.ask("GET", "/api/access/principals")
        return next(each for each in every if each["name"] == name)


@pytest.fixture
async def clock() -> AsyncIterator[Clock]:
    clock = Clock()
    yield clock
    await clock.admin.aclose()
    clock.service.journal.close()


def time_of(text: str) -> datetime:
    return datetime.fromisoformat(text)


@pytest.mark.parametrize(("kind", "text"), [("scene", SCENE), ("tree", TREE)])
async def test_what_is_uploaded_and_deleted_has_the_clocks_time(
    clock: Clock, kind: str, text: str
) -> None:
    name = text.splitlines()[0].removeprefix("name: ")
    await clock.ask("POST", f"/api/{kind}s", text=text)
    clock.now += timedelta(hours=1)
    await clock.ask("DELETE", f"/api/{kind}s/{name}")
    kept, deleted = await clock.events()
    assert isinstance(kept, ev.DocumentKept)
    assert kept.wall_time == LONG_AGO
    assert isinstance(deleted, ev.DocumentDeleted)
    assert deleted.wall_time == LONG_AGO + timedelta(hours=1)


async def test_a_principal_is_added_rotated_and_expires_by_the_clock(clock: Clock) -> None:
    await clock.ask("POST", "/api/access/principals", name="nina", role="helper", expires_days=1)
    nina = await clock.principal("nina")
    assert time_of(nina["added"]) == LONG_AGO
    assert time_of(nina["expires"]) == LONG_AGO + timedelta(days=1)
    assert nina["valid"]
    clock.now += timedelta(days=1, seconds=1)
    assert not (await clock.principal("nina"))["valid"]
    await clock.ask("POST", "/api/access/principals/nina/rotate", expires_days=2)
    nina = await clock.principal("nina")
    assert time_of(nina["expires"]) == clock.now + timedelta(days=2)
    assert nina["valid"]
    assert [each.wall_time for each in await clock.events()] == [LONG_AGO, clock.now]


async def test_a_code_for_a_robot_expires_by_the_clock(clock: Clock) -> None:
    async def enrol(code: str) -> httpx.Response:
        async with clock.service.client() as robot:
            body = {"robot": "arm-1", "code": code}
            return await robot.post("/api/robots/enrol", json=body)

    code = (await clock.ask("POST", "/api/access/enrolments", robot="arm-1", minutes=5))["code"]
    clock.now += timedelta(minutes=6)
    assert (await enrol(code)).status_code == 403
    code = (await clock.ask("POST", "/api/access/enrolments", robot="arm-1", minutes=5))["code"]
    clock.now += timedelta(minutes=4)
    assert (await enrol(code)).status_code == 201
    assert time_of((await clock.principal("arm-1"))["added"]) == clock.now
