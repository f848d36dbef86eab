"""The page where nothing is asked tells what goes on and what has failed."""

import pytest
from awaited_events import events_until
from console_in_browser import OpenPage
from playwright.async_api import expect

from mend.server.composition import Service
from mend.server.journal import events as ev
from mend.server.runtime.requests import RunRequest
from mend.tasks.intervention import Intervention

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")


async def fail(service: Service) -> str:
    """A run whose part is stolen, and whose helper refuses everything; the leaf that failed."""
    request = RunRequest(
        tree="eket", world="tabletop", speed=5.0, answers=["no"] * 9, max_attempts=1
    )
    run = await service.runtime.start_run(request)
    steal = Intervention.model_validate({"act": "steal", "object": "green_leg"})
    await service.runtime.intervene(run.id, steal)
    events = await events_until(service, lambda all_: isinstance(all_[-1], ev.RunFailed))
    failed = events[-1]
    assert isinstance(failed, ev.RunFailed)
    assert failed.node is not None
    return next(
        each.name
        for each in events
        if isinstance(each, ev.NodeStarted) and each.node == failed.node
    )


async def test_what_has_failed_is_told_until_somebody_has_looked_at_it(
    service: Service, open_page: OpenPage
) -> None:
    page = await open_page()
    await expect(page.get_by_text("No run goes on.")).to_be_visible()
    leaf = await fail(service)
    await expect(page.get_by_text("No robot asks anything, but not all is well.")).to_be_visible()
    told = page.get_by_role("listitem").filter(has_text="eket failed")
    await told.get_by_role("link").click()
    await page.wait_for_url("**/runs/*-*")
    card = page.locator(".tree .node.failed")
    await expect(card).to_have_count(1)
    await expect(card).to_contain_text(leaf.replace("_", " "))
    await expect(page.locator(".tree .node.eligible, .tree .node.waiting")).to_have_count(0)
    await page.get_by_role("link", name="Mend, to the questions").click()
    await expect(page.get_by_text("No robot asks anything.", exact=True)).to_be_visible()
    await expect(page.get_by_text("No run goes on.")).to_be_visible()
    again = await open_page(helper="bert")
    await expect(again.get_by_text("not all is well")).to_be_visible()
    await again.get_by_role("button", name="Put aside: eket").click()
    await expect(again.get_by_text("No robot asks anything.", exact=True)).to_be_visible()


async def test_what_goes_on_is_told(service: Service, open_page: OpenPage) -> None:
    page = await open_page()
    await service.runtime.start_run(RunRequest(tree="tea_table", world="tabletop", speed=0.01))
    await expect(page.get_by_text("One run goes on.")).to_be_visible()


async def test_an_address_where_there_is_nothing_says_so(open_page: OpenPage) -> None:
    page = await open_page("/x/y")
    await expect(page.get_by_role("heading", name="There is nothing at /x/y")).to_be_visible()
    await page.goto(page.url.replace("/x/y", "/runs/x"))
    await expect(page.get_by_text("There is no run “x”.")).to_be_visible()
