"""How often what goes wrong is told with what it counts, and leads to the issues themselves."""

import re

import pytest
from console_in_browser import OpenPage
from playwright.async_api import Page, expect
from recorded_service import recorded_events

from mend.server.composition import Service
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")


async def row(page: Page, table: str, name: str) -> str:
    region = page.get_by_role("region", name=table)
    return await region.get_by_role("row").filter(has_text=name).inner_text()


async def test_faults_are_told_by_part_and_lead_to_the_issues(
    service: Service, open_page: OpenPage
) -> None:
    await service.journal.append(Entry(events=recorded_events()))
    page = await open_page("/issues")
    await page.get_by_role("link", name="Statistics").click()
    await expect(page.get_by_text("6 faults in 6 picks")).to_be_visible()
    assert "no picks" in await row(page, "By part", "purple top")
    assert "333.3" in await row(page, "By kind of fault", "dropped")
    await expect(page.get_by_text(re.compile("NaN|Infinity|undefined"))).to_have_count(0)
    by_part = page.get_by_role("region", name="By part")
    await by_part.get_by_role("link", name="yellow bar").click()
    issues = page.get_by_role("list", name="Issues").get_by_role("listitem")
    await expect(issues).to_have_count(2)


async def test_runs_are_chosen_by_day_and_tree(service: Service, open_page: OpenPage) -> None:
    await service.journal.append(Entry(events=recorded_events()))
    page = await open_page("/statistics")
    await page.get_by_label("Task tree", exact=True).select_option("eket")
    await expect(page.get_by_text("6 faults in 6 picks")).to_be_visible()
    await page.get_by_label("To", exact=True).fill("2026-11-01")
    await expect(page.get_by_text("There is no run like this.")).to_be_visible()
    await page.get_by_role("button", name="Clear").click()
    await expect(page.get_by_text("6 faults in 6 picks")).to_be_visible()


async def test_what_happens_meanwhile_is_counted(service: Service, open_page: OpenPage) -> None:
    page = await open_page("/statistics")
    await expect(page.get_by_text("There is no run like this.")).to_be_visible()
    without = [each for each in recorded_events() if not isinstance(each, ev.StepStarted)]
    await service.journal.append(Entry(events=without))
    figure = page.get_by_role("definition").filter(has_text="no picks")
    await expect(figure).to_contain_text("6 faults")
