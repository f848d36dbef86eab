"""Starting and finding runs, and what happens to a helper whose session ends."""

import re
from uuid import uuid4

import pytest
from console_in_browser import TOKEN, OpenPage
from playwright.async_api import Page, expect
from recorded_service import recorded_events
from sample_events import WALL_TIME, started

from mend.server.composition import Service
from mend.server.journal.events import RunAborted
from mend.server.journal.journal import Entry
from mend.server.journal.run_index import RunPage
from mend.server.runtime.requests import RunRequest

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

PATIENCE_MS = 60_000
WORKCELL = "workcell A PR2 at a table, simulated with its cameras and contacts."


async def sign_in(page: Page) -> None:
    await page.get_by_label("Token").fill(TOKEN)
    await page.get_by_role("button", name="Sign in").click()


async def test_run_is_started_with_what_was_chosen(service: Service, open_page: OpenPage) -> None:
    page = await open_page("/start/eket")
    await page.get_by_role("radio", name="tabletop").check()
    await page.get_by_role("combobox", name="Scenario").select_option("eket_paper")
    await page.get_by_role("radio", name="The scenario").check()
    await page.get_by_label("Speed").select_option("max")
    await page.get_by_role("spinbutton", name="Seed").fill("7")
    await page.get_by_role("spinbutton", name="Attempts").fill("2")
    await page.get_by_role("button", name="Start the run").click()
    await page.wait_for_url("**/runs/*-*")
    (run,) = await service.runtime.runs(RunPage())
    assert page.url.endswith(f"/runs/{run.id}")
    assert (run.tree, run.world, run.scenario) == ("eket", "tabletop", "eket_paper")
    assert (run.seed, run.speed) == (7, "max")
    options = (await service.runtime.run(run.id)).options
    assert (options["answers"], options["max_attempts"]) == (None, 2)


async def test_refused_start_says_so_at_the_field(open_page: OpenPage) -> None:
    page = await open_page("/start/eket")
    seed = page.get_by_role("spinbutton", name="Seed")
    await seed.fill("-1")
    await page.get_by_role("button", name="Start the run").click()
    await expect(seed).to_have_attribute("aria-invalid", "true")
    await expect(seed).to_have_accessible_description(re.compile("greater than or equal to 0"))
    await page.get_by_role("radio", name="live Real robots").check()
    await seed.fill("1")
    await page.get_by_role("button", name="Start the run").click()
    alert = page.get_by_role("alert").filter(has_text="needs 'robots'")
    await expect(alert).to_have_id("start-robots-mistake")
    await expect(page).to_have_url("/start/eket")


async def test_runs_are_found_by_their_state(service: Service, open_page: OpenPage) -> None:
    await service.journal.append(Entry(events=recorded_events()))
    slow = RunRequest(tree="tea_table", world="tabletop", speed=0.01)
    await service.runtime.start_run(slow)
    page = await open_page("/runs")
    row = page.get_by_role("list", name="Runs").get_by_role("listitem")
    await expect(row).to_have_count(2)
    await expect(row.nth(1)).to_contain_text("Finished", timeout=PATIENCE_MS)
    await expect(row.nth(0)).to_contain_text("tea_table")
    await page.get_by_role("button", name="Finished").click()
    await expect(row).to_have_count(1)
    await expect(row).to_contain_text("The task is done")
    await page.get_by_role("button", name="Going on").click()
    await expect(row).to_contain_text("tea_table")
    await page.get_by_role("button", name="Failed").click()
    await expect(page.get_by_text("No runs to show here")).to_be_visible()


async def test_long_list_of_runs_comes_in_pages(service: Service, open_page: OpenPage) -> None:
    for _ in range(21):
        begun = started(uuid4())
        aborted = RunAborted(time=1.0, wall_time=WALL_TIME, run=begun.run)
        await service.journal.append(Entry(events=[begun, aborted]))
    page = await open_page("/runs")
    row = page.get_by_role("list", name="Runs").get_by_role("listitem")
    await expect(row).to_have_count(20)
    await page.get_by_role("button", name="Older").click()
    await expect(row).to_have_count(1)
    await expect(page.get_by_role("button", name="Older")).to_be_disabled()
    await page.get_by_role("button", name="Newer").click()
    await expect(row).to_have_count(20)


async def test_list_without_runs_invites_to_start_one(open_page: OpenPage) -> None:
    page = await open_page("/runs")
    await page.get_by_role("link", name="Start the first one").click()
    await expect(page.get_by_role("heading", name="Start a run", exact=True)).to_be_visible()


async def test_helper_signs_out_and_in_again(open_page: OpenPage) -> None:
    page = await open_page("/settings")
    await page.get_by_role("button", name="Sign out").click()
    await expect(page.get_by_label("Token")).to_be_visible()
    await expect(page.get_by_text("Your session has ended")).to_have_count(0)
    await sign_in(page)
    await expect(page.get_by_role("heading", name="Settings", exact=True)).to_be_visible()


async def test_session_that_ends_takes_no_text_along(open_page: OpenPage) -> None:
    page = await open_page("/edit/eket")
    text = page.get_by_label("The file of the task tree")
    await expect(text).to_have_value(re.compile("eket_copy"))
    # Once all that it needs has come nothing is asked of the service, until something is typed.
    await expect(page.get_by_role("tree")).to_be_visible()
    await page.wait_for_load_state("networkidle")
    await page.context.clear_cookies()
    await text.fill("name: precious\n")
    await expect(page.get_by_text("Your session has ended, anna")).to_be_visible()
    await sign_in(page)
    await expect(text).to_have_value("name: precious\n")


async def test_lost_connection_is_told_calmly_and_mends_itself(open_page: OpenPage) -> None:
    page = await open_page("/runs")
    await page.context.set_offline(True)
    bar = page.get_by_role("status").filter(has_text="No connection since")
    await expect(bar).to_contain_text("Nothing is lost", timeout=PATIENCE_MS)
    await page.context.set_offline(False)
    await expect(bar).to_have_count(0, timeout=PATIENCE_MS)
    await expect(page.get_by_role("status").filter(has_text="Connected")).to_be_visible()


async def test_whole_way_to_a_run_can_be_gone_with_the_keyboard(open_page: OpenPage) -> None:
    page = await open_page("/trees")
    await expect(page.get_by_role("tree")).to_be_visible()

    async def tab_to(role: str, name: str) -> None:
        for _ in range(60):
            await page.keyboard.press("Tab")
            focused = "each => each === document.activeElement"
            wanted = page.get_by_role(role, name=name, exact=True)  # type: ignore[arg-type]
            if await wanted.count() == 1 and await wanted.evaluate(focused):
                return
        pytest.fail(f"the Tab key does not come to the {role} '{name}'")

    await page.keyboard.press("Tab")
    await expect(page.get_by_role("link", name="Skip to content")).to_be_in_viewport()
    await page.keyboard.press("Enter")
    await tab_to("link", "Start a run")
    await page.keyboard.press("Enter")
    await expect(page.get_by_role("heading", name="Start a run", exact=True)).to_be_visible()
    await tab_to("combobox", "Task tree")
    await tab_to("radio", WORKCELL)
    # The next world, in which a run begins at once.
    await page.keyboard.press("ArrowDown")
    await expect(page.get_by_role("radio", name="tabletop")).to_be_checked()
    await tab_to("button", "Start the run")
    await page.keyboard.press("Enter")
    await page.wait_for_url("**/runs/*-*")
