"""Forwarded headers count where they come from a configured proxy, and nowhere else."""

from contextlib import AbstractAsyncContextManager

import httpx
import pytest
from service_under_test import TOKEN, ServiceUnderTest, serving

from mend.server.limits import Limits

LIMITS = Limits(wrong_tokens=1)
PROXY = ["127.0.0.0/8"]


def standing_clock() -> float:
    """However slow the machine is, nobody has waited long enough."""
    return 1_000_000.0


def serving_guarded(proxies: list[str]) -> AbstractAsyncContextManager[ServiceUnderTest]:
    return serving(token=TOKEN, limits=LIMITS, trusted_proxies=proxies, wall_time_s=standing_clock)


def forwarded(client: str, scheme: str = "https") -> dict[str, str]:
    return {"X-Forwarded-For": client, "X-Forwarded-Proto": scheme}


def shows(token: str, client: str) -> dict[str, str]:
    return {"Authorization": f"Bearer {token}", **forwarded(client)}


async def test_wrong_tokens_are_counted_by_the_client_behind_a_trusted_proxy() -> None:
    async with (
        serving_guarded(PROXY) as service,
        httpx.AsyncClient(base_url=service.url) as proxy,
    ):
        for number in range(2):
            response = await proxy.get("/api/runs", headers=shows(f"guess {number}", "192.0.2.1"))
            assert response.status_code == 401
        guesser = await proxy.get("/api/runs", headers=shows(TOKEN, "192.0.2.1"))
        other = await proxy.get("/api/runs", headers=shows(TOKEN, "192.0.2.2"))
        # The proxy uses one connection for all: that it was admitted says nothing of the next.
        again = await proxy.get("/api/runs", headers=shows(TOKEN, "192.0.2.1"))
        # What the client itself puts before its address is not believed.
        lying = await proxy.get("/api/runs", headers=shows(TOKEN, "192.0.2.9, 192.0.2.1"))
    assert [each.status_code for each in (guesser, other, again, lying)] == [429, 200, 429, 429]


async def test_nobody_else_can_say_where_they_come_from() -> None:
    async with (
        serving_guarded(["192.0.2.1"]) as service,
        httpx.AsyncClient(base_url=service.url) as client,
    ):
        for number in range(2):
            headers = shows(f"guess {number}", f"192.0.2.{number}")
            assert (await client.get("/api/runs", headers=headers)).status_code == 401
        assert (await client.get("/api/runs", headers=shows(TOKEN, "192.0.2.7"))).status_code == 429


@pytest.mark.parametrize(("proxies", "encrypted"), [(PROXY, True), ([], False)])
async def test_whether_the_client_came_over_tls_is_believed_of_a_trusted_proxy(
    proxies: list[str], encrypted: bool
) -> None:
    async with (
        serving(token=TOKEN, trusted_proxies=proxies) as service,
        httpx.AsyncClient(base_url=service.url, headers=forwarded("192.0.2.1")) as client,
    ):
        response = await client.post("/api/session", json={"token": TOKEN})
    assert response.status_code == 204
    assert ("strict-transport-security" in response.headers) is encrypted
    assert ("secure" in response.headers["set-cookie"].lower()) is encrypted


async def test_many_strangers_may_come_through_a_trusted_proxy() -> None:
    limits = Limits(strangers_per_address=1)
    async with serving(token=TOKEN, limits=limits, trusted_proxies=PROXY) as service:
        clients = [httpx.AsyncClient(base_url=service.url) for _ in range(3)]
        statuses = [(await each.get("/healthz")).status_code for each in clients]
        for each in clients:
            await each.aclose()
    assert statuses == [200, 200, 200]


@pytest.mark.parametrize(
    ("guessers", "same", "other"),
    [
        # What is no address is nobody's, whatever it is.
        (["made-up-0", "made-up-1"], "made-up-2", "192.0.2.1"),
        # Of IPv6 a customer has a whole network.
        (["2001:db8::0", "2001:db8::1"], "2001:db8::ffff:7", "2001:db8:0:1::1"),
    ],
)
async def test_whoever_has_many_addresses_of_one_kind_is_one_guesser(
    guessers: list[str], same: str, other: str
) -> None:
    async with (
        serving_guarded(PROXY) as service,
        httpx.AsyncClient(base_url=service.url) as proxy,
    ):
        for number, address in enumerate(guessers):
            response = await proxy.get("/api/runs", headers=shows(f"guess {number}", address))
            assert response.status_code == 401
        answers = [await proxy.get("/api/runs", headers=shows(TOKEN, at)) for at in (same, other)]
    assert [each.status_code for each in answers] == [429, 200]
