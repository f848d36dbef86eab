"""Whoever shows wrong tokens is made to wait, on every door alike; others are not kept out."""

import asyncio
import hashlib
import hmac
import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest
from people import serving_people
from service_under_test import TOKEN, ServiceUnderTest, serving
from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus

from mend.robots.link.channel import ChannelClosedError, LinkRefusedError
from mend.robots.link.enrolment import enrol
from mend.robots.link.websocket import websocket_channel
from mend.server.access.roles import Role
from mend.server.api.robot_socket import ROBOT_PATH, add_robot_route
from mend.server.client import MendClient
from mend.server.client_errors import UnreachableError
from mend.server.limits import Limits
from mend.server.robots.registry import RobotRegistry

LIMITS = Limits(wrong_tokens=2)
ONE_CONNECTION = httpx.Limits(max_connections=1)
RIGHT = {"Authorization": f"Bearer {TOKEN}"}


class Clock:
    now = 1_000_000.0

    def __call__(self) -> float:
        return self.now


@asynccontextmanager
async def guarded(clock: Clock) -> AsyncIterator[ServiceUnderTest]:
    async with serving(token=TOKEN, limits=LIMITS, wall_time_s=clock) as service:
        registry = RobotRegistry(service.journal, clock)
        add_robot_route(service.app, registry, service.app.state.services.access)
        yield service
        registry.close()


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
async def service(clock: Clock) -> AsyncIterator[ServiceUnderTest]:
    async with guarded(clock) as service:
        yield service


async def once(service: ServiceUnderTest, path: str, **more: Any) -> httpx.Response:
    """One request on a connection of its own."""
    async with httpx.AsyncClient(base_url=service.url) as client:
        return await client.request(more.pop("method", "GET"), path, **more)


async def by_rest(service: ServiceUnderTest, token: str) -> tuple[int, str | None]:
    response = await once(service, "/api/runs", headers={"Authorization": f"Bearer {token}"})
    return response.status_code, response.headers.get("retry-after")


async def by_sign_in(service: ServiceUnderTest, token: str) -> tuple[int, str | None]:
    response = await once(service, "/api/session", method="POST", json={"token": token})
    return response.status_code, response.headers.get("retry-after")


async def by_socket(url: str, token: str) -> tuple[int, str | None]:
    try:
        async with connect(url, additional_headers={"Authorization": f"Bearer {token}"}):
            return 200, None
    except InvalidStatus as refused:
        return refused.response.status_code, refused.response.headers.get("retry-after")


async def by_helper(service: ServiceUnderTest, token: str) -> tuple[int, str | None]:
    return await by_socket(f"{service.ws}?helper=anna", token)


async def by_robot(service: ServiceUnderTest, token: str) -> tuple[int, str | None]:
    return await by_socket(service.url.replace("http", "ws", 1) + ROBOT_PATH, token)


async def by_look(service: ServiceUnderTest, token: str) -> tuple[int, str | None]:
    """At a door that is open to everybody."""
    headers = {"Authorization": f"Bearer {token}"}
    response = await once(service, "/api/session", headers=headers)
    return response.status_code, response.headers.get("retry-after")


DOORS = [
    (by_rest, 401, 200),
    (by_look, 200, 200),
    (by_sign_in, 401, 204),
    (by_helper, 403, 200),
    (by_robot, 401, 200),
]


@pytest.mark.parametrize(("door", "refused", "welcome"), DOORS)
async def test_after_some_wrong_tokens_none_is_read_for_a_while(
    service: ServiceUnderTest, clock: Clock, door: Any, refused: int, welcome: int
) -> None:
    assert [await door(service, f"wrong {number}") for number in range(3)] == [(refused, None)] * 3
    assert await door(service, "wrong 3") == (429, "1")
    # The right one, too: else guessing would be as quick as before.
    assert await door(service, TOKEN) == (429, "1")
    assert service.refusals.counts["wrong_tokens"] == 2
    clock.now += 1.0
    assert (await door(service, TOKEN))[0] == welcome
    assert (await door(service, "wrong 4"))[0] == refused
    assert await door(service, TOKEN) == (429, "2")
    clock.now += 2.0
    assert (await door(service, TOKEN))[0] == welcome


@pytest.mark.parametrize(("door", "refused", "welcome"), DOORS)
async def test_an_outdated_token_keeps_nobody_out(
    service: ServiceUnderTest, door: Any, refused: int, welcome: int
) -> None:
    assert [await door(service, "outdated") for _ in range(20)] == [(refused, None)] * 20
    assert (await door(service, TOKEN))[0] == welcome


async def enrolled(service: ServiceUnderTest, code: str) -> tuple[int, str | None]:
    body = {"robot": "arm-1", "code": code}
    response = await once(service, "/api/robots/enrol", method="POST", json=body)
    return response.status_code, response.headers.get("retry-after")


async def test_a_wrong_code_to_enrol_a_robot_is_a_guess_like_any_other(
    service: ServiceUnderTest, clock: Clock
) -> None:
    assert [await enrolled(service, f"ABCD-{number}") for number in range(3)] == [(403, None)] * 3
    assert await enrolled(service, "ABCD-3") == (429, "1")
    assert await by_rest(service, TOKEN) == (429, "1")
    assert await enrolled(service, "ABCD-2") == (403, None)
    clock.now += 1.0
    assert (await enrolled(service, "ABCD-4"))[0] == 403
    assert await enrolled(service, "ABCD-5") == (429, "2")


async def make_wait(service: ServiceUnderTest) -> None:
    for number in range(3):
        await by_rest(service, f"guess {number}")
    assert (await by_rest(service, TOKEN))[0] == 429


