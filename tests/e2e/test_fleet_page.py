"""The fleet of a building: followed on its plan and chart, looked back at, and told what to do."""

import re
from typing import Any

import pytest
from console_in_browser import OpenPage
from office_with_fleet import open_office_with_fleet
from playwright.async_api import Locator, Page, Route, ViewportSize, expect

from mend.fleet.requests import DeliverMessage, GoToRoom, Transport
from mend.server.composition import Service

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

LONG_MS = 60_000
NAMES = ("ROBOT1", "ROBOT2")
WIDE = ViewportSize(width=1440, height=1600)
PHONE = ViewportSize(width=390, height=844)
# Where nothing is about it, no robot glides from place to place: each picture takes its time.
CALM: dict[str, Any] = {"viewport": WIDE, "reduced_motion": "reduce"}
PARCEL = Transport(name="parcel", what="the blue parcel", origin="F1/101", destination="F1/106")
# Lines that are upright have no width of their own to be clicked on.
MIDDLE = """line => {
    const { x, y } = line.closest("svg").getBoundingClientRect();
    const middle = axis => (+line.getAttribute(axis + 1) + +line.getAttribute(axis + 2)) / 2;
    return [x + middle("x"), y + middle("y")];
}"""


def row(page: Page, name: str) -> Locator:
    robots = page.get_by_role("list", name="Robots of the fleet")
    return robots.get_by_role("listitem").filter(has_text=name)


def lane(page: Page, name: str) -> Locator:
    return page.get_by_role("group", name=name, exact=True).locator(".item")


async def test_what_robots_do_is_followed_on_plan_and_chart(
    service: Service, open_page: OpenPage
) -> None:
    site = await open_office_with_fleet(service, 5.0, robots=2, floors=2)
    page = await open_page("/", **CALM)
    await page.get_by_role("link", name="Fleet", exact=True).click(timeout=LONG_MS)
    await expect(row(page, "ROBOT1")).to_contain_text("has nothing to do", timeout=LONG_MS)
    # Also who has never been in a run says where it is.
    await expect(row(page, "ROBOT1")).to_contain_text(re.compile("On F1, at charger1"))
    await expect(row(page, "ROBOT2")).to_contain_text(re.compile("On F2, at charger2"))
    await expect(page.locator(".plan-robot[data-robot^=robot1]")).to_be_visible()
    await service.fleets.submit(site, PARCEL, None)
    await expect(row(page, "ROBOT1")).to_contain_text("collects parcel at F1 101", timeout=LONG_MS)
    await expect(lane(page, "ROBOT1").filter(has_text="planned")).not_to_have_count(0)
    await expect(row(page, "ROBOT1")).to_contain_text(
        "It has the blue parcel aboard.", timeout=LONG_MS
    )
    await expect(page.get_by_text("1 that is over")).to_be_visible(timeout=LONG_MS)
    done = lane(page, "ROBOT1").filter(has_text="collects parcel at F1 101, from F1 charger1, done")
    await expect(done).to_have_count(1)
    await page.get_by_role("button", name="As a table").click()
    table = page.get_by_role("region", name="The plan as a table")
    await expect(table).to_contain_text("ROBOT1 hands over parcel at F1 106")


async def test_changes_of_the_plan_are_reached_with_keys_and_say_why(
    service: Service, open_page: OpenPage
) -> None:
    site = await open_office_with_fleet(service)
    await service.fleets.submit(site, PARCEL, None)
    page = await open_page("/fleet", **CALM)
    await expect(lane(page, "Changes")).not_to_have_count(0, timeout=LONG_MS)
    await lane(page, "ROBOT1").first.focus()
    for _ in range(2):
        await page.keyboard.press("ArrowDown")
    await expect(lane(page, "Changes").first).to_be_focused()
    await page.keyboard.press("Enter")
    chosen = page.locator(".chart-chosen")
    await expect(chosen).to_contain_text("parcel")
    await expect(chosen).to_contain_text("It touches ROBOT1")


