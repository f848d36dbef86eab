"""Changing a scene from above: what is dragged or moved with keys is said in its text."""

import pytest
from console_in_browser import OpenPage
from playwright.async_api import Locator, Page, expect

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

BENCH = """\
name: bench
objects:
  cup:  # the one to be served
    {color: [0.9, 0.1, 0.1], size: [0.05, 0.06, 0.06], pose: {x: 0.45, y: -0.5}}
places:
  cup: {pose: {x: 0.45, y: 0.0}}
"""


def text_of(page: Page) -> Locator:
    return page.get_by_label("The file of the scene")


async def test_a_part_is_moved_undone_and_kept_with_the_limits_in_sight(
    open_page: OpenPage,
) -> None:
    page = await open_page("/edit_scene")
    await text_of(page).fill(BENCH)
    cup = page.get_by_role("button", name="cup, part")
    await cup.focus()
    await page.keyboard.press("ArrowUp")
    await page.keyboard.press("Shift+ArrowLeft")
    await page.keyboard.press("q")
    moved = BENCH.replace("x: 0.45, y: -0.5}", "x: 0.46, y: -0.499, yaw: 0.0873}")
    await expect(text_of(page)).to_have_value(moved)
    await page.keyboard.press("Control+z")
    await expect(text_of(page)).to_have_value(BENCH)

    # The tabletop's arm reaches every place; the workcell's does not.
    place = page.get_by_role("button", name="cup, place")
    box = await place.bounding_box()
    assert box is not None
    await page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    await page.mouse.down()
    await page.mouse.move(box["x"] + box["width"] / 2, box["y"] - 110, steps=3)
    await page.mouse.up()
    await expect(place).to_have_class("thing place doubtful selected", timeout=60_000)
    await expect(page.get_by_role("form").get_by_text("the arm does not reach")).to_be_visible()
    await expect(page.locator(".reach")).to_have_count(1)
    await page.get_by_role("button", name="Undo").click()
    await expect(text_of(page)).to_have_value(BENCH)
    await expect(page.get_by_role("status").filter(has_text="No mistakes")).to_be_visible()

    await page.get_by_role("button", name="Save").click()
    await expect(page.get_by_role("link", name="Edit bench", exact=True)).to_be_visible()
