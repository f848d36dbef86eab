"""Coming into the console: the token once, then a name."""

import pytest
from console_in_browser import TOKEN
from playwright.async_api import Browser, expect

from mend.server.composition import Service

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")


async def test_helper_comes_in_with_the_token_and_a_name(
    browser: Browser, service: Service
) -> None:
    page = await browser.new_page()
    await page.goto(service.url)
    await page.get_by_label("Token").fill("wrong")
    await page.get_by_role("button", name="Sign in").click()
    await expect(page.get_by_role("alert")).to_have_text("This is not the token.")
    await page.get_by_label("Token").fill(TOKEN)
    await page.get_by_role("button", name="Sign in").click()
    await page.get_by_label("Your name").fill("anna")
    await page.get_by_role("button", name="Begin").click()
    await expect(page.get_by_role("status").first).to_have_text("Connected")
    await page.reload()
    await expect(page.get_by_role("link", name="anna")).to_be_visible()
    await page.close()