async def test_a_robot_is_sent_where_nobody_wants_it_but_whoever_sends_it(
    service: Service, open_page: OpenPage
) -> None:
    site = await open_office_with_fleet(service, 5.0)
    page = await open_page("/fleet", **CALM)
    await page.get_by_role("button", name="Send … ROBOT1").click(timeout=LONG_MS)
    await page.get_by_label("Place", exact=True).select_option("F1/103")
    await page.get_by_role("button", name="Send it").click()
    await expect(row(page, "ROBOT1")).to_contain_text("goes to F1 103", timeout=LONG_MS)
    await page.get_by_role("button", name="Send home ROBOT1").click()
    await expect(row(page, "ROBOT1").get_by_role("alert")).to_contain_text(
        re.compile("Robot 'robot1.*' is on its way to F1/103"), timeout=LONG_MS
    )
    await expect(row(page, "ROBOT1")).to_contain_text("It came to F1 103 at", timeout=LONG_MS)
    await expect(row(page, "ROBOT1")).to_contain_text("On F1, at 103")
    await expect(page.get_by_text("is on its way to F1/103")).to_have_count(0)
    await service.fleets.submit(site, GoToRoom(name="visit", place="F1/106", stay_s=600.0), None)
    await expect(row(page, "ROBOT1")).to_contain_text("comes for visit", timeout=LONG_MS)
    await page.get_by_role("button", name="Send home ROBOT1").click()
    await expect(row(page, "ROBOT1").get_by_role("alert")).to_contain_text(
        "is at work for 'visit' at F1/106: send it once that is done"
    )


async def test_a_robot_is_taken_out_of_service_for_a_reason_and_put_back(
    service: Service, open_page: OpenPage
) -> None:
    await open_office_with_fleet(service)
    page = await open_page("/fleet", **CALM)
    await page.get_by_role("button", name="Out of service … ROBOT1").click(timeout=LONG_MS)
    await page.get_by_role("button", name="Take it out").click()
    await expect(page.get_by_text("Say why: others will see it.")).to_be_visible()
    await page.get_by_label("Why").fill("its wheel squeaks")
    await page.get_by_role("button", name="Take it out").click()
    await expect(row(page, "ROBOT1")).to_contain_text(
        "is out of service: its wheel squeaks", timeout=LONG_MS
    )
    await expect(lane(page, "ROBOT1").filter(has_text="out of service")).to_have_count(1)
    await page.get_by_role("button", name="Back in service ROBOT1").click()
    await expect(row(page, "ROBOT1")).to_contain_text("has nothing to do", timeout=LONG_MS)


async def test_a_way_is_picked_on_the_plan_closed_and_opened_again(
    service: Service, open_page: OpenPage
) -> None:
    await open_office_with_fleet(service)
    page = await open_page("/fleet", **CALM)
    way = page.locator(".plan-hits g[data-way*='F1/101']")
    await expect(way).to_have_count(1, timeout=LONG_MS)
    x, y = await way.locator("line.hit").evaluate(MIDDLE)
    await page.mouse.click(x, y)
    await expect(page.get_by_label("Way on F1")).not_to_have_value("-1")
    await page.get_by_label("For", exact=True).select_option("60")
    await page.get_by_role("button", name="Door closed").click()
    closed = page.get_by_role("list", name="Ways that are closed now")
    await expect(closed).to_contain_text(
        re.compile(r"Door closed between F1 101 and F1 \S+ until 1:00:00"), timeout=LONG_MS
    )
    await expect(way).to_have_class("closed")
    await expect(page.get_by_role("button", name="Blocked")).to_be_disabled()
    await closed.get_by_role("button").click()
    await expect(page.get_by_text("No way is closed.")).to_be_visible(timeout=LONG_MS)
    await expect(way).to_have_class("")


async def test_the_past_shows_what_is_kept_of_it_and_says_what_is_not(
    service: Service, open_page: OpenPage
) -> None:
    site = await open_office_with_fleet(service, 30.0)
    lunch = DeliverMessage(name="lunch", place="F1/103", message="Lunch.", earliest_s=200.0)
    for each in (PARCEL, lunch):
        await service.fleets.submit(site, each, None)
    page = await open_page("/fleet", **CALM)
    await expect(page.get_by_text("2 that are over")).to_be_visible(timeout=LONG_MS)
    await page.get_by_label("Moment of the building").fill("1")
    requests = page.get_by_role("list", name="Open requests")
    await expect(requests).to_contain_text("Bring the blue parcel from F1 101 to F1 106")
    await expect(requests.get_by_text("Under way")).to_be_visible()
    await expect(requests.get_by_role("button")).to_have_count(0)
    await expect(page.get_by_text("Which ways were closed at that moment is not")).to_be_visible()
    robot = page.locator(".plan-robot[data-robot^=robot1]")
    await expect(robot).to_be_visible()
    at_first = await robot.get_attribute("transform")
    await page.get_by_label("Moment of the building").fill("200")
    await expect(robot).not_to_have_attribute("transform", at_first or "")
    await page.get_by_label("Moment of the building").fill("1")
    await expect(page.get_by_text("What was planned at that moment is not kept")).to_be_visible()
    told = lane(page, "ROBOT1").filter(has_text="tells lunch at F1 103")
    await expect(lane(page, "ROBOT1")).to_have_count(1)
    await expect(told).to_have_count(0)
    await page.get_by_role("button", name="Back to live").click()
    await expect(told).to_have_count(1)
    await expect(page.get_by_text("Which ways were closed at that moment is")).to_be_hidden()


