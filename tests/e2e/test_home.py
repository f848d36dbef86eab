"""The home page: a demo for who is new, and what goes on besides questions."""

from uuid import UUID

import pytest
from console_in_browser import TOKEN, OpenPage
from console_situations import ask, fleet
from gated_robot import gated_robot
from playwright.async_api import expect
from test_at_a_glance import fail

from mend.server.composition import Service
from mend.server.runtime.requests import RunRequest

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")


async def test_a_newcomer_has_answered_a_robot_with_two_presses(
    service: Service, open_page: OpenPage
) -> None:
    page = await open_page()
    await page.get_by_role("button", name="Try a demo").click()
    help_ = page.get_by_role("button", name="Put it back on the table")
    await expect(help_).to_be_enabled()
    await expect(page.get_by_role("button", name="Try a demo")).to_have_count(0)
    await help_.click()
    # What the button says comes true: a simulated person does it.
    told = page.get_by_role("status", name="What became of questions")
    await expect(told).to_contain_text("back on the table")
    (run,) = await (await page.request.get("/api/runs")).json()
    await service.runtime.abort(UUID(run["id"]))
    answers = page.get_by_role("region", name="Answered last")
    await expect(answers.get_by_role("listitem").first).to_contain_text("anna")
    await answers.get_by_role("link").first.click()
    await page.wait_for_url(f"**/runs/{run['id']}?t=*")


async def test_beneath_a_question_stands_what_else_goes_on(
    service: Service, open_page: OpenPage
) -> None:
    page = await open_page()
    await fail(service)
    await expect(page.get_by_text("not all is well")).to_be_visible()
    run = await ask(service)
    await expect(page.get_by_role("button", name="YES")).to_be_visible()
    await page.get_by_text("What else goes on · one thing is wrong").click()
    await expect(page.get_by_role("listitem").filter(has_text="eket failed")).to_be_visible()
    for name in ("Runs that go on", "Robots"):
        listed = page.get_by_role("region", name=name).get_by_role("listitem")
        await expect(listed).to_have_count(1)
        await expect(listed).to_contain_text("Asks a question")
        await expect(listed.get_by_role("link")).to_have_attribute("href", f"/runs/{run}")


async def test_what_people_of_a_building_want_is_listed(
    service: Service, open_page: OpenPage
) -> None:
    page = await fleet(service, open_page)
    await page.goto("/")
    if await page.get_by_text("What else goes on").count() > 0:
        await page.get_by_text("What else goes on").click()
    wanted = page.get_by_role("region", name="Requests in").get_by_role("listitem")
    await expect(wanted.first).to_be_visible()
    await expect(page.get_by_role("button", name="Try a demo")).to_have_count(0)


async def test_a_robot_that_is_gone_calls_on_every_page_until_somebody_knows(
    service: Service, open_page: OpenPage
) -> None:
    page = await open_page("/runs")
    async with gated_robot(service.robots_url, TOKEN, "demo") as demo:
        demo.may_look.clear()
        run = await service.runtime.start_run(
            RunRequest(tree="eket", world="live", robots=["demo"])
        )
        await page.goto("/")
        await expect(page.get_by_text("One run goes on.")).to_be_visible()
        await page.get_by_role("link", name="Runs", exact=True).click()
    told = page.get_by_role("status").filter(has_text="demo is gone, and its run waits for it.")
    await expect(told).to_be_visible()
    await expect(page).to_have_title("(1) Mend")
    await expect(told.get_by_role("link", name="Show the run")).to_have_attribute(
        "href", f"/runs/{run.id}"
    )
    await told.get_by_role("button", name="I know").click()
    await expect(told).to_have_count(0)
    await expect(page).to_have_title("Mend")
    await page.get_by_role("link", name="Questions", exact=True).click()
    await expect(page.get_by_text("not all is well")).to_be_visible()
    listed = page.get_by_role("region", name="Robots").get_by_role("listitem")
    await expect(listed.filter(has_text="demo")).to_contain_text("Gone")
