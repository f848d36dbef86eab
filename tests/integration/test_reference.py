"""The API's reference at /docs is whole without any other host."""

import re
from collections.abc import AsyncIterator

import httpx
import pytest
from service_under_test import build


@pytest.fixture
async def client() -> AsyncIterator[httpx.AsyncClient]:
    service = build()
    async with service.client() as client:
        yield client
    service.journal.close()


async def test_every_file_of_the_page_comes_from_here(client: httpx.AsyncClient) -> None:
    page = await client.get("/docs")
    assert page.headers["content-type"].startswith("text/html")
    referred = re.findall(r'(?:src|href)="([^"]*)"', page.text)
    files = [each for each in referred if not each.startswith("data:")]
    assert len(files) == 3
    for each in files:
        assert re.fullmatch(r"/docs/[\w.-]+", each)
        assert (await client.get(each)).status_code == 200
    assert "//" not in page.text.replace("<!doctype html>", "")


async def test_the_page_may_load_nothing_from_elsewhere(client: httpx.AsyncClient) -> None:
    for path in ("/docs", "/docs/start.js", "/docs/swagger-ui.css"):
        policy = (await client.get(path)).headers["content-security-policy"]
        sources = {word for rule in policy.split(";") for word in rule.split()[1:]}
        assert sources == {"'self'", "'none'", "data:"}
        assert "script-src 'self'" in policy


async def test_style_and_start_name_no_other_host(client: httpx.AsyncClient) -> None:
    style = (await client.get("/docs/swagger-ui.css")).text
    loaded = re.findall(r"url\(\s*[\"']?([^\"')]*)|@import", style)
    assert all(each.startswith("data:") for each in loaded)
    start = (await client.get("/docs/start.js")).text
    assert 'url: "/openapi.json"' in start
    assert "//" not in start


async def test_another_file_is_not_there(client: httpx.AsyncClient) -> None:
    assert (await client.get("/docs/redoc.standalone.js")).status_code == 404
