"""A run in a building: its robots on the plan of their floor, and where the one is that asks."""

import re

import pytest
from console_in_browser import OpenPage, settle
from console_situations import begin_rounds, keep_office
from playwright.async_api import Locator, Page, ViewportSize, expect
from test_accessibility import RULES, load_axe, violations

from mend.server.composition import Service
from mend.server.sites.requests import SiteRequest

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

LONG_MS = 60_000
WIDE = ViewportSize(width=1440, height=1100)
NEXT_PICTURE = "() => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 50)))"
# Walls are as they were: what moves on the page is the robot, and not the plan under it.
SPOT = """robot => {
    const mark = robot.querySelector(".plan-mark").getBoundingClientRect();
    const view = robot.closest(".plan-view").getBoundingClientRect();
    return [mark.x - view.x, mark.y - view.y];
}"""
CLEARLY_MOVED_PX = 8
LOOKS = 600
COUNT_CHANGES = """async () => {
    let changes = 0;
    const watch = new MutationObserver((all) => { changes += all.length; });
    const whole = { subtree: true, attributes: true, childList: true, characterData: true };
    watch.observe(document.querySelector(".plan"), whole);
    let frames = 0;
    for (; frames < 60; frames += 1) await new Promise((done) => requestAnimationFrame(done));
    watch.disconnect();
    return changes / frames;
}"""


def robot(page: Page, name: str) -> Locator:
    return page.locator(f".plan-robot[data-robot^={name}]")


def row(page: Page, name: str) -> Locator:
    return page.get_by_role("list", name="Robots").get_by_role("listitem").filter(has_text=name)


async def wait_for_motion(mark: Locator, page: Page) -> None:
    before = await mark.evaluate(SPOT)
    for _ in range(LOOKS):
        now = await mark.evaluate(SPOT)
        if abs(now[0] - before[0]) + abs(now[1] - before[1]) > CLEARLY_MOVED_PX:
            return
        await page.evaluate(NEXT_PICTURE)
    pytest.fail(f"it is still drawn at {before}")


async def test_robots_drive_on_the_floors_on_which_they_are(
    service: Service, open_page: OpenPage
) -> None:
    run = await begin_rounds(service, speed=0.5)
    page = await open_page(f"/runs/{run}", viewport=WIDE)
    first, second = page.get_by_role("tab", name="F1"), page.get_by_role("tab", name="F2")
    await expect(first).to_have_attribute("aria-selected", "true", timeout=LONG_MS)
    await expect(first).to_contain_text("1 robot")
    await expect(robot(page, "robot1")).to_be_visible(timeout=LONG_MS)
    await expect(robot(page, "robot2")).to_be_hidden()
    await expect(row(page, "ROBOT1")).to_contain_text(re.compile(r"Driving.*On F1, (near|at)"))
    await wait_for_motion(robot(page, "robot1"), page)
    assert await page.evaluate(COUNT_CHANGES) < 20
    # With the keys, to the other floor and the robot there.
    await first.focus()
    await page.keyboard.press("ArrowRight")
    await expect(second).to_be_focused()
    await expect(second).to_have_attribute("aria-selected", "true")
    await expect(robot(page, "robot2")).to_be_visible()
    await expect(robot(page, "robot1")).to_be_hidden()
    await wait_for_motion(robot(page, "robot2"), page)


async def test_plan_is_moved_and_zoomed_with_keys_and_shows_a_robot(
    service: Service, open_page: OpenPage
) -> None:
    run = await begin_rounds(service, speed=0.05)
    page = await open_page(f"/runs/{run}", viewport=WIDE)
    await expect(row(page, "ROBOT2")).to_contain_text("On F2", timeout=LONG_MS)
    walls = page.locator(".plan-drawing > g").first
    fitted = await walls.get_attribute("transform")
    view = page.get_by_role("group", name="Floor F1")
    await view.focus()
    await page.keyboard.press("+")
    await page.keyboard.press("ArrowLeft")
    assert await walls.get_attribute("transform") != fitted
    await page.get_by_role("button", name="Fit", exact=True).first.click()
    await expect(walls).to_have_attribute("transform", fitted or "")
    await row(page, "ROBOT2").get_by_role("button").click()
    await expect(page.get_by_role("tab", name="F2")).to_have_attribute("aria-selected", "true")
    await expect(robot(page, "robot2")).to_be_visible()


