"""The question card: what a helper sees and does while a robot waits."""

import pytest
from console_in_browser import OpenPage
from playwright.async_api import expect

from server.composition import Service
from server.runtime.requests import RunRequest
from tasks.intervention import Intervention

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")


async def test_question_is_shown_and_answered_with_a_button(
    service: Service, open_page: OpenPage
) -> None:
    page = await open_page()
    await expect(page.get_by_text("No robot asks anything")).to_be_visible()
    run = await service.runtime.start_run(RunRequest(tree="eket", world="tabletop", speed=5.0))
    await service.runtime.intervene(
        run.id, Intervention.model_validate({"act": "steal", "object": "green_leg"})
    )
    await expect(page.get_by_role("heading", level=2)).to_contain_text("green leg", timeout=20_000)
    await page.get_by_role("button", name="YES").click()
    await expect(page.get_by_role("heading", level=2)).to_be_hidden()
