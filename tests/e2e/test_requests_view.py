"""People ask robots of a building for something in the console, and follow it to its end."""

import time
from collections.abc import Awaitable, Callable
from uuid import UUID

import pytest
import pytest_asyncio
from console_in_browser import OpenPage
from lost_answers import answers_lost, until_it_is_not_known
from office_with_fleet import open_office_with_fleet
from playwright.async_api import Page, expect

from mend.server.composition import Service

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

Reopen = Callable[[str], Awaitable[Page]]

LONG_MS = 60_000
A_MINUTE_S = 60.0


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def lasting_office(lasting_service: Service) -> UUID:
    """An office with two floors and one robot: whoever asks it for more does not mind the rest."""
    return await open_office_with_fleet(lasting_service, floors=2)


@pytest_asyncio.fixture(loop_scope="session")
async def office(lasting_office: UUID, reopen: Reopen) -> Reopen:  # noqa: ARG001
    return reopen


async def test_something_is_asked_for_and_followed_until_it_is_done(
    service: Service, open_page: OpenPage
) -> None:
    await open_office_with_fleet(service, 20.0)
    page = await open_page("/")
    await page.get_by_role("link", name="Requests", exact=True).click(timeout=LONG_MS)
    await page.get_by_label("What is to be brought").fill("the mail", timeout=LONG_MS)
    await page.get_by_label("From", exact=True).fill("F1 101")
    await page.get_by_label("To", exact=True).fill("F1 103")
    await page.get_by_role("button", name="Ask for it", exact=True).click()
    over = page.get_by_role("list", name="Requests that are over")
    row = over.get_by_role("listitem").filter(has_text="Bring the mail from F1 101 to F1 103")
    await expect(row).to_contain_text("Done", timeout=LONG_MS)
    await expect(page.get_by_label("What is to be brought")).to_have_value("")


async def test_what_is_missing_is_said_and_nothing_is_asked_for(
    service: Service, open_page: OpenPage
) -> None:
    await open_office_with_fleet(service)
    page = await open_page("/requests")
    await page.get_by_role("button", name="Ask for it", exact=True).click(timeout=LONG_MS)
    await expect(page.get_by_text("Say what is to be brought.")).to_be_visible()
    await expect(page.get_by_text("Nothing is asked for just now.")).to_be_visible()


async def test_what_cannot_be_met_in_time_is_offered_for_when_it_can(office: Reopen) -> None:
    page = await office("/requests")
    await page.get_by_label("Tell something").check(timeout=LONG_MS)
    await page.get_by_label("What is to be told").fill("Lunch is ready.")
    await page.get_by_label("Where").fill("106")
    await page.get_by_label("Within").fill("0.1")
    await page.get_by_role("button", name="Ask for it", exact=True).click()
    await expect(
        page.get_by_role("alert").filter(has_text="cannot be done by then")
    ).to_be_visible()
    await page.get_by_role("button", name="instead").click()
    open_ones = page.get_by_role("list", name="Open requests")
    await expect(open_ones).to_contain_text("Tell “Lunch is ready.” at F1 106", timeout=LONG_MS)


async def test_what_is_not_known_to_be_booked_is_booked_once_however_it_is_asked_for_again(
    service: Service, open_page: OpenPage
) -> None:
    await open_office_with_fleet(service)
    page = await open_page("/requests")

    await page.get_by_label("Have a robot come").check(timeout=LONG_MS)
    await page.get_by_label("Where").fill("F1 106")
    ask = page.get_by_role("button", name="Ask for it", exact=True)
    async with answers_lost(page):
        await ask.click()
        await until_it_is_not_known(page)
    await ask.click()
    mine = page.get_by_role("region", name="Your request")
    await expect(mine).to_contain_text("Come to F1 106")
    assert len(await service.fleets.requests(None)) == 1


async def test_a_newcomer_asks_in_words_and_follows_it(office: Reopen) -> None:
    page = await office("/")
    began_s = time.monotonic()
    await page.get_by_role("link", name="Requests", exact=True).click(timeout=LONG_MS)
    words = page.get_by_label("Say it in words")
    await words.press_sequentially("bring the mail to 203")
    await words.press("Enter")
    await expect(page.get_by_role("alert").filter(has_text="From where?")).to_be_visible()
    await words.fill("bring the mail from 101 to two oh three")
    await words.press("Enter")
    await expect(
        page.get_by_role("heading", name="I am to bring the mail from F1 101 to F2 203.")
    ).to_be_focused()
    await page.get_by_role("button", name="Yes, that is right").click()
    mine = page.get_by_role("region", name="Your request")
    await expect(mine).to_contain_text("Bring the mail from F1 101 to F2 203")
    await expect(mine).to_contain_text("is expected to be done with it in about")
    # On a machine without other work some 3 s; people take longer to read and to type.
    assert time.monotonic() - began_s < A_MINUTE_S


async def test_a_place_that_is_not_there_is_said_to_be_none(office: Reopen) -> None:
    page = await office("/requests")
    await page.get_by_label("Have a robot come").check(timeout=LONG_MS)
    await page.get_by_label("Where").fill("999")
    await page.get_by_role("button", name="Ask for it", exact=True).click()
    await expect(page.get_by_role("alert").filter(has_text="no place “999”")).to_be_visible()


async def test_what_is_no_longer_wanted_is_cancelled(office: Reopen) -> None:
    page = await office("/requests")
    await page.get_by_label("Have a robot come").check(timeout=LONG_MS)
    await page.get_by_label("Where").fill("F1 106")
    await page.get_by_role("button", name="Ask for it", exact=True).click()
    await page.get_by_role("button", name="Cancel: Come to F1 106").click(timeout=LONG_MS)
    over = page.get_by_role("list", name="Requests that are over")
    await expect(over).to_contain_text("Cancelled", timeout=LONG_MS)


async def test_without_robots_that_take_requests_the_page_says_so(open_page: OpenPage) -> None:
    page = await open_page("/requests")
    await expect(page.get_by_text("No robots take requests")).to_be_visible(timeout=LONG_MS)
    await page.goto("/")
    await expect(page.get_by_role("link", name="Task trees")).to_be_visible()
    await expect(page.get_by_role("link", name="Requests")).to_be_hidden()