async def test_question_shows_where_the_robot_is_that_asks(
    service: Service, open_page: OpenPage
) -> None:
    run = await begin_rounds(service, scenario="in_the_way", drawn=7)
    page = await open_page(f"/runs/{run}", viewport=WIDE)
    robots = page.get_by_role("list", name="Robots")
    await expect(page.get_by_role("button", name="YES")).to_be_visible(timeout=LONG_MS)
    await expect(robots.get_by_text("Asking").first).to_be_visible(timeout=LONG_MS)
    await service.runtime.pause(run)
    await page.goto("/")
    place = page.locator(".place-map")
    await expect(place.locator("figcaption")).to_have_text(
        re.compile(r"ROBOT\d is on F\d, (near|at) \w+\."), timeout=LONG_MS
    )
    shown = place.get_by_role("img", name=re.compile(r"Map of F\d: ROBOT\d is on F"))
    await expect(shown).to_be_visible()
    await expect(page.get_by_text("something is in its way")).to_be_visible()
    await load_axe(page)
    for theme, rules in RULES.items():
        await page.emulate_media(color_scheme=theme)
        await settle(page)
        assert await violations(page, rules) == [], theme


async def test_past_is_shown_as_it_was_recorded_and_nothing_of_what_was_not(
    service: Service, open_page: OpenPage
) -> None:
    run = await begin_rounds(service, speed="max", places=("F1-104", "F2-204"))
    await service.runtime.wait_for_end(run)
    page = await open_page(f"/runs/{run}", viewport=WIDE)
    await expect(robot(page, "robot1")).to_be_visible(timeout=LONG_MS)
    at_the_end = await row(page, "ROBOT1").inner_text()
    await page.get_by_label("Moment of the run").fill("0.5")
    await expect(row(page, "ROBOT1")).not_to_have_text(at_the_end)
    await expect(row(page, "ROBOT1")).to_contain_text("charger1")
    # What the socket tells is the last of the run, and says nothing of the moment that is shown.
    await page.route("**/api/runs/*/poses?*", lambda route: route.fulfill(body=b""))
    await page.goto(f"/runs/{run}")
    await page.get_by_label("Moment of the run").fill("0.5", timeout=LONG_MS)
    await expect(page.get_by_text("Nothing was recorded of this moment.")).to_be_visible(
        timeout=LONG_MS
    )
    await expect(robot(page, "robot1")).to_be_hidden()
    await expect(row(page, "ROBOT1")).to_contain_text("Nobody knows where it is.")


async def test_robots_of_a_service_that_is_gone_are_not_shown_as_there(
    service: Service, open_page: OpenPage
) -> None:
    run = await begin_rounds(service, speed=0.05)
    page = await open_page(f"/runs/{run}", viewport=WIDE)
    await expect(row(page, "ROBOT1")).to_contain_text("Driving", timeout=LONG_MS)
    await page.context.set_offline(True)
    await page.evaluate("() => dispatchEvent(new Event('offline'))")
    await expect(row(page, "ROBOT1")).to_contain_text(
        re.compile(r"Not seen.*[Ll]ast seen"), timeout=LONG_MS
    )
    await expect(row(page, "ROBOT1")).not_to_contain_text("Driving")
    await page.context.set_offline(False)


async def test_building_of_a_site_is_shown_where_a_run_is_started(
    service: Service, open_page: OpenPage
) -> None:
    await keep_office(service)
    await service.sites.open_site(SiteRequest(scene="office", world="building"))
    page = await open_page("/start/rounds", viewport=WIDE)
    await page.get_by_role("radio", name="site office").check()
    await expect(page.get_by_role("img", name="Plan of F1")).to_be_visible(timeout=LONG_MS)
    await page.get_by_role("tab", name="F2").click()
    await expect(page.get_by_role("img", name="Plan of F2")).to_be_visible()
    await expect(page.locator(".plan-names")).to_contain_text("204")
    await load_axe(page)
    assert await violations(page, RULES["light"]) == []
