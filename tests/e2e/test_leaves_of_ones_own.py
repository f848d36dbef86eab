"""A person does a leaf themselves: they say so in the console, and only a robot says it is done."""

import re

import pytest
from console_in_browser import OpenPage
from console_situations import begin_two_boxes, taken_leaf
from hearing_browser import give_ear
from playwright.async_api import Locator, Page, expect
from two_boxes import BLUE

from mend.server.composition import Service
from mend.tasks.intervention import Intervention

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

PLACE = Intervention.model_validate({"act": "place", "object": "blue_box", "place": "blue_box"})


def blue_box(page: Page) -> Locator:
    return page.get_by_role("treeitem", name="blue box")


async def test_what_somebody_takes_is_done_when_it_is_seen(
    service: Service, open_page: OpenPage
) -> None:
    run = await begin_two_boxes(service)
    page = await open_page(f"/runs/{run}", drawn=True)
    log = page.get_by_role("log")
    await blue_box(page).click()
    await page.get_by_role("button", name="I do this: blue box").click()
    await expect(page.get_by_text(re.compile("You are doing blue box, until"))).to_be_visible()
    await expect(blue_box(page)).to_have_accessible_name(re.compile("being done by anna"))
    await expect(log.get_by_text("has taken blue box")).to_be_visible()
    await expect(page.locator(".scene-name", has_text="blue box · anna")).to_have_count(1)
    await expect(page.get_by_role("button", name="I do this")).to_have_count(0)
    await expect(page.get_by_text("anna has taken it.")).to_be_visible()
    await expect(log.get_by_text("blue box is done")).to_have_count(0)
    await service.runtime.intervene(run, PLACE)
    await expect(log.get_by_text("blue box is done by the human")).to_be_visible()
    await expect(blue_box(page)).to_have_attribute("data-state", "done")
    await expect(page.get_by_text("You are doing blue box")).to_have_count(0)
    await expect(page.get_by_text("Done, and no robot has started it.")).to_be_visible()
    assert next(each for each in (await service.runtime.run(run)).nodes if each.node == BLUE).done


async def test_who_gives_it_back_is_not_at_it_any_more(
    service: Service, open_page: OpenPage
) -> None:
    page = await taken_leaf(service, open_page)
    other = await open_page(page.url, "bert")
    await expect(other.get_by_text("anna is doing blue box")).to_be_visible()
    await expect(other.get_by_role("button", name="Give it back")).to_have_count(0)
    await page.get_by_role("button", name="Give it back").click()
    await expect(page.get_by_text("You have given blue box back.")).to_be_visible()
    await expect(other.get_by_text("anna is doing blue box")).to_have_count(0)
    await expect(blue_box(other)).not_to_have_attribute("data-state", "done")


async def test_words_that_are_not_understood_are_answered_with_what_to_say(
    service: Service, open_page: OpenPage
) -> None:
    page = await open_page(f"/runs/{await begin_two_boxes(service)}")
    await page.get_by_label("Choose a leaf that waits, or say it").fill("make coffee")
    await page.keyboard.press("Enter")
    await expect(page.get_by_text("say 'I do the ...'")).to_be_visible()


async def test_a_leaf_is_taken_and_given_back_by_voice(
    service: Service, open_page: OpenPage
) -> None:
    # The robot is in no hurry: on a busy machine the page may be.
    page = await open_page(f"/runs/{await begin_two_boxes(service, speed=0.25)}")
    await give_ear(page, ["perhaps", "I do the blue box.", "I give the blue box back"])
    await page.reload()
    await page.get_by_role("button", name="Speak").click()
    await expect(page.get_by_text("say 'I do the ...'")).to_be_visible()
    await page.get_by_role("button", name="Speak").click()
    await expect(page.get_by_text(re.compile("You are doing blue box, until"))).to_be_visible()
    await page.get_by_role("button", name="Speak").click()
    await expect(page.get_by_text("You have given blue box back.")).to_be_visible()
    await expect(blue_box(page)).not_to_have_attribute("data-state", "done")
