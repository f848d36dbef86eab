"""What went wrong some time ago is found by what people know of it, and shown to others."""

import re
from uuid import UUID

import pytest
from console_in_browser import OpenPage
from playwright.async_api import expect
from recorded_service import recorded_events

from mend.server.composition import Service
from mend.server.journal.journal import Entry

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

PATIENCE_MS = 60_000


async def test_an_old_fault_of_a_part_is_found_and_its_moment_shared_in_four_actions(
    service: Service, open_page: OpenPage
) -> None:
    await service.journal.append(Entry(events=recorded_events()))
    page = await open_page("/")
    await page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    await page.get_by_role("link", name="Issues").click()
    await page.get_by_role("searchbox", name="Search").fill("purple top")
    row = page.get_by_role("list", name="Issues").get_by_role("listitem")
    await expect(row).to_have_count(1)
    await row.get_by_role("link").click()
    await expect(page).to_have_url(re.compile(r"/runs/f4e034c6-.*[?]t=62[.]5"))
    copy = page.get_by_role("button", name="Copy link")
    await copy.click(timeout=PATIENCE_MS)
    await expect(page.get_by_role("button", name="Link copied")).to_be_visible()
    link = await page.evaluate("navigator.clipboard.readText()")
    assert re.search(r"/runs/f4e034c6-[0-9a-f-]+[?]t=62[.]5$", link), link
    await page.goto(link)
    await expect(page.get_by_role("main")).to_contain_text(
        "purple top, pick and place, in dialogue", timeout=PATIENCE_MS
    )


async def test_issues_are_narrowed_by_day_and_the_search_is_cleared(
    service: Service, open_page: OpenPage
) -> None:
    await service.journal.append(Entry(events=recorded_events()))
    page = await open_page("/issues")
    row = page.get_by_role("list", name="Issues").get_by_role("listitem")
    await expect(row).to_have_count(6)
    await page.get_by_label("From").fill("2026-11-23")
    await expect(page.get_by_text("No issue is like this.")).to_be_visible()
    await page.get_by_label("From").fill("2026-11-20")
    await page.get_by_label("To", exact=True).fill("2026-11-22")
    await expect(row).to_have_count(6)
    await page.get_by_role("searchbox", name="Search").fill("yellow_bar")
    await expect(row).to_have_count(2)
    await page.get_by_role("button", name="Clear").click()
    await expect(row).to_have_count(6)


async def test_a_run_is_found_by_words_and_done_again_with_its_seed(
    service: Service, open_page: OpenPage
) -> None:
    await service.journal.append(Entry(events=recorded_events()))
    page = await open_page("/runs")
    row = page.get_by_role("list", name="Runs").get_by_role("listitem")
    await page.get_by_role("searchbox", name="Search").fill("nothing of this name")
    await expect(page.get_by_text("No runs to show here")).to_be_visible()
    await page.get_by_role("searchbox", name="Search").fill("EKET")
    await row.get_by_role("link").click()
    await page.get_by_role("button", name="Run again").click(timeout=PATIENCE_MS)
    dialog = page.get_by_role("dialog")
    await expect(dialog).to_contain_text("tabletop")
    seed = await dialog.get_by_label("Seed").input_value()
    await dialog.get_by_role("button", name="Start the run").click()
    await expect(page).not_to_have_url(re.compile("/runs/f4e034c6-"))
    await page.wait_for_url("**/runs/*-*")
    run = await service.runtime.run_summary(UUID(page.url.rsplit("/", 1)[1]))
    assert (run.tree, str(run.seed)) == ("eket", seed)
