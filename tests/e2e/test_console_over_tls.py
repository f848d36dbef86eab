"""The console on a service that speaks TLS: its WebSocket is encrypted, too, and allowed."""

from pathlib import Path

import pytest
from certificates import make_certificate
from console_in_browser import TOKEN
from playwright.async_api import Browser, expect

from mend.server.composition import open_service
from mend.server.settings import Settings

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")


async def test_helper_signs_in_and_is_connected(browser: Browser, tmp_path: Path) -> None:
    certificate = make_certificate(tmp_path / "tls", "127.0.0.1")
    settings = Settings(
        data_dir=tmp_path,
        port=0,
        token=TOKEN,
        speech_voice="none",
        tls_certificate=certificate.path,
        tls_key=certificate.key,
    )
    async with open_service(settings) as service:
        context = await browser.new_context(base_url=service.url, ignore_https_errors=True)
        page = await context.new_page()
        said: list[str] = []
        page.on("console", lambda message: said.append(message.text))
        await page.goto("/")
        await page.get_by_label("Token").fill(TOKEN)
        await page.get_by_role("button", name="Sign in").click()
        await page.get_by_label("Your name").fill("anna")
        await page.get_by_role("button", name="Begin").click()
        await expect(page.get_by_role("status").first).to_have_text("Connected")
        (cookie,) = await context.cookies()
        assert cookie["secure"]
        assert not [each for each in said if "Content Security Policy" in each]
        await context.close()
