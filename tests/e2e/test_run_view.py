"""The run view while its run goes on."""

import re

import pytest
from console_in_browser import OpenPage
from console_situations import begin_two_boxes
from playwright.async_api import Page, expect
from run_page import WAIT_MS, told, wait_for_tree

from mend.server.composition import Service
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.views import RunStatus, RunView
from mend.tasks.intervention import Intervention

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")


async def asked_run(service: Service) -> RunView:
    """A run that waits for an answer about the green leg, which somebody has stolen."""
    run = await service.runtime.start_run(RunRequest(tree="eket", world="tabletop", speed=20.0))
    await service.runtime.intervene(
        run.id, Intervention.model_validate({"act": "steal", "object": "green_leg"})
    )
    return run


def status(page: Page) -> object:
    return page.locator(".run-header .badge")


async def test_tree_and_question_are_as_the_service_says_whenever_one_comes(
    service: Service, open_page: OpenPage
) -> None:
    run = await asked_run(service)
    page = await open_page(f"/runs/{run.id}")
    green_leg = page.get_by_role("treeitem", name="green leg")
    await expect(green_leg).to_have_attribute("data-state", "in_dialogue", timeout=WAIT_MS)
    view = await service.runtime.run(run.id)
    await wait_for_tree(page, told(view.nodes, {each.node for each in view.dialogues}))
    owner = view.robots[0]
    await expect(green_leg).to_have_accessible_name(re.compile(f"held by {owner}"))
    # The open question stands beside its run.
    await expect(page.get_by_role("button", name="YES").first).to_be_visible(timeout=WAIT_MS)
    await page.get_by_role("slider", name="Moment of the run").press("Home")
    await expect(page.get_by_role("button", name="YES")).to_have_count(0)
    await page.get_by_role("button", name="Back to live").click()
    await expect(page.get_by_role("button", name="YES").first).to_be_visible()
    # Nothing is lost when the page comes in the middle.
    question = page.get_by_role("log").get_by_text("green leg", exact=False).last
    await expect(question).to_be_visible(timeout=WAIT_MS)
    await page.reload()
    await expect(page.get_by_role("log").get_by_text("begins")).to_be_visible()
    await expect(green_leg).to_have_attribute("data-state", "in_dialogue")


async def test_run_is_followed_to_its_end(service: Service, open_page: OpenPage) -> None:
    run = await begin_two_boxes(service, speed=20.0)
    page = await open_page(f"/runs/{run}")
    await expect(status(page)).to_have_text("finished", timeout=WAIT_MS)
    await expect(page.get_by_text("The end", exact=True)).to_be_visible()
    view = await service.runtime.wait_for_end(run)
    await wait_for_tree(page, told(view.nodes, set(), view.result))


async def test_run_is_paused_resumed_and_once_it_was_asked_aborted(
    service: Service, open_page: OpenPage
) -> None:
    run = await asked_run(service)
    page = await open_page(f"/runs/{run.id}")
    await page.get_by_role("button", name="Pause", exact=True).click()
    await expect(status(page)).to_have_text("paused")
    assert (await service.runtime.run(run.id)).status is RunStatus.PAUSED
    view = await service.runtime.run(run.id)
    await wait_for_tree(page, told(view.nodes, {each.node for each in view.dialogues}))
    await page.get_by_role("button", name="Resume").click()
    await expect(status(page)).to_have_text("running")
    assert (await service.runtime.run(run.id)).status is RunStatus.RUNNING
    await page.get_by_role("button", name="Abort …").click()
    await page.get_by_role("button", name="Let it go on").click()
    await expect(page.get_by_role("dialog")).to_be_hidden()
    assert (await service.runtime.run(run.id)).status is RunStatus.RUNNING
    await page.get_by_role("button", name="Abort …").click()
    await page.get_by_role("button", name="Abort the run").click()
    await expect(status(page)).to_have_text("aborted")
    await expect(page.get_by_role("button", name="Pause", exact=True)).to_have_count(0)
    assert (await service.runtime.run(run.id)).status is RunStatus.ABORTED


async def test_unknown_run_is_said_to_be_unknown(open_page: OpenPage) -> None:
    page = await open_page("/runs/00000000-0000-4000-8000-000000000000")
    await expect(page.get_by_role("heading", name="This run cannot be shown")).to_be_visible()


async def test_a_phone_shows_one_part_at_a_time_and_no_page_is_wider_than_its_window(
    service: Service, open_page: OpenPage
) -> None:
    run = await asked_run(service)
    page = await open_page(f"/runs/{run.id}", viewport={"width": 360, "height": 800})
    await expect(page.get_by_role("tree")).to_be_visible()
    await page.get_by_role("tab", name="Tree").focus()
    await page.keyboard.press("ArrowRight")
    await expect(page.get_by_role("region", name="Scene")).to_be_visible()
    await expect(page.get_by_role("tree")).to_have_count(0)
    await page.keyboard.press("ArrowRight")
    await expect(page.get_by_role("region", name="Timeline")).to_be_visible()
    await page.keyboard.press("ArrowRight")
    await expect(page.get_by_role("log")).to_be_visible()
    await page.get_by_role("tab", name="Tree").click()
    await expect(page.get_by_role("tree")).to_be_visible()
    await page.get_by_role("button", name="One event back").click()
    await expect(page.get_by_role("button", name="Back to live")).to_be_visible()
    for width in (360, 768, 1440):
        await page.set_viewport_size({"width": width, "height": 800})
        await expect(page.get_by_role("tree")).to_be_visible()
        assert await page.evaluate("document.documentElement.scrollWidth") <= width