async def test_the_refusal_is_a_problem_document(service: ServiceUnderTest) -> None:
    await make_wait(service)
    for response in (
        await once(service, "/api/runs", headers=RIGHT),
        await once(service, "/api/session", method="POST", json={"token": TOKEN}),
    ):
        assert response.headers["content-type"] == "application/problem+json"
        detail = "too many wrong tokens came from this address: try again in 1 s"
        assert response.json()["detail"] == detail
    with pytest.raises(InvalidStatus) as refused:
        await connect(f"{service.ws}?helper=anna", additional_headers=RIGHT)
    assert json.loads(refused.value.response.body or b"")["detail"] == detail


async def test_the_first_message_of_a_socket_waits_too(service: ServiceUnderTest) -> None:
    await make_wait(service)
    async with connect(f"{service.ws}?helper=anna") as socket, asyncio.timeout(60):
        await socket.send(json.dumps({"type": "auth", "token": TOKEN}))
        error = json.loads(await socket.recv())
        assert (error["type"], error["status"]) == ("error", 429)
        await socket.wait_closed()
        assert socket.close_code == 1013


async def test_wrong_first_messages_are_counted(service: ServiceUnderTest) -> None:
    for number in range(3):
        async with connect(f"{service.ws}?helper=anna") as socket, asyncio.timeout(60):
            await socket.send(json.dumps({"type": "auth", "token": f"guess {number}"}))
            await socket.wait_closed()
            assert socket.close_code == 1008
    assert (await by_rest(service, TOKEN))[0] == 429


async def test_who_is_in_stays_in(service: ServiceUnderTest) -> None:
    async with (
        httpx.AsyncClient(base_url=service.url) as browser,
        httpx.AsyncClient(base_url=service.url, headers=RIGHT) as program,
    ):
        await browser.post("/api/session", json={"token": TOKEN})
        cookie = {"Cookie": f"mend_session={browser.cookies['mend_session']}"}
        assert (await program.get("/api/runs")).status_code == 200
        await make_wait(service)
        assert (await once(service, "/api/runs", headers=cookie)).status_code == 200
        assert (await program.get("/api/runs")).status_code == 200


async def asked(client: httpx.AsyncClient, token: str) -> int:
    headers = {"Authorization": f"Bearer {token}"}
    return (await client.get("/api/runs", headers=headers)).status_code


async def test_who_is_in_guesses_no_faster_than_others(
    service: ServiceUnderTest, clock: Clock
) -> None:
    async with httpx.AsyncClient(base_url=service.url, limits=ONE_CONNECTION) as client:
        assert await asked(client, TOKEN) == 200
        guesses = [await asked(client, f"guess {number}") for number in range(5)]
        assert guesses == [401, 401, 401, 429, 429]
        code = {"robot": "arm-1", "code": "ABCD-EFGH"}
        assert (await client.post("/api/robots/enrol", json=code)).status_code == 429
        assert (await client.post("/api/session", json={"token": "guess"})).status_code == 429
        assert await asked(client, TOKEN) == 200
        clock.now += 1.0
        assert [await asked(client, f"guess {number}") for number in (5, 6)] == [401, 429]


async def test_a_connection_of_somebody_revoked_waits_like_any_other(
    tmp_path: Path, clock: Clock
) -> None:
    settings = {"token": TOKEN, "limits": LIMITS, "wall_time_s": clock}
    async with serving_people(tmp_path, **settings) as (service, people):
        token = people.tokens[Role.VIEWER]
        async with httpx.AsyncClient(base_url=service.url, limits=ONE_CONNECTION) as client:
            assert await asked(client, token) == 200
            people.revoke(Role.VIEWER)
            guesses = [await asked(client, f"guess {number}") for number in range(4)]
            assert guesses == [401, 401, 401, 429]
            assert [await asked(client, each) for each in (token, TOKEN)] == [429, 429]


async def test_a_forged_cookie_tells_nothing_about_the_token(service: ServiceUnderTest) -> None:
    """Only the service knows the key, so that trying cookies is no way to try tokens."""

    expires = int(Clock.now) + 1000
    for key in (TOKEN.encode(), b""):
        signature = hmac.new(key, f"session:{expires}".encode(), hashlib.sha256).hexdigest()
        cookie = {"Cookie": f"mend_session={expires}.{signature}"}
        assert (await once(service, "/api/runs", headers=cookie)).status_code == 401


async def test_no_token_at_all_is_no_guess(service: ServiceUnderTest) -> None:
    for headers in ({}, {"Authorization": "Bearer"}, {"Authorization": "Basic abc"}) * 5:
        assert (await once(service, "/api/runs", headers=headers)).status_code == 401
    assert (await by_rest(service, TOKEN))[0] == 200


async def test_a_robot_and_a_client_try_again_when_they_have_to_wait(
    service: ServiceUnderTest,
) -> None:
    url = service.url.replace("http", "ws", 1) + ROBOT_PATH
    with pytest.raises(LinkRefusedError, match="present its credential"):
        await websocket_channel(url, "wrong")
    await make_wait(service)
    with pytest.raises(ChannelClosedError, match="try again in 1 s"):
        await websocket_channel(url, TOKEN)
    with pytest.raises(ChannelClosedError, match="try again in 1 s"):
        await asyncio.to_thread(enrol, url, "arm-1", "ABCD-EFGH")
    async with MendClient(service.url, token=TOKEN) as client:
        with pytest.raises(UnreachableError, match="429"):
            async with client.talk("anna"):
                pass
