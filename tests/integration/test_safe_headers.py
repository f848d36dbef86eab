"""Every answer tells browsers what they must not do with it."""

import re
from collections.abc import AsyncIterator

import httpx
import pytest
from service_under_test import TOKEN, ServiceUnderTest, serving

RIGHT = {"Authorization": f"Bearer {TOKEN}"}


@pytest.fixture
async def service() -> AsyncIterator[ServiceUnderTest]:
    async with serving(token=TOKEN) as service:
        yield service


def policy_of(response: httpx.Response) -> dict[str, str]:
    """The directives of its Content-Security-Policy."""
    directives = response.headers["content-security-policy"].split(";")
    return {name: value for name, _, value in (each.strip().partition(" ") for each in directives)}


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/", 200),
        ("GET", "/icon.svg", 200),
        ("GET", "/docs", 200),
        ("GET", "/docs/swagger-ui.css", 200),
        ("GET", "/openapi.json", 200),
        ("GET", "/healthz", 200),
        ("GET", "/metrics", 200),
        ("GET", "/api/runs", 200),
        ("GET", "/api/session", 200),
        ("GET", "/api/nowhere", 404),
        ("GET", "/assets/nothing.js", 404),
        ("DELETE", "/api/runs", 405),
        ("POST", "/api/runs", 422),
    ],
)
async def test_every_answer_has_them(
    service: ServiceUnderTest, method: str, path: str, status: int
) -> None:
    async with httpx.AsyncClient(base_url=service.url, headers=RIGHT) as client:
        response = await client.request(method, path)
    assert response.status_code == status
    check(response)


def check(response: httpx.Response) -> None:
    assert response.headers["x-content-type-options"] == "nosniff"
    assert response.headers["referrer-policy"] == "no-referrer"
    policy = policy_of(response)
    assert policy["default-src"] == "'none'"
    assert policy["frame-ancestors"] == "'none'"
    assert "strict-transport-security" not in response.headers


async def test_refusals_before_any_route_have_them(service: ServiceUnderTest) -> None:
    async with httpx.AsyncClient(base_url=service.url) as client:
        for response in (
            await client.get("/api/runs"),
            await client.get("/healthz", headers={"Host": "evil.example"}),
            await client.post("/api/runs", headers={"Origin": "https://evil.example"}),
        ):
            assert response.status_code in (401, 421, 403)
            check(response)


async def test_the_answer_to_a_defect_has_them(
    service: ServiceUnderTest, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(service.runs, "runs", lambda: 1 / 0)
    async with httpx.AsyncClient(base_url=service.url, headers=RIGHT) as client:
        response = await client.get("/api/runs")
    assert response.status_code == 500
    check(response)


async def test_the_console_allows_its_own_scripts_and_nothing_else(
    service: ServiceUnderTest,
) -> None:
    async with httpx.AsyncClient(base_url=service.url) as client:
        page = await client.get("/")
        policy = policy_of(page)
        scripts = re.findall(r'<script[^>]*src="([^"]+)"', page.text)
        asset = await client.get(scripts[0])
    assert policy["script-src"] == "'self'"
    assert policy["style-src"] == "'self'"
    assert policy["connect-src"] == "'self'"
    assert policy["base-uri"] == "'none'"
    # What the policy forbids is not there to begin with.
    assert scripts
    assert "<script>" not in page.text
    assert "style=" not in page.text
    check(asset)
