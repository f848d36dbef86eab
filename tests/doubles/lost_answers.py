"""Answers of the service that never come to a page, though what was asked for is booked."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from playwright.async_api import Page, Route, expect

_REQUESTS = "**/api/requests?*"
_MOST_TRIES, _TRIES_AGAIN_MS = 20, 5_000


@asynccontextmanager
async def answers_lost(page: Page) -> AsyncIterator[None]:
    """Meanwhile the page hears no answer to what it asks robots for. Its clock is installed."""

    async def lose(route: Route) -> None:
        if route.request.method != "POST":
            return await route.continue_()
        await route.fetch()
        await route.abort()

    await page.clock.install()
    await page.route(_REQUESTS, lose)
    yield
    await page.unroute(_REQUESTS)


async def until_it_is_not_known(page: Page) -> None:
    """Let the page try until it says that it does not know whether that was booked."""
    unknown = page.get_by_text("I do not know whether that was booked.")
    for _ in range(_MOST_TRIES):
        await expect(page.get_by_text("I try once more").or_(unknown)).to_be_visible()
        if await unknown.is_visible():
            break
        await page.clock.run_for(_TRIES_AGAIN_MS)
    await expect(unknown).to_be_visible()
