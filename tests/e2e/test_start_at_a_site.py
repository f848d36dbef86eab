"""Starting a run at a site that is open, and seeing at which one it is."""

import pytest
from console_in_browser import OpenPage
from playwright.async_api import expect
from two_boxes import BENCH, BOTH

from mend.server.composition import Service
from mend.server.journal.run_index import RunPage
from mend.server.sites.requests import SiteRequest

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")


async def test_an_open_site_is_chosen_and_told(service: Service, open_page: OpenPage) -> None:
    await service.library.scenes.save("small_bench", BENCH)
    await service.library.trees.save("both", BOTH)
    site = await service.sites.open_site(SiteRequest(scene="small_bench", world="tabletop"))
    name = f"site small bench ({str(site.id)[:8]})"
    page = await open_page("/start/both")
    await page.get_by_role("radio", name=f"{name} A tabletop that stays: no run uses it").check()
    for label in ("Speed", "Seed", "Scenario"):
        await expect(page.get_by_label(label, exact=True)).to_have_count(0)
    await page.get_by_role("button", name="Start the run").click()
    await page.wait_for_url("**/runs/*-*")
    await expect(page.get_by_text(f"at the {name}")).to_be_visible()
    (run,) = await service.runtime.runs(RunPage())
    assert run.robots == [each.robot for each in site.robots]
