"""Somebody stands at a robot's touch screen, asks it for something, and follows that."""

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from uuid import UUID

import pytest
import pytest_asyncio
from console_in_browser import OpenPage, settle
from hearing_browser import give_ear
from lost_answers import answers_lost, until_it_is_not_known
from office_with_fleet import open_office_with_fleet
from playwright.async_api import Page, Route, ViewportSize, expect
from test_accessibility import PHONE, RULES, load_axe, violations

from mend.server.composition import Service

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

LONG_MS = 60_000
LARGE_PX = 64

Reopen = Callable[[str], Awaitable[Page]]

LANDSCAPE = ViewportSize(width=1280, height=800)


@dataclass(frozen=True)
class Screen:
    """The touch screen of the first robot of an office, and the office's service."""

    service: Service
    robot: str
    reopen: Reopen

    async def begin(self, size: ViewportSize = LANDSCAPE) -> Page:
        page = await self.reopen(f"/robots/{self.robot}/ask")
        await page.set_viewport_size(size)
        await expect(page.get_by_text("What may I do for you?")).to_be_visible(timeout=LONG_MS)
        return page


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def first_robot(lasting_service: Service) -> str:
    """One of an office with two floors that nobody else needs for himself."""
    site = await open_office_with_fleet(lasting_service, floors=2)
    return await robot_of(lasting_service, site)


@pytest_asyncio.fixture(loop_scope="session")
async def screen(lasting_service: Service, first_robot: str, reopen: Reopen) -> Screen:
    return Screen(lasting_service, first_robot, reopen)


async def robot_of(service: Service, site: UUID) -> str:
    return next(iter((await service.fleets.fleet(site)).dispatcher.fleet.robots))


async def at_robot(service: Service, open_page: OpenPage, floors: int) -> Page:
    """The touch screen of the first robot of an office of the test's own."""
    site = await open_office_with_fleet(service, floors=floors)
    page = await open_page(f"/robots/{await robot_of(service, site)}/ask")
    await expect(page.get_by_text("What may I do for you?")).to_be_visible(timeout=LONG_MS)
    return page


async def press(page: Page, name: str) -> None:
    await page.get_by_role("button", name=name, exact=True).click()


async def choose(page: Page, place: str) -> None:
    """A place, wherever the tests before have left the robot.

    What is on its floor is shown first, and where it stands is called so.
    """
    await press(page, place.split()[0])
    named = page.get_by_role("button", name=place, exact=True)
    await named.or_(page.get_by_role("button", name=f"Here ({place})", exact=True)).click()


async def test_a_thing_is_brought_by_pressing_buttons_alone(screen: Screen) -> None:
    page = await screen.begin()
    await press(page, "Bring something somewhere")
    await press(page, "This, which I have here")
    await choose(page, "F1 103")
    await choose(page, "F1 106")
    await expect(
        page.get_by_role("heading", name="I am to bring this from F1 103 to F1 106")
    ).to_be_focused()
    await press(page, "Yes, that is right")
    mine = page.get_by_role("region", name="Your request")
    await expect(mine).to_contain_text("is expected to be done with it in about")
    await press(page, "Cancel it")
    await expect(mine).to_contain_text("Cancelled")
    await press(page, "Ask for something else")
    await expect(page.get_by_text("What may I do for you?")).to_be_visible()


async def test_a_room_is_found_by_its_floor_and_number(screen: Screen) -> None:
    before = await screen.service.fleets.requests(None)
    page = await screen.begin()
    await press(page, "Come to a room")
    await press(page, "F2")
    for digit in "203":
        await press(page, digit)
    await expect(page.get_by_role("button", name="F2 201")).to_be_hidden()
    await choose(page, "F2 203")
    await expect(page.get_by_text("I am to come to F2 203. Is that right?")).to_be_visible()
    await press(page, "No")
    await expect(page.get_by_text("What may I do for you?")).to_be_visible()
    assert len(await screen.service.fleets.requests(None)) == len(before)


async def test_whoever_asks_is_shown_the_way(screen: Screen) -> None:
    page = await screen.begin()
    here = await page.get_by_text("I am at F").text_content() or ""
    await press(page, "Show me the way")
    # Nobody is shown the way to where it stands.
    for place in ("F1 103", "F1 106"):
        if place in here:
            await expect(page.get_by_role("button", name=place)).to_be_hidden()
    await choose(page, "F1 106" if "F1 106" not in here else "F1 103")
    await expect(page.get_by_role("heading", name="I am to show you the way from")).to_be_focused()
    await press(page, "Yes, that is right")
    mine = page.get_by_role("region", name="Your request")
    await expect(mine).to_contain_text("is expected to be done with it in about")


async def test_what_is_said_in_words_is_asked_back_read_back_and_done(screen: Screen) -> None:
    page = await screen.begin()
    words = page.get_by_label("Say it in words")
    await words.fill("come to the hall")
    await press(page, "Say it")
    await expect(page.get_by_role("alert").filter(has_text="the hall")).to_be_visible()
    await words.fill("tell two oh three that lunch is ready")
    await press(page, "Say it")
    await expect(page.get_by_text('I am to tell F2 203 that "lunch is ready".')).to_be_visible()
    await press(page, "Yes, that is right")
    mine = page.get_by_role("region", name="Your request")
    await expect(mine).to_contain_text("Tell “lunch is ready” at F2 203")


