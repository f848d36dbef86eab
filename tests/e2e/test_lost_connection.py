"""A connection that is lost in the middle of a question."""

import pytest
from console_in_browser import Stage
from playwright.async_api import expect

pytestmark = pytest.mark.asyncio(loop_scope="session")


async def test_question_survives_a_lost_connection(stage: Stage) -> None:
    page = await stage.open_page()
    dialogue = await stage.runs.open(stage.run, "dropped")
    await expect(page.locator(".answer.yes")).to_be_enabled()
    await page.context.set_offline(True)
    await expect(page.get_by_text("No connection to the service.")).to_be_visible()
    await expect(page.locator(".answer.yes")).to_be_disabled()
    await page.context.set_offline(False)
    await expect(page.get_by_text("No connection to the service.")).to_be_hidden(timeout=60_000)
    await page.locator(".answer.yes").click()
    await expect(page.get_by_text("It goes on by itself as soon as")).to_be_visible()
    assert stage.runs.dialogue_now(dialogue).answered_by == "anna"


async def test_what_happened_meanwhile_is_there_afterwards(stage: Stage) -> None:
    page = await stage.open_page()
    dialogue = await stage.runs.open(stage.run, "dropped")
    await expect(page.locator(".answer.yes")).to_be_enabled()
    await page.context.set_offline(True)
    await expect(page.get_by_text("No connection to the service.")).to_be_visible()
    prompt = stage.runs.dialogue_now(dialogue).prompt
    assert prompt is not None
    await stage.runs.dialogues.answer(dialogue, prompt.prompt, "no", "bob")
    await page.context.set_offline(False)
    heading = page.get_by_role("heading", name="Will you place the yellow bar")
    await expect(heading).to_be_visible(timeout=60_000)
    await expect(page.locator(".answer.no")).to_be_enabled()


async def test_closed_meanwhile_is_said(stage: Stage) -> None:
    page = await stage.open_page()
    dialogue = await stage.runs.open(stage.run, "dropped")
    await expect(page.locator(".answer.yes")).to_be_enabled()
    await page.context.set_offline(True)
    await expect(page.get_by_text("No connection to the service.")).to_be_visible()
    await stage.runs.call(dialogue, "put_right:in_reach:appeared")
    await page.context.set_offline(False)
    told = page.get_by_text("No longer needed, by what the robot sees")
    await expect(told).to_be_visible(timeout=60_000)
    await expect(page.locator(".answer")).to_have_count(0)
