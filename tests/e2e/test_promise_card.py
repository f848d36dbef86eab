"""Whoever promised help sees what the robot sees, and says that it is done or cannot be."""

import re

import pytest
from axe_in_page import WCAG, load_axe, violations
from console_in_browser import Stage, settle
from playwright.async_api import Page, expect

pytestmark = pytest.mark.asyncio(loop_scope="session")

DONE, CANNOT = "Done, look again", "I can’t after all"


async def promised(page: Page) -> None:
    await page.locator(".answer.yes").click()
    await expect(page.get_by_role("button", name=DONE)).to_be_visible()


async def test_at_the_word_that_it_is_done_the_robot_looks_and_says_what_it_sees(
    lasting_stage: Stage,
) -> None:
    page = await lasting_stage.open_page()
    dialogue = await lasting_stage.runs.open(lasting_stage.run, "dropped")
    await promised(page)
    await page.get_by_role("button", name=DONE).click()
    await expect(page.get_by_text("You said that it is done. The robot looks")).to_be_visible()
    await expect(page.get_by_role("button", name=DONE)).to_be_disabled()
    await lasting_stage.runs.see_not_yet(dialogue)
    await expect(
        page.get_by_text("I do not see the yellow bar where I can reach it yet.")
    ).to_be_visible()
    await expect(page.get_by_role("button", name=DONE)).to_be_enabled()
    await page.get_by_role("button", name=DONE).click()
    await lasting_stage.runs.see(dialogue)
    await expect(page.get_by_text("Thank you.").first).to_be_visible()


async def test_a_promise_that_is_taken_back_leads_to_the_next_question(
    lasting_stage: Stage,
) -> None:
    page = await lasting_stage.open_page()
    await lasting_stage.runs.open(lasting_stage.run, "dropped")
    await promised(page)
    await page.get_by_role("button", name=CANNOT).click()
    await expect(page.get_by_role("heading", name="Will you place the yellow bar")).to_be_visible()
    await expect(page.get_by_role("button", name=DONE)).to_have_count(0)


async def test_others_may_say_that_it_is_done_and_not_take_it_back(lasting_stage: Stage) -> None:
    page = await lasting_stage.open_page()
    other = await lasting_stage.open_page(helper="bob")
    await lasting_stage.runs.open(lasting_stage.run, "dropped")
    await promised(page)
    await expect(other.get_by_role("button", name=CANNOT)).to_have_count(0)
    await other.get_by_role("button", name=DONE).click()
    await expect(page.get_by_text("bob said that it is done")).to_be_visible()


async def test_while_help_is_awaited_the_camera_is_shown_as_it_sees_now(
    lasting_stage: Stage,
) -> None:
    page = await lasting_stage.open_page()
    dialogue = await lasting_stage.runs.open(lasting_stage.run, "dropped")
    await promised(page)
    now = page.get_by_alt_text("What the robot's head camera sees now")
    await expect(now).to_be_visible()
    assert ("pr2-0a1b2c3d", "head") in lasting_stage.runs.photographed
    await page.get_by_role("button", name=DONE).click()
    await lasting_stage.runs.see_not_yet(dialogue)
    await expect(page.get_by_text("should be here")).to_be_visible()
    await settle(page)
    await load_axe(page)
    assert await violations(page, WCAG) == []


async def test_a_question_that_is_put_again_shows_what_the_robot_saw_last(
    lasting_stage: Stage,
) -> None:
    page = await lasting_stage.open_page()
    dialogue = await lasting_stage.runs.open(lasting_stage.run, "dropped")
    await promised(page)
    await page.get_by_role("button", name=DONE).click()
    await lasting_stage.runs.see_not_yet(dialogue)
    await lasting_stage.runs.see(dialogue, fulfilled=False)
    await expect(page.get_by_role("heading", name=re.compile("Are you still"))).to_be_visible()
    await expect(page.get_by_alt_text(re.compile("head camera saw when it last"))).to_be_visible()
    await expect(page.get_by_text("At the fault")).to_have_count(0)
    await settle(page)
    await load_axe(page)
    assert await violations(page, WCAG) == []