async def test_no_robot_is_seen_any_more_where_the_service_is_gone(
    service: Service, open_page: OpenPage
) -> None:
    await open_office_with_fleet(service, robots=2)
    page = await open_page("/fleet", **CALM)
    marks = page.locator(".plan-robot.robot-not-seen")
    for name in NAMES:
        await expect(row(page, name)).to_contain_text("Idle", timeout=LONG_MS)
    await expect(marks).to_have_count(0)
    await page.context.set_offline(True)
    for name in NAMES:
        await expect(row(page, name)).to_contain_text("Not seen", timeout=LONG_MS)
        await expect(row(page, name)).to_contain_text(re.compile(r"Last seen \d+ s ago, on F1"))
    await expect(marks).to_have_count(2)
    await page.context.set_offline(False)
    for name in NAMES:
        await expect(row(page, name)).to_contain_text("Idle", timeout=LONG_MS)
    await expect(marks).to_have_count(0)


async def test_what_its_robots_ask_is_answered_there(service: Service, open_page: OpenPage) -> None:
    site = await open_office_with_fleet(service, 5.0, answers="live")
    await service.fleets.submit(site, PARCEL, None)
    page = await open_page("/fleet", **CALM)
    asked = page.get_by_role("region", name="What its robots ask")
    await expect(asked).to_contain_text("Please put the blue parcel", timeout=LONG_MS)
    await expect(asked.locator(".place-map figcaption")).to_contain_text(
        "ROBOT1 is on F1, at 101", timeout=LONG_MS
    )
    await expect(page.get_by_role("complementary", name="A robot asks")).to_have_count(0)
    await asked.get_by_role("button", name="YES").click()
    await expect(row(page, "ROBOT1")).to_contain_text(
        "It has the blue parcel aboard.", timeout=LONG_MS
    )


async def test_on_a_phone_nothing_lies_over_what_may_be_answered(
    service: Service, open_page: OpenPage
) -> None:
    site = await open_office_with_fleet(service, 5.0, answers="live")
    await service.fleets.submit(site, PARCEL, None)
    page = await open_page("/fleet", viewport=PHONE, reduced_motion="reduce")
    asked = page.get_by_role("region", name="What its robots ask")
    await expect(asked).to_contain_text("Please put the blue parcel", timeout=LONG_MS)
    for button in await asked.locator(".question-answers button").all():
        await button.click(trial=True)


async def test_what_may_be_said_to_one_of_many_robots_is_folded(
    service: Service, open_page: OpenPage
) -> None:
    await open_office_with_fleet(service, 5.0, robots=7)
    page = await open_page("/fleet", **CALM)
    home = row(page, "ROBOT7").get_by_role("button", name="Send home")
    await expect(row(page, "ROBOT7")).to_contain_text("has nothing to do", timeout=LONG_MS)
    await expect(home).to_be_hidden()
    await row(page, "ROBOT7").get_by_text("Send it, or take it out of service").click()
    await expect(home).to_be_visible()


async def test_an_address_that_names_the_building_otherwise_leads_to_it(
    service: Service, open_page: OpenPage
) -> None:
    await open_office_with_fleet(service)
    second = await open_office_with_fleet(service)
    page = await open_page(f"/fleet?site={second}", **CALM)
    await expect(page.get_by_role("combobox", name="Building")).to_have_value(
        str(second), timeout=LONG_MS
    )
    await expect(page).to_have_url(re.compile(f"/fleet/{second}$"))


async def test_without_a_fleet_the_page_says_so(open_page: OpenPage) -> None:
    page = await open_page("/fleet")
    await expect(page.get_by_text("No robots take requests")).to_be_visible(timeout=LONG_MS)


async def test_who_is_no_operator_looks_and_is_told_what_that_takes(
    service: Service, open_page: OpenPage
) -> None:
    await open_office_with_fleet(service)
    page = await open_page("/", **CALM)
    session = {"required": True, "signed_in": True, "name": "vera", "role": "viewer"}
    await page.route("**/api/session", lambda route: route.fulfill(json=session))
    await page.goto("/fleet")
    await expect(row(page, "ROBOT1")).to_contain_text("On F1, at charger1", timeout=LONG_MS)
    await expect(row(page, "ROBOT1").get_by_role("button")).to_have_count(1)
    await expect(page.get_by_text("Closing a way needs the role operator")).to_be_visible()
    await expect(page.get_by_label("Way on F1")).to_have_count(0)