async def test_what_is_spoken_is_read_back_and_confirmed_by_voice(
    service: Service, open_page: OpenPage
) -> None:
    page = await at_robot(service, open_page, floors=2)
    await expect(page.get_by_role("button", name="Speak")).to_be_hidden()
    said = ["", "come to two oh three", "perhaps", "Yes."]
    await give_ear(page, said)
    await page.reload()
    await press(page, "Speak")
    await expect(page.get_by_text("I have heard nothing")).to_be_visible()
    await press(page, "Speak")
    await expect(page.get_by_text("I am to come to F2 203. Is that right?")).to_be_visible()
    await press(page, "Say yes or no")
    await expect(page.get_by_text("I have heard “perhaps”")).to_be_visible()
    assert (await service.fleets.requests(None)) == []
    await press(page, "Say yes or no")
    mine = page.get_by_role("region", name="Your request")
    await expect(mine).to_contain_text("Come to F2 203")


async def test_what_cannot_be_met_says_why_and_offers_the_next_time(
    service: Service, open_page: OpenPage
) -> None:
    # So high that the elevator alone takes most of a minute.
    page = await at_robot(service, open_page, floors=8)
    await page.get_by_label("Say it in words").fill("go to F8 806 within 1 minute")
    await press(page, "Say it")
    await press(page, "Yes, that is right")
    await expect(page.get_by_text("That cannot be done by then.")).to_be_visible()
    await page.get_by_role("button", name="instead").click()
    mine = page.get_by_role("region", name="Your request")
    await expect(mine).to_contain_text("Come to F8 806", timeout=LONG_MS)


async def test_what_is_booked_though_its_answer_is_lost_is_booked_once_and_followed(
    screen: Screen,
) -> None:
    page = await screen.begin()
    before = len(await screen.service.fleets.requests(None))
    lost = 1

    async def lose(route: Route) -> None:
        nonlocal lost
        if route.request.method != "POST" or lost == 0:
            return await route.continue_()
        lost -= 1
        await route.fetch()
        await route.abort()

    await page.route("**/api/requests?*", lose)
    await page.get_by_label("Say it in words").fill("tell 203 that tea is ready")
    await press(page, "Say it")
    await press(page, "Yes, that is right")
    await expect(page.get_by_text("I try once more")).to_be_visible()
    mine = page.get_by_role("region", name="Your request")
    await expect(mine).to_contain_text("Tell “tea is ready” at F2 203")
    assert len(await screen.service.fleets.requests(None)) == before + 1


async def test_what_is_not_known_to_be_booked_is_said_so_and_asked_for_once_more_once(
    service: Service, open_page: OpenPage
) -> None:
    page = await at_robot(service, open_page, floors=1)

    async with answers_lost(page):
        await press(page, "Come to a room")
        await press(page, "F1 106")
        await press(page, "Yes, that is right")
        await until_it_is_not_known(page)
        await expect(page.get_by_text("That cannot be done")).to_be_hidden()
    # The service is there again: what is said of it is what was, beside that there is a connection.
    await expect(page.get_by_role("status").filter(has_text="Connected")).to_be_visible()
    await expect(page.get_by_text("No answer has come.")).to_be_visible()
    await expect(page.get_by_text("does not answer")).to_be_hidden()
    await press(page, "Try once more")
    await expect(page.get_by_role("region", name="Your request")).to_contain_text("Come to F1 106")
    assert len(await service.fleets.requests(None)) == 1


async def test_who_has_asked_is_told_that_the_robot_waits_for_somebody(
    service: Service, open_page: OpenPage
) -> None:
    site = await open_office_with_fleet(service, 20.0, answers="live")
    page = await open_page(f"/robots/{await robot_of(service, site)}/ask")
    await page.get_by_label("Say it in words").fill(
        "bring the tea from 103 to 106", timeout=LONG_MS
    )
    await press(page, "Say it")
    await press(page, "Yes, that is right")
    mine = page.get_by_role("region", name="Your request")
    await expect(mine).to_contain_text("I wait for somebody to help me:", timeout=LONG_MS)
    await expect(mine).to_contain_text("Put the tea into my basket")
    await expect(mine).to_contain_text("at the earliest")
    page = await open_page("/requests")
    row = page.get_by_role("list", name="Open requests")
    await expect(row).to_contain_text("waits for somebody to help: Put the tea into")


async def test_a_message_is_told_with_the_marks_that_robots_say(screen: Screen) -> None:
    page = await screen.begin()
    await press(page, "Tell somebody something")
    await page.get_by_label("The message, as it is to be told").fill('Say "hello" to «Zoë»')
    await press(page, "Go on")
    await choose(page, "F1 106")
    await expect(page.get_by_text("“Say 'hello' to 'Zoë'”. Is that right?")).to_be_visible()
    await press(page, "Yes, that is right")
    mine = page.get_by_role("region", name="Your request")
    await expect(mine).to_contain_text("Tell “Say 'hello' to 'Zoë'” at F1 106")


