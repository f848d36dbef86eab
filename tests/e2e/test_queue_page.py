"""Several questions at once: what each entry tells, those alike as one, and one press for all."""

import re

import pytest
from console_in_browser import Stage
from playwright.async_api import expect

pytestmark = pytest.mark.asyncio(loop_scope="session")

HELD_MS = 3_100


async def test_an_entry_tells_robot_task_place_time_and_attempt(lasting_stage: Stage) -> None:
    page = await lasting_stage.open_page()
    await lasting_stage.runs.open(lasting_stage.run, "dropped", "yellow_bar")
    await lasting_stage.runs.open(lasting_stage.run, "missed", "blue_leg")
    entry = page.locator(".queue-item", has_text="the blue leg is not in it")
    for told in ("PR2", "eket", "To blue leg place.", "Attempt 1 of 3", re.compile(r"[01]:\d\d")):
        await expect(entry).to_contain_text(told)


async def test_what_expires_first_stands_first(lasting_stage: Stage) -> None:
    page = await lasting_stage.open_page()
    await lasting_stage.runs.open(lasting_stage.run, "dropped", "yellow_bar")
    lasting_stage.runs.deadline_s = 30.0
    await lasting_stage.runs.open(lasting_stage.run, "missed", "blue_leg")
    await expect(page.locator(".queue-item")).to_contain_text(["blue leg", "yellow bar"])


async def test_the_same_question_about_several_parts_is_one_entry_that_opens(
    lasting_stage: Stage,
) -> None:
    page = await lasting_stage.open_page()
    await lasting_stage.runs.open(lasting_stage.run, "missed", "blue_leg")
    for part in ("yellow_bar", "pink_bar"):
        await lasting_stage.runs.open(lasting_stage.run, "dropped", part)
    batch = page.locator(".queue-batch")
    await expect(batch.locator("summary")).to_contain_text("2× Put it back on the table")
    await expect(batch.locator(".queue-item").first).to_be_hidden()
    await batch.locator("summary").click()
    await batch.locator(".queue-item", has_text="pink bar").click()
    await expect(page.get_by_role("heading", level=2).first).to_have_text(
        "Put the pink bar back on the table"
    )


async def test_nobody_has_to_refuse_them_one_by_one(stage: Stage) -> None:
    page = await stage.open_page()
    for part in ("yellow_bar", "pink_bar", "blue_leg"):
        await stage.runs.open(stage.run, "dropped", part)
    for_all = page.get_by_role("group", name="All 3 at once")
    await expect(for_all.get_by_role("button")).to_have_text(["Not now, all 3"])
    await page.clock.install()
    await for_all.get_by_role("button", name="Not now, all 3").click()
    await for_all.get_by_role("button", name="Undo").click()
    await page.clock.fast_forward(HELD_MS)
    assert len(stage.runs.questions()[0].questions) == 3
    await for_all.get_by_role("button", name="Not now, all 3").click()
    await page.clock.fast_forward(HELD_MS)
    await expect(page.get_by_text("No robot asks anything")).to_be_visible()
    assert stage.runs.questions() == []