async def test_what_changes_robots_is_linked_from_row_to_row(
    service: Service, open_page: OpenPage
) -> None:
    site = await open_office_with_fleet(service, robots=2, floors=2)
    fleet = await service.fleets.fleet(site)
    one, two = fleet.dispatcher.fleet.robots
    leg = {"place": "F1/103", "request": "tea", "slack_s": 5.0}
    gives = {**leg, "action": "give", "begins_s": 60.0, "done_s": 90.0, "partner": two}
    takes = {**leg, "action": "take", "begins_s": 100.0, "done_s": 130.0, "partner": one}

    async def with_transfer(route: Route) -> None:
        answer = await route.fetch()
        view = await answer.json()
        for robot, stop in zip(view["robots"], (gives, takes), strict=True):
            robot["stops"] = [stop]
        await route.fulfill(json=view)

    page = await open_page("/", **CALM)
    await page.route("**/api/sites/*/fleet", with_transfer)
    await page.goto("/fleet")
    link = page.locator(".chart-link[data-request=tea] path")
    await expect(link).to_have_count(1, timeout=LONG_MS)
    ends = [await lane(page, name).locator("rect.body").bounding_box() for name in NAMES]
    drawn = await link.bounding_box()
    assert drawn is not None
    (first, second) = ends
    assert first is not None
    assert second is not None
    assert drawn["x"] == pytest.approx(first["x"] + first["width"], abs=3)
    assert drawn["x"] + drawn["width"] == pytest.approx(second["x"], abs=3)
    assert drawn["y"] == pytest.approx(first["y"] + first["height"] / 2, abs=3)
    assert drawn["y"] + drawn["height"] == pytest.approx(second["y"] + second["height"] / 2, abs=3)
    await page.get_by_role("button", name="As a table").click()
    table = page.get_by_role("region", name="The plan as a table")
    await expect(table).to_contain_text("ROBOT1 hands tea to ROBOT2 at 1:40.")


async def test_a_place_is_picked_on_the_plan_and_a_robot_sent_there(
    service: Service, open_page: OpenPage
) -> None:
    await open_office_with_fleet(service, 5.0)
    page = await open_page("/fleet", viewport=WIDE)
    await expect(row(page, "ROBOT1")).to_contain_text("has nothing to do", timeout=LONG_MS)
    await page.locator(".plan-hits g[data-place='F1/103'] circle.hit").click()
    sending = page.get_by_role("group", name="Send a robot to F1 103")
    await sending.get_by_role("button", name="Go there").click()
    await expect(row(page, "ROBOT1")).to_contain_text("goes to F1 103", timeout=LONG_MS)
    await expect(lane(page, "ROBOT1").filter(has_text="ROBOT1 goes to F1 103")).to_have_count(1)
    await expect(row(page, "ROBOT1")).to_contain_text("It came to F1 103 at", timeout=LONG_MS)


async def test_how_sure_a_robot_is_of_its_place_is_drawn_round_it(
    service: Service, open_page: OpenPage
) -> None:
    await open_office_with_fleet(service)

    async def unsure(route: Route) -> None:
        answer = await route.fetch()
        view = await answer.json()
        for robot in view["robots"]:
            if robot["pose"] is not None:
                robot["pose"]["covariance"] = [1.0, 0.0, 0.25]
        await route.fulfill(json=view)

    page = await open_page("/fleet", **CALM)
    ellipse = page.locator(".plan-unsure")
    mark = page.locator(".plan-robot .plan-mark")
    await expect(mark).to_be_visible(timeout=LONG_MS)
    # The robots of this office are told where they are.
    await expect(ellipse).to_be_hidden()
    await page.route("**/api/sites/*/fleet", unsure)
    await expect(ellipse).to_be_visible(timeout=LONG_MS)
    await expect(row(page, "ROBOT1")).to_contain_text("(sure to 2.4 m)")
    around, within = await ellipse.bounding_box(), await mark.bounding_box()
    assert around is not None
    assert within is not None
    assert around["width"] == pytest.approx(2 * around["height"], rel=0.05)
    assert around["x"] + around["width"] / 2 == pytest.approx(
        within["x"] + within["width"] / 2, abs=2
    )
