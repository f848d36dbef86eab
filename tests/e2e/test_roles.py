"""The console of a principal: called by the token's name, without what the role may not do."""

from collections.abc import AsyncIterator
from pathlib import Path

import pytest
import pytest_asyncio
from people import People
from played_dialogues import PlayedDialogues
from playwright.async_api import Browser, Page, expect
from service_under_test import ServiceUnderTest, serving

from mend.server.access.roles import Role
from mend.server.runtime.requests import RunRequest

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")


class Consoles:
    """A service with principals, whose run asks a question."""

    def __init__(self, browser: Browser, service: ServiceUnderTest, people: People) -> None:
        self._browser = browser
        self.service = service
        self.people = people

    async def signed_in(self, role: Role) -> Page:
        page = await self._browser.new_page(base_url=self.service.url)
        await page.goto("/")
        await page.get_by_label("Token").fill(self.people.tokens[role])
        await page.get_by_role("button", name="Sign in").click()
        await expect(page.get_by_role("status").first).to_have_text("Connected")
        return page


@pytest_asyncio.fixture(loop_scope="session")
async def consoles(browser: Browser, tmp_path: Path) -> AsyncIterator[Consoles]:
    people = People(tmp_path)
    async with serving(runs_in=PlayedDialogues, principals=people.file) as service:
        yield Consoles(browser, service, people)


async def test_a_viewer_sees_the_question_and_cannot_answer(consoles: Consoles) -> None:
    runs = consoles.service.runs
    run = await runs.start_run(RunRequest(tree="eket", world="tabletop"))
    await runs.raise_issue(run.id)
    page = await consoles.signed_in(Role.VIEWER)
    yes = page.get_by_role("button", name="YES")
    await expect(yes).to_be_disabled()
    await expect(page.get_by_text("Answering needs the role helper")).to_be_visible()
    await expect(page.get_by_role("button", name="I am on it")).to_have_count(0)
    await page.goto("/runs")
    await expect(page.get_by_role("heading", name="Runs")).to_be_visible()
    await expect(page.get_by_role("link", name="Start a run")).to_have_count(0)
    await page.goto("/models")
    await expect(page.get_by_text("There is no model yet")).to_be_visible()
    await expect(page.get_by_label("Give a model")).to_have_count(0)
    await page.close()


async def test_a_helper_is_called_as_the_token_says_and_answers(consoles: Consoles) -> None:
    runs = consoles.service.runs
    run = await runs.start_run(RunRequest(tree="eket", world="tabletop"))
    view = await runs.raise_issue(run.id)
    page = await consoles.signed_in(Role.HELPER)
    await expect(page.get_by_role("link", name="henri")).to_be_visible()
    await page.get_by_role("button", name="I am on it").click()
    await expect(page.get_by_text("You are on it.")).to_be_visible()
    assert runs.dialogue_now(view.dialogue).claimed_by == "henri"
    await page.goto("/start")
    await expect(page.get_by_text("Starting a run needs the role operator")).to_be_visible()
    await expect(page.get_by_role("button", name="Start the run")).to_be_disabled()
    await page.close()


async def test_an_operator_starts_runs(consoles: Consoles) -> None:
    page = await consoles.signed_in(Role.OPERATOR)
    await page.goto("/runs")
    await expect(page.get_by_role("link", name="Start a run")).to_be_visible()
    await page.close()