async def test_what_was_typed_is_kept_where_it_is_not_right_or_refused(screen: Screen) -> None:
    page = await screen.begin()
    await page.get_by_label("Say it in words").fill("come to 203")
    await press(page, "Say it")
    await press(page, "No")
    await expect(page.get_by_label("Say it in words")).to_have_value("come to 203")
    await press(page, "Tell somebody something")
    message = page.get_by_label("The message, as it is to be told")
    await message.fill("Tea is\u200b ready")
    await press(page, "Go on")
    await choose(page, "F1 106")
    await press(page, "Yes, that is right")
    await expect(page.get_by_text("only characters that can be seen")).to_be_visible()
    await press(page, "Ask for it in other words")
    await expect(message).to_have_value("Tea is\u200b ready")


async def test_every_button_is_large(screen: Screen) -> None:
    page = await screen.begin()
    await press(page, "Come to a room")
    for button in await page.get_by_role("button").all():
        box = await button.bounding_box()
        assert box is not None
        assert min(box["width"], box["height"]) >= LARGE_PX, await button.inner_text()


@pytest.mark.parametrize("size", [PHONE, LANDSCAPE], ids=["phone", "1280x800"])
async def test_axe_finds_nothing_on_the_way_through_it(screen: Screen, size: ViewportSize) -> None:
    page = await screen.begin(size)
    await load_axe(page)
    await require_clean(page)
    for button in ("Bring something somewhere", "This, which I have here"):
        await press(page, button)
        await require_clean(page)
    for place in ("F1 103", "F1 106"):
        await choose(page, place)
        await require_clean(page)
    await press(page, "Yes, that is right")
    await expect(page.get_by_role("region", name="Your request")).to_be_visible()
    await require_clean(page)


async def require_clean(page: Page) -> None:
    """Nothing is wrong, light and dark, and nothing sticks out."""
    for theme, rules in RULES.items():
        await page.emulate_media(color_scheme=theme)
        await settle(page)
        assert await violations(page, rules) == [], theme
    assert await page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0


async def test_whoever_goes_away_leaves_the_start_to_who_comes_next(
    service: Service, open_page: OpenPage
) -> None:
    page = await at_robot(service, open_page, floors=1)
    await page.clock.install()
    await press(page, "Come to a room")
    # It counts from when the question is shown.
    await expect(page.get_by_role("heading", name="Where am I to come?")).to_be_focused()
    await page.clock.fast_forward("02:00")
    await expect(page.get_by_text("What may I do for you?")).to_be_visible()


async def test_a_robot_that_is_not_connected_says_so_and_not_where_it_is(
    service: Service, open_page: OpenPage
) -> None:
    page = await at_robot(service, open_page, floors=1)
    head = page.locator(".touch-head")
    await expect(head).to_contain_text("I am at F1 charger1.")
    await expect(head.get_by_role("status")).to_have_text("Connected")

    async def be_gone(route: Route) -> None:
        found = await (await route.fetch()).json()
        await route.fulfill(json={**found, "connected": False})

    await page.route("**/asking", be_gone)
    await expect(head.get_by_role("status")).to_have_text("I am not connected.", timeout=LONG_MS)
    await expect(head).not_to_contain_text("I am at")
    await page.unroute("**/asking")
    await expect(head.get_by_role("status")).to_have_text("Connected", timeout=LONG_MS)


async def test_a_robot_that_is_not_there_is_said_to_be_none(
    service: Service, open_page: OpenPage
) -> None:
    await open_office_with_fleet(service)
    page = await open_page("/robots/nobody/ask")
    await expect(page.get_by_text("No robot called nobody takes requests here.")).to_be_visible()


async def test_a_robot_that_is_out_of_service_says_so_and_another_one_comes(
    service: Service, open_page: OpenPage
) -> None:
    site = await open_office_with_fleet(service, robots=2)
    fleet = await service.fleets.fleet(site)
    first, other = fleet.dispatcher.fleet.robots
    await fleet.operators.take_out(first, "its wheel squeaks", None)
    page = await open_page(f"/robots/{first}/ask")
    out = page.get_by_role("heading", name="I am out of service, but you may ask here")
    await expect(out).to_be_visible(timeout=LONG_MS)
    await expect(page.get_by_text("What may I do for you?")).to_be_hidden()
    await press(page, "Come to a room")
    await press(page, "F1 106")
    await press(page, "Yes, that is right")
    mine = page.get_by_role("region", name="Your request")
    await expect(mine).to_contain_text("is expected to be done with it")
    await fleet.operators.take_out(other, "its wheel squeaks, too", None)
    page = await open_page(f"/robots/{first}/ask")
    await expect(page.get_by_text("no other robot works now")).to_be_visible(timeout=LONG_MS)
    await expect(page.get_by_role("button", name="Come to a room")).to_be_hidden()
