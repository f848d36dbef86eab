"""Who may come in: every way to show the token, right, wrong and missing, on every door."""

import asyncio
import json
from collections.abc import AsyncIterator
from typing import Any

import httpx
import pytest
from service_under_test import TOKEN, ServiceUnderTest, serving
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import InvalidStatus

RIGHT = {"Authorization": f"Bearer {TOKEN}"}
STRANGER = {"required": True, "signed_in": False, "name": None, "role": None}
HOLDER = {"required": True, "signed_in": True, "name": None, "role": "admin"}
WRONG = {"Authorization": "Bearer not-the-token-at-all"}


@pytest.fixture
async def service() -> AsyncIterator[ServiceUnderTest]:
    async with serving(token=TOKEN) as service:
        yield service


@pytest.fixture
async def client(service: ServiceUnderTest) -> AsyncIterator[httpx.AsyncClient]:
    async with httpx.AsyncClient(base_url=service.url) as client:
        yield client


async def sign_in(client: httpx.AsyncClient) -> str:
    response = await client.post("/api/session", json={"token": TOKEN})
    assert response.status_code == 204
    cookie = response.headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "samesite=strict" in cookie.lower()
    assert TOKEN not in cookie
    return client.cookies["mend_session"]


@pytest.mark.parametrize("path", ["/healthz", "/readyz", "/", "/api/session"])
async def test_open_doors_need_no_token(client: httpx.AsyncClient, path: str) -> None:
    assert (await client.get(path)).status_code == 200


@pytest.mark.parametrize(
    "path", ["/api/runs", "/api/trees", "/api/robots", "/api/nowhere", "/metrics"]
)
@pytest.mark.parametrize(
    "headers",
    [
        {},
        WRONG,
        {"Authorization": f"Basic {TOKEN}"},
        {"Authorization": "Bearer"},
        {"Authorization": "Bearer t\u00f6ken".encode()},
        {"Cookie": "mend_session=forged"},
        {"Cookie": "mend_session=99999999999.forged"},
        {"Cookie": f"mend_session={TOKEN}"},
    ],
    ids=str,
)
async def test_closed_doors_need_the_token(
    client: httpx.AsyncClient, path: str, headers: dict[str, Any]
) -> None:
    response = await client.get(path, headers=headers)
    assert response.status_code == 401
    assert response.headers["www-authenticate"] == "Bearer"
    assert response.headers["content-type"] == "application/problem+json"


async def test_bearer_and_cookie_open_the_doors(client: httpx.AsyncClient) -> None:
    assert (await client.get("/api/runs", headers=RIGHT)).status_code == 200
    assert (await client.get("/api/session")).json() == STRANGER
    await sign_in(client)
    assert (await client.get("/api/runs")).status_code == 200
    assert (await client.get("/api/session")).json() == HOLDER
    assert (await client.delete("/api/session")).status_code == 204
    assert (await client.get("/api/runs")).status_code == 401


async def test_token_in_the_address_opens_nothing(
    client: httpx.AsyncClient, service: ServiceUnderTest
) -> None:
    assert (await client.get("/api/runs", params={"token": TOKEN})).status_code == 401
    async with connect(f"{service.ws}?helper=anna&token={TOKEN}") as socket:
        await socket.send(json.dumps({"type": "ping"}))
        assert await close_code(socket) == 1008


async def test_wrong_token_gets_no_session(client: httpx.AsyncClient) -> None:
    response = await client.post("/api/session", json={"token": "wrong"})
    assert response.status_code == 401
    assert "set-cookie" not in response.headers


@pytest.mark.parametrize("host", ["evil.example", "evil.example:80", "", "127.0.0.1.evil.example"])
async def test_foreign_host_is_refused(client: httpx.AsyncClient, host: str) -> None:
    response = await client.get("/healthz", headers={"Host": host})
    assert response.status_code == 421


async def test_foreign_origin_may_not_change_anything(client: httpx.AsyncClient) -> None:
    await sign_in(client)
    evil = {"Origin": "https://evil.example"}
    assert (await client.post("/api/runs", json={}, headers=evil)).status_code == 403
    own = {"Origin": str(client.base_url).rstrip("/")}
    assert (await client.post("/api/runs", json={}, headers=own)).status_code == 422


async def close_code(socket: ClientConnection) -> int | None:
    async with asyncio.timeout(60):
        await socket.wait_closed()
    return socket.close_code


async def first_message(socket: Any) -> Any:
    async with asyncio.timeout(60):
        return json.loads(await socket.recv())


async def test_socket_opens_with_the_bearer_header(service: ServiceUnderTest) -> None:
    async with connect(f"{service.ws}?helper=anna", additional_headers=RIGHT) as socket:
        assert (await first_message(socket))["type"] == "snapshot"


async def test_socket_opens_with_the_cookie(
    client: httpx.AsyncClient, service: ServiceUnderTest
) -> None:
    cookie = {"Cookie": f"mend_session={await sign_in(client)}"}
    async with connect(f"{service.ws}?helper=anna", additional_headers=cookie) as socket:
        assert (await first_message(socket))["type"] == "snapshot"


async def test_socket_opens_with_the_first_message(service: ServiceUnderTest) -> None:
    async with connect(f"{service.ws}?helper=anna") as socket:
        await socket.send(json.dumps({"type": "auth", "token": TOKEN}))
        assert (await first_message(socket))["type"] == "snapshot"


@pytest.mark.parametrize(
    "message",
    ['{"type": "auth", "token": "wrong"}', '{"type": "auth"}', '{"type": "ping"}', "{", b"\x00"],
)
async def test_socket_closes_after_a_wrong_first_message(
    service: ServiceUnderTest, message: str | bytes
) -> None:
    async with connect(f"{service.ws}?helper=anna") as socket:
        await socket.send(message)
        assert await close_code(socket) == 1008


async def test_socket_closes_when_no_token_comes(
    service: ServiceUnderTest, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mend.server.api.helper_connection.FIRST_MESSAGE_S", 0.01)
    async with connect(f"{service.ws}?helper=anna") as socket:
        assert await close_code(socket) == 1008
    assert service.refusals.counts["first_message_s"] == 1


@pytest.mark.parametrize(
    "headers",
    [
        WRONG,
        {**RIGHT, "Origin": "https://evil.example"},
        {**RIGHT, "Origin": "null"},
        {**RIGHT, "Origin": "http://127.0.0.1:1"},
    ],
    ids=str,
)
async def test_socket_is_not_even_accepted(
    service: ServiceUnderTest, headers: dict[str, str]
) -> None:
    with pytest.raises(InvalidStatus) as refused:
        await connect(f"{service.ws}?helper=anna", additional_headers=headers)
    assert refused.value.response.status_code == 403


async def test_socket_of_the_own_origin_and_an_allowed_one_is_accepted() -> None:
    async with serving(token=TOKEN, allowed_origins=["https://console.example"]) as service:
        for origin in (service.url, "https://console.example"):
            headers = {**RIGHT, "Origin": origin}
            async with connect(f"{service.ws}?helper=anna", additional_headers=headers) as socket:
                assert (await first_message(socket))["type"] == "snapshot"


async def test_allowed_host_is_served() -> None:
    async with (
        serving(allowed_hosts=["mend.example"]) as service,
        httpx.AsyncClient(base_url=service.url) as client,
    ):
        response = await client.get("/healthz", headers={"Host": "mend.example:8080"})
        assert response.status_code == 200
        assert (await client.get("/api/session")).json() == {**HOLDER, "required": False}
