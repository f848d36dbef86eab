"""At an address where there is nothing a browser gets a page, and a program a problem document."""

from collections.abc import AsyncIterator

import httpx
import pytest
from service_under_test import TOKEN, ServiceUnderTest, serving

from mend.server.api.console import BUILT

RIGHT = {"Authorization": f"Bearer {TOKEN}"}
BROWSER = {"Accept": "text/html,application/xhtml+xml,*/*;q=0.8"}

needs_console = pytest.mark.skipif(
    not (BUILT / "index.html").is_file(), reason="the console is not built (make console)"
)


@pytest.fixture
async def service() -> AsyncIterator[ServiceUnderTest]:
    async with serving(token=TOKEN) as service:
        yield service


@needs_console
@pytest.mark.parametrize("address", ["/x", "/x/y", "/runs/a/b", "/robots"])
async def test_a_browser_gets_the_page_which_says_so(
    service: ServiceUnderTest, address: str
) -> None:
    async with httpx.AsyncClient(base_url=service.url) as client:
        page = await client.get(address, headers=BROWSER)
        home = await client.get("/")
    assert page.status_code == 404
    assert page.headers["content-type"].startswith("text/html")
    assert page.text == home.text
    assert page.headers["content-security-policy"] == home.headers["content-security-policy"]


@pytest.mark.parametrize(
    ("address", "headers"),
    [("/x/y", {}), ("/x/y", {"Accept": "application/json"}), ("/api/x", BROWSER)],
)
async def test_a_program_gets_a_problem_document(
    service: ServiceUnderTest, address: str, headers: dict[str, str]
) -> None:
    async with httpx.AsyncClient(base_url=service.url, headers=RIGHT) as client:
        answer = await client.get(address, headers=headers)
    assert answer.status_code == 404
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.json()["detail"] == f"there is nothing at {address}"


async def test_nothing_is_posted_to_a_page(service: ServiceUnderTest) -> None:
    async with httpx.AsyncClient(base_url=service.url, headers=RIGHT) as client:
        answer = await client.post("/x/y", headers=BROWSER)
    assert answer.status_code == 404
    assert answer.headers["content-type"] == "application/problem+json"
