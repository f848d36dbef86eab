"""An operator steers a run from its page: it waits at a breakpoint, and goes on when told."""

import re
from collections.abc import Awaitable, Callable

import pytest
from console_situations import begin_steered
from playwright.async_api import Locator, Page, expect

from mend.server.composition import Service

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

Reopen = Callable[[str], Awaitable[Page]]


def node(page: Page, name: str) -> Locator:
    return page.get_by_role("treeitem", name=name)


async def test_a_breakpoint_is_set_waited_for_and_let_go_with_the_keys(
    lasting_service: Service, reopen: Reopen
) -> None:
    run = await begin_steered(lasting_service)
    page = await reopen(f"/runs/{run}")
    log = page.get_by_role("log")
    waits = page.get_by_role("group", name="Waits to be let go")
    await expect(waits.get_by_text("with autonomy off it asks first")).to_be_visible()
    await node(page, "blue box").focus()
    await page.keyboard.press("Enter")
    await page.get_by_label("Why").fill("the glue is wet")
    menu = page.get_by_role("group", name="Steer blue box")
    await menu.get_by_role("button", name="Set breakpoint").focus()
    await page.keyboard.press("Enter")
    await expect(node(page, "blue box")).to_have_accessible_name(re.compile("a breakpoint before"))
    await expect(page.get_by_label("Why")).to_have_value("")
    await expect(
        log.get_by_text("sets a breakpoint before blue box (the glue is wet)")
    ).to_be_visible()
    await page.get_by_label("Autonomy").select_option("full")
    await expect(
        waits.get_by_text(re.compile("breakpoint set by .* \\(the glue is wet\\)"))
    ).to_be_visible()
    await expect(node(page, "red box")).to_have_attribute("data-state", "done")
    # Whoever is at home sees it, and may let it go there.
    await page.goto("/")
    await expect(page.get_by_text("one waits to be let go")).to_be_visible()
    await page.get_by_role("button", name="Go on: blue box").click()
    await expect(page.get_by_text("one waits to be let go")).to_have_count(0)
    await page.goto(f"/runs/{run}")
    await expect(node(page, "blue box")).to_have_attribute("data-state", "done")
    await expect(page.get_by_text("finished", exact=True)).to_be_visible()
    assert (await lasting_service.runtime.run_summary(run)).status == "finished"
