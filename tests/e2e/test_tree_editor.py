"""Changing a task tree in its drawing: by keys, by dragging and in the form, beside its text."""

import pytest
import pytest_asyncio
from console_in_browser import OpenPage
from legs_and_bars import SCENE
from playwright.async_api import Locator, Page, expect

from mend.server.composition import Service

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

SHELF = """\
name: shelf
scene: legs_and_bars  # the small one
tree:
  then:
    # It carries all else.
    - {behavior: pick_and_place, object: green_leg, place: green_leg}
    - name: bars
      and:
        - {behavior: pick_and_place, object: pink_bar, place: pink_bar}  # pink
        - {behavior: pick_and_place, object: yellow_bar, place: yellow_bar}
"""
LEG, PINK, YELLOW = (f"{line}\n" for line in SHELF.splitlines() if "pick_and_place" in line)


@pytest_asyncio.fixture(autouse=True, loop_scope="session")
async def bench(service: Service) -> None:
    """A scene in which a check takes a moment."""
    await service.library.scenes.save("legs_and_bars", SCENE)


def text_of(page: Page) -> Locator:
    return page.get_by_label("The file of the task tree")


def drawn(page: Page, name: str) -> Locator:
    return page.get_by_role("tree").get_by_role("treeitem", name=name)


async def open_shelf(open_page: OpenPage) -> Page:
    page = await open_page("/edit")
    await text_of(page).fill(SHELF)
    await expect(page.get_by_role("status").filter(has_text="No mistakes")).to_be_visible()
    await drawn(page, "green leg").click()
    return page


async def test_keys_change_the_text_and_all_is_undone_in_one_history(open_page: OpenPage) -> None:
    page = await open_shelf(open_page)
    await page.keyboard.press("ArrowDown")
    await page.keyboard.press("ArrowDown")
    await expect(drawn(page, "pink bar")).to_be_focused()
    await page.keyboard.press("Alt+ArrowDown")
    swapped = SHELF.replace(PINK + YELLOW, YELLOW + PINK)
    await expect(text_of(page)).to_have_value(swapped)
    await expect(drawn(page, "pink bar")).to_be_focused()
    await page.keyboard.press("Delete")
    without = SHELF.replace(PINK, "")
    await expect(text_of(page)).to_have_value(without)
    await expect(drawn(page, "yellow bar")).to_be_focused()

    await text_of(page).press("Control+End")
    await page.keyboard.type("# Done.")
    await expect(text_of(page)).to_have_value(f"{without}# Done.")
    await page.keyboard.press("Control+z")
    await expect(text_of(page)).to_have_value(without)
    await drawn(page, "yellow bar").press("Control+z")
    await expect(text_of(page)).to_have_value(swapped)
    await page.get_by_role("button", name="Undo").click()
    await expect(text_of(page)).to_have_value(SHELF)
    await page.get_by_role("button", name="Redo").click()
    await expect(text_of(page)).to_have_value(swapped)


async def test_a_node_is_dragged_where_the_mark_shows(open_page: OpenPage) -> None:
    page = await open_shelf(open_page)
    await drawn(page, "green leg").hover()
    await page.mouse.down()
    target = await drawn(page, "yellow bar").bounding_box()
    assert target is not None
    x, bottom = target["x"] + target["width"] / 2, target["y"] + target["height"]
    await page.mouse.move(x, bottom - 4, steps=4)
    await expect(page.get_by_role("status").filter(has_text="after yellow bar")).to_be_visible()
    await expect(page.locator(".dragging .drop")).to_be_visible()
    await page.mouse.up()
    moved = "        # It carries all else.\n    " + LEG
    await expect(text_of(page)).to_have_value(
        SHELF.replace("    # It carries all else.\n" + LEG, "") + moved
    )
    await expect(drawn(page, "green leg")).to_have_attribute("data-path", "/0/2")


async def test_a_mistake_is_shown_at_its_node_and_put_right_in_the_form(
    open_page: OpenPage,
) -> None:
    page = await open_shelf(open_page)
    wrong = SHELF.replace("place: green_leg", "place: gren_leg")
    await text_of(page).fill(wrong)
    await expect(drawn(page, "green leg")).to_have_class("node behavior defined wrong")
    form = page.get_by_role("form", name="The selected node")
    await expect(form.get_by_text("has no place 'gren_leg'")).to_be_visible()
    place = form.get_by_label("place", exact=True)
    await place.fill("green_leg")
    await place.press("Enter")
    await expect(text_of(page)).to_have_value(SHELF)
    await expect(drawn(page, "green leg")).not_to_have_class("wrong")

    await page.get_by_role("button", name="Add a leaf").click()
    added = "    - {behavior: pick_and_place, object: blue_leg, place: blue_leg}\n"
    await expect(text_of(page)).to_have_value(SHELF.replace(LEG, LEG + added))
    await form.get_by_label("Name of this node").fill("last_leg")
    await form.get_by_label("Name of this node").press("Enter")
    await expect(drawn(page, "last leg")).to_be_visible()
    await page.get_by_role("button", name="Wrap in OR").click()
    await expect(text_of(page)).to_have_value(
        SHELF.replace(
            LEG,
            LEG + "    - or:\n        " + added.strip().replace("{", "{name: last_leg, ") + "\n",
        )
    )
