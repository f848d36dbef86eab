"""The built-in page in a real browser."""

import shutil
from collections.abc import AsyncIterator

import pytest
from playwright.async_api import Browser, ConsoleMessage, Page, async_playwright, expect
from service_under_test import TOKEN, ServiceUnderTest, serving

from server.runtime.requests import RunRequest

CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")

pytestmark = [
    pytest.mark.browser,
    pytest.mark.slow,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium on this machine"),
]

REQUEST = RunRequest(tree="eket", world="tabletop", speed="max")


@pytest.fixture
async def browser() -> AsyncIterator[Browser]:
    async with async_playwright() as playwright:
        browser = await playwright.chromium.launch(
            executable_path=CHROMIUM, headless=True, args=["--no-sandbox"]
        )
        yield browser
        await browser.close()


@pytest.fixture
async def service() -> AsyncIterator[ServiceUnderTest]:
    async with serving(token=TOKEN) as service:
        yield service


@pytest.fixture
async def page(browser: Browser, service: ServiceUnderTest) -> AsyncIterator[Page]:
    """The page of a helper who has signed in; nothing may have gone wrong in its scripts."""
    mistakes: list[str] = []
    page = await (await browser.new_context()).new_page()
    page.on("pageerror", lambda error: mistakes.append(str(error)))
    page.on("console", lambda message: _note(message, mistakes))
    await page.goto(service.url)
    await page.get_by_label("Token").fill(TOKEN)
    await page.get_by_role("button", name="Sign in").click()
    await expect(page.locator("#connection")).to_have_text("Connected")
    yield page
    await page.close()
    assert mistakes == []


def _note(message: ConsoleMessage, mistakes: list[str]) -> None:
    if message.type == "error" and "Content Security Policy" in message.text:
        mistakes.append(message.text)


async def test_wrong_token_is_refused(browser: Browser, service: ServiceUnderTest) -> None:
    page = await browser.new_page()
    await page.goto(service.url)
    await page.get_by_label("Token").fill("wrong")
    await page.get_by_role("button", name="Sign in").click()
    await expect(page.locator("#sign-in-error")).to_have_text("This is not the token.")
    await expect(page.locator("#work")).to_be_hidden()


async def test_question_is_answered_with_a_click(page: Page, service: ServiceUnderTest) -> None:
    run = await service.runs.start_run(REQUEST)
    view = await service.runs.raise_issue(run.id)
    assert view.prompt is not None
    await expect(page.locator("#asked-text")).to_have_text(view.prompt.text)
    await expect(page.locator("#yes-effect")).to_have_text(view.prompt.answers[0].effect)
    await expect(page.locator("#no-effect")).to_have_text(view.prompt.answers[1].effect)
    await expect(page.locator("#asked-picture")).to_have_attribute(
        "src", f"/api/pictures/{view.picture}"
    )
    box = await page.locator("#yes").bounding_box()
    assert box is not None
    assert min(box["width"], box["height"]) >= 96
    await page.get_by_role("button", name="Yes").click()
    await expect(page.locator("#asked-text")).to_have_text("Nothing to answer.")
    await expect(page.locator("#transcript")).to_contain_text("helper: yes.")
    assert service.runs.dialogue(view.dialogue).answered_by == "helper"


async def test_question_is_answered_with_a_key(page: Page, service: ServiceUnderTest) -> None:
    run = await service.runs.start_run(REQUEST)
    view = await service.runs.raise_issue(run.id)
    await expect(page.locator("#answers")).to_be_visible()
    await page.get_by_label("Seed").press("n")
    assert service.runs.dialogue(view.dialogue).status == "open"
    await page.get_by_label("Seed").blur()
    await page.keyboard.press("n")
    await expect(page.locator("#asked-text")).to_have_text("Nothing to answer.")
    await expect(page.locator("#transcript")).to_contain_text("helper: no.")


async def test_answer_of_another_helper_is_shown(page: Page, service: ServiceUnderTest) -> None:
    run = await service.runs.start_run(REQUEST)
    view = await service.runs.raise_issue(run.id)
    assert view.prompt is not None
    await service.runs.claim(view.dialogue, "anna")
    await expect(page.locator("#claim-note")).to_have_text("anna is on it.")
    await service.runs.answer(view.dialogue, view.prompt.prompt, "yes", "anna")
    await expect(page.locator("#answer-note")).to_have_text("anna answered yes.")
    await expect(page.locator("#asked-text")).to_have_text("Nothing to answer.")


async def test_run_is_started_watched_paused_and_aborted(
    page: Page, service: ServiceUnderTest
) -> None:
    await page.get_by_role("combobox", name="Tree").select_option("eket")
    await page.get_by_label("World").fill("tabletop")
    await page.get_by_label("Scenario").select_option("eket_paper")
    await page.get_by_label("Speed").fill("max")
    await page.get_by_role("button", name="Start").click()
    await expect(page.locator("#runs button")).to_have_text("eket · tabletop · running")
    await expect(page.locator("#nodes")).to_contain_text("pink_bar active by robot")
    (run,) = service.runs.runs()
    assert (run.scenario, run.speed) == ("eket_paper", "max")
    await page.get_by_role("button", name="Pause").click()
    await expect(page.locator("#transcript")).to_contain_text("The run is paused.")
    await page.get_by_role("button", name="Resume").click()
    await page.get_by_role("button", name="Abort").click()
    await expect(page.locator("#runs button")).to_have_text("eket · tabletop · aborted")
    await expect(page.locator("#run-buttons")).to_be_hidden()


async def test_wrong_start_is_explained(page: Page, service: ServiceUnderTest) -> None:
    await page.get_by_label("World").fill("moon")
    await page.get_by_role("button", name="Start").click()
    await expect(page.locator("#start-error")).to_contain_text("there is no world 'moon'")
    assert service.runs.runs() == []


async def test_lost_connection_is_made_again_without_missing_a_question(
    page: Page, service: ServiceUnderTest
) -> None:
    run = await service.runs.start_run(REQUEST)
    await page.context.set_offline(True)
    await page.evaluate("window.dispatchEvent(new Event('offline'))")
    for subscription in tuple(service.journal.subscribers._live):
        subscription.close()
    await expect(page.locator("#connection")).to_contain_text("Connection lost")
    view = await service.runs.raise_issue(run.id)
    assert view.prompt is not None
    await page.context.set_offline(False)
    await expect(page.locator("#asked-text")).to_have_text(view.prompt.text, timeout=15_000)
    await expect(page.locator("#connection")).to_have_text("Connected")
