"""Helpers are called until somebody is on it, also while no page is looked at."""

import asyncio
from collections.abc import AsyncIterator, Iterator

import pytest
import pytest_asyncio
from bare_chromium import WHOLE, launch_whole
from console_in_browser import COUNT_TONES, OpenPage, Stage
from console_situations import ask
from playwright.async_api import Browser, Page, async_playwright, expect
from push_endpoint import PushService, push_service
from pushed_browser import PushedBrowser

from mend.server.composition import Service
from mend.server.push.subscription import PushSubscription

pytestmark = [
    pytest.mark.asyncio(loop_scope="session"),
    pytest.mark.skipif(WHOLE is None, reason="no Chromium with notifications is on this machine"),
]

TONES = 2
"""Of one calm call."""

DEVICE = "Call this device also while this page is closed"


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def browser() -> AsyncIterator[Browser]:
    """Pages are opened in one that has notifications."""
    async with async_playwright() as playwright:
        browser = await launch_whole(playwright)
        yield browser
        await browser.close()


@pytest.fixture
def pushes() -> Iterator[PushService]:
    with push_service() as service:
        yield service


async def call_this_device(page: Page) -> None:
    await page.get_by_label(DEVICE).check()
    await expect(page.get_by_label(DEVICE)).to_be_enabled()
    await expect(page.get_by_label(DEVICE)).to_be_checked()


async def rung(page: Page, times: int) -> None:
    async with asyncio.timeout(60):
        while await page.evaluate("window.tones") < times * TONES:  # noqa: ASYNC110 - as it is
            await asyncio.sleep(0.02)


async def test_it_rings_again_until_somebody_is_on_it(stage: Stage) -> None:
    anna, bob = await stage.open_page(), await stage.open_page(helper="bob")
    for page in (anna, bob):
        await page.evaluate(COUNT_TONES)
        await page.clock.install()
        await page.mouse.click(1, 1)
    await stage.runs.open(stage.run, "dropped")
    for page in (anna, bob):
        await rung(page, 1)
    await anna.get_by_role("button", name="Not me").click()
    await expect(anna.get_by_text("You are not called about it here.")).to_be_visible()
    for times in (2, 3):
        for page in (anna, bob):
            await page.clock.fast_forward(15_000)
        await rung(bob, times)
    assert await anna.evaluate("window.tones") == TONES
    await anna.get_by_role("button", name="Call me again").click()
    await rung(anna, 2)
    await bob.get_by_role("button", name="I am on it").click()
    await expect(anna.get_by_text("bob is answering.")).to_be_visible()
    for page in (anna, bob):
        before = await page.evaluate("window.tones")
        await page.clock.fast_forward(120_000)
        assert await page.evaluate("window.tones") == before


async def test_a_page_is_called_by_push_and_called_off_again(
    service: Service, open_page: OpenPage, pushes: PushService
) -> None:
    page = await open_page("/settings")
    browser = PushedBrowser(page, pushes, "phone")
    await browser.begin()
    await call_this_device(page)
    [device] = service_devices(service)
    assert device.endpoint == browser.device.endpoint
    run = await ask(service)
    [call] = await browser.hand_on()
    assert call.type == "call"
    await browser.shows_something()
    [shown] = await browser.notices()
    assert shown["title"].endswith("asks for help")
    assert shown["body"] == call.text
    await service.runtime.abort(run)
    [withdrawn] = await browser.hand_on()
    assert withdrawn.type == "withdrawn"
    await page.get_by_label(DEVICE).uncheck()
    await expect(page.get_by_label(DEVICE)).to_be_enabled()
    assert service_devices(service) == []


async def test_a_page_in_the_background_shows_a_question_until_it_is_closed(
    stage: Stage, pushes: PushService
) -> None:
    page = await stage.open_page()
    browser = PushedBrowser(page, pushes, "desktop")
    await browser.begin()
    await page.evaluate("localStorage.setItem('mend.notifications_on', 'true')")
    await page.reload()
    await page.get_by_role("status").filter(has_text="Connected").wait_for()
    await page.evaluate("document.hasFocus = () => false")
    dialogue = await stage.runs.open(stage.run, "dropped")
    await browser.shows_something()
    [shown] = await browser.notices()
    assert (shown["title"], shown["tag"]) == ("PR2 asks for help", str(dialogue))
    await page.locator(".answer.yes").click()
    async with asyncio.timeout(60):
        while await browser.notices():  # noqa: ASYNC110 - the browser tells nobody
            await asyncio.sleep(0.02)


async def test_the_trial_says_truthfully_whether_this_device_calls(
    service: Service, open_page: OpenPage, pushes: PushService
) -> None:
    page = await open_page("/settings")
    begin = page.get_by_role("button", name="Try whether this device calls me")
    await begin.click()
    told = page.get_by_role("status")
    await expect(told.filter(has_text="only as long as this page is open")).to_be_visible()
    await expect(page.get_by_text("Robots ask “anna”.")).to_be_visible()
    browser = PushedBrowser(page, pushes, "phone")
    await browser.begin()
    await call_this_device(page)
    await begin.click()
    [trial] = await browser.hand_on()
    assert trial.type == "trial"
    await expect(told.filter(has_text="whether this page is open or not")).to_be_visible()
    await expect(page.get_by_text("Came back after")).to_be_visible()
    pushes.statuses[browser.device.path] = [410]
    await begin.click()
    await expect(page.get_by_text("It was not sent: the push service answered 410")).to_be_visible()
    assert service_devices(service) == []
    await begin.click()
    await expect(page.get_by_text("The service does not know this device")).to_be_visible()


async def test_a_device_beside_the_robot_stays_awake_and_listens_from_the_start(
    stage: Stage,
) -> None:
    page = await stage.open_page("/settings")
    held = "() => navigator.wakeLock.request = async () => (window.held = true, new EventTarget())"
    await page.evaluate(held)
    assert await page.evaluate("window.held") is None
    await page.get_by_label("This device stands beside the robot").check()
    await page.wait_for_function("() => window.held === true")
    await page.get_by_role("link", name="Questions", exact=True).click()
    await stage.runs.open(stage.run, "dropped")
    await expect(page.get_by_role("button", name="Listen and speak")).to_have_attribute(
        "aria-pressed", "true"
    )


async def test_the_page_can_be_installed(open_page: OpenPage) -> None:
    page = await open_page("/")
    session = await page.context.new_cdp_session(page)
    found = await session.send("Page.getAppManifest")
    assert found["errors"] == []
    assert found["url"].endswith("/manifest.webmanifest")
    problems = await session.send("Page.getInstallabilityErrors")
    # Pages of a context of a test are those of a private window, which installs nothing.
    told = {each["errorId"] for each in problems["installabilityErrors"]}
    assert told <= {"in-incognito"}


def service_devices(service: Service) -> list[PushSubscription]:
    return list(service.devices.of_helper(None))
