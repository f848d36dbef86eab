"""Changing a scene from above: what is done by pointer, keys and form is said in its text."""

import asyncio
import re

import pytest
from console_in_browser import OpenPage
from playwright.async_api import Locator, Page, Route, expect

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
    # Nothing moves in the page once it is known how far arms reach.
    await expect(page.locator(".reach")).to_have_count(1, timeout=60_000)
    await drag(page, place, 0, -120)
    await expect(place).to_have_class("thing place doubtful selected", timeout=60_000)
    await expect(page.get_by_role("form").get_by_text("the arm does not reach")).to_be_visible()
    await page.get_by_role("button", name="Undo").click()
    await expect(text_of(page)).to_have_value(BENCH)
    await expect(page.get_by_role("status").filter(has_text="No mistakes")).to_be_visible()

    await page.get_by_role("button", name="Save").click()
    await expect(page.get_by_role("link", name="Edit bench", exact=True)).to_be_visible()


async def test_what_is_being_typed_stays_when_a_check_comes_back(open_page: OpenPage) -> None:
    typed = asyncio.Event()

    async def check_later(route: Route) -> None:
        await typed.wait()
        await route.continue_()

    page = await open_page("/edit_scene")
    await page.route("**/api/scenes/check**", check_later)
    await text_of(page).fill(BENCH)
    await page.get_by_role("button", name="cup, part").focus()
    forward = page.get_by_label("Forward x (m)")
    await forward.fill("0.5")
    typed.set()
    await expect(page.get_by_role("status").filter(has_text="No mistakes")).to_be_visible()
    await expect(forward).to_have_value("0.5")
    await forward.press("Enter")
    await expect(text_of(page)).to_have_value(BENCH.replace("x: 0.45, y: -0.5", "x: 0.5, y: -0.5"))


async def drag(page: Page, handle: Locator, by_x: float, by_y: float) -> None:
    box = await handle.bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    await page.mouse.move(x, y)
    await page.mouse.down()
    await page.mouse.move(x + by_x, y + by_y, steps=4)
    await page.mouse.up()


async def test_a_part_is_added_made_larger_turned_and_taken_out_with_one_history(
    open_page: OpenPage,
) -> None:
    page = await open_page("/edit_scene")
    await text_of(page).fill(BENCH)
    await page.get_by_role("button", name="cup, part").focus()
    await page.keyboard.press("n")
    name = page.get_by_label("Name of the part")
    await expect(name).to_have_value("part_1")
    await expect(name).to_be_focused()
    await page.keyboard.type("lid")
    form = page.get_by_role("form", name="A new part")
    await form.get_by_label("High z (m)").fill("0.03")
    await form.get_by_label("Colour").fill("#ffffff")
    await form.get_by_role("button", name="Add it").click()
    lid = page.get_by_role("button", name="lid, part")
    await expect(lid).to_be_focused()
    await expect(text_of(page)).to_have_value(re.compile(r"  lid: \{color: \[1, 1, 1\], size: "))
    await expect(page.locator(".reach")).to_have_count(1, timeout=60_000)

    await page.keyboard.press("Alt+ArrowUp")
    await page.keyboard.press("Alt+Shift+ArrowLeft")
    await expect(text_of(page)).to_have_value(re.compile(r"size: \[0.045, 0.059, 0.03\]"))
    await drag(page, page.locator(".handle.resize .knob"), -60, 0)
    wide = page.get_by_label("Wide y (m)")
    await expect(wide).not_to_have_value("0.059")
    await drag(page, page.locator(".handle.turn .knob"), -200, 26)
    await expect(text_of(page)).to_have_value(re.compile(r"  lid: .*yaw: "))
    turned = float(await page.get_by_label("Turned left (degrees)").input_value())
    assert 60 < turned < 120
    assert turned == pytest.approx(5 * round(turned / 5), abs=0.01)
    await page.keyboard.press("Control+z")
    await expect(page.get_by_label("Turned left (degrees)")).to_have_value("0")
    await page.keyboard.press("Control+z")
    await expect(wide).to_have_value("0.059")

    await lid.focus()
    await page.keyboard.press("Delete")
    await expect(lid).to_have_count(0)
    await expect(text_of(page)).to_have_value(BENCH)
    await page.get_by_role("button", name="Undo").click()
    await expect(lid).to_have_count(1)


async def test_what_cannot_be_said_in_the_text_is_told_and_problems_stand_in_place(
    open_page: OpenPage,
) -> None:
    page = await open_page("/edit_scene")
    await text_of(page).fill(BENCH)
    await page.get_by_role("button", name="Add a part").click()
    await page.get_by_label("Name of the part").fill("cup")
    await page.keyboard.press("Enter")
    await expect(page.get_by_text("'objects' has a 'cup' already.")).to_be_visible()
    await page.keyboard.press("Escape")
    await expect(page.get_by_role("form", name="A new part")).to_have_count(0)

    cup = page.get_by_role("button", name="cup, part")
    await cup.click()
    await page.get_by_label("Wide y (m)").fill("0.4")
    await page.get_by_label("Wide y (m)").press("Enter")
    await expect(text_of(page)).to_have_value(BENCH.replace("0.06, 0.06]", "0.4, 0.06]"))
    await page.get_by_label("Deep x (m)").fill("0.4")
    await page.get_by_label("Deep x (m)").press("Enter")
    await expect(cup).to_have_class(re.compile("wrong|doubtful"), timeout=60_000)
    await page.get_by_role("button", name="Take out cup", exact=True).click()
    await expect(cup).to_have_count(0)
    await expect(text_of(page)).to_have_value(re.compile("^objects: {}", re.MULTILINE))
