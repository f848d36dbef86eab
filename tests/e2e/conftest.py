"""A real browser on a real service: what every test of the console starts from."""

import contextlib
from collections.abc import AsyncIterator, Awaitable, Callable
from pathlib import Path

import pytest
import pytest_asyncio
from bare_chromium import CHROMIUM, launch
from console_in_browser import NO_WEBGL, TOKEN, OpenPage, Stage
from played_dialogues import PlayedDialogues
from playwright.async_api import (
    Browser,
    BrowserContext,
    ConsoleMessage,
    Page,
    async_playwright,
    expect,
)
from service_under_test import serving

from mend.server.api.console import BUILT
from mend.server.composition import Service, open_service
from mend.server.runtime.requests import RunRequest
from mend.server.settings import Settings

HERE = Path(__file__).parent

# Patience costs nothing where all is well, and a busy machine may be slow.
expect.set_options(timeout=60_000)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Each test of the console is a slow one, and needs a browser and the built page."""
    missing = "there is no Chromium on this machine" if CHROMIUM is None else None
    if missing is None and not (BUILT / "index.html").is_file():
        missing = "the console is not built (make console)"
    for item in items:
        if HERE not in item.path.parents:
            continue
        item.add_marker(pytest.mark.browser)
        item.add_marker(pytest.mark.slow(5))
        if missing is not None:
            item.add_marker(pytest.mark.skip(reason=missing))


@pytest_asyncio.fixture(scope="session", loop_scope="session")
async def browser() -> AsyncIterator[Browser]:
    async with async_playwright() as playwright:
        browser = await launch(playwright)
        yield browser
        await browser.close()


@pytest_asyncio.fixture(loop_scope="session")
async def service(tmp_path: Path) -> AsyncIterator[Service]:
    """The whole service, on a journal of its own; it is read, not heard."""
    async with _whole_service(tmp_path) as service:
        yield service


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def lasting_service(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[Service]:
    """One for all tests of a module that leave nothing behind in it."""
    async with _whole_service(tmp_path_factory.mktemp("lasting")) as service:
        yield service


@contextlib.asynccontextmanager
async def _whole_service(folder: Path) -> AsyncIterator[Service]:
    settings = Settings(
        data_dir=folder,
        port=0,
        token=TOKEN,
        speech_voice="none",
        push_services=["127.0.0.1"],
    )
    async with open_service(settings) as service:
        yield service


@pytest_asyncio.fixture(loop_scope="session")
async def open_page(browser: Browser, service: Service) -> AsyncIterator[OpenPage]:
    """Opens the console as a helper who is signed in; nothing may go wrong in its scripts."""
    async with _opening_pages(browser, service.url) as open_page:
        yield open_page


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def lasting_page(browser: Browser, lasting_service: Service) -> AsyncIterator[Page]:
    """A page at the lasting service: to go on in one takes a third of what opening one takes."""
    async with _opening_pages(browser, lasting_service.url) as open_page:
        yield await open_page()


@pytest_asyncio.fixture(loop_scope="session")
async def reopen(lasting_page: Page) -> Callable[[str], Awaitable[Page]]:
    """`await reopen(path)`: the lasting page, which remembers nothing of other tests."""

    async def reopen(path: str) -> Page:
        await lasting_page.evaluate("() => { localStorage.clear(); sessionStorage.clear(); }")
        await lasting_page.goto(path)
        await lasting_page.get_by_role("status").filter(has_text="Connected").wait_for()
        return lasting_page

    return reopen


@pytest_asyncio.fixture(loop_scope="session")
async def stage(browser: Browser) -> AsyncIterator[Stage]:
    """A service on which a test plays the robot, and the consoles at it."""
    async with (
        serving(runs_in=PlayedDialogues, token=TOKEN) as service,
        _opening_pages(browser, service.url) as open_page,
    ):
        assert isinstance(service.runs, PlayedDialogues)
        run = await service.runs.start_run(RunRequest(tree="eket", world="tabletop"))
        yield Stage(service.runs, run.id, open_page)


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def played(browser: Browser) -> AsyncIterator[tuple[PlayedDialogues, OpenPage]]:
    """One service for all stages of a module, and who opens each helper's page at it once."""
    pages: dict[str, Page] = {}
    async with (
        serving(runs_in=PlayedDialogues, token=TOKEN) as service,
        _opening_pages(browser, service.url) as open_page,
    ):

        async def reopen(path: str = "/", helper: str = "anna") -> Page:
            page = pages.get(helper)
            if page is None:
                pages[helper] = page = await open_page(path, helper)
            else:
                await page.goto(path)
                await page.get_by_role("status").filter(has_text="Connected").wait_for()
            return page

        assert isinstance(service.runs, PlayedDialogues)
        yield service.runs, reopen


@pytest_asyncio.fixture(loop_scope="session")
async def lasting_stage(
    played: tuple[PlayedDialogues, OpenPage],
) -> AsyncIterator[Stage]:
    """As `stage`, on pages that others were at: for who leaves their clock and connection alone."""
    runs, reopen = played
    pages: list[Page] = []

    async def open_page(path: str = "/", helper: str = "anna") -> Page:
        pages.append(await reopen(path, helper))
        return pages[-1]

    run = await runs.start_run(RunRequest(tree="eket", world="tabletop"))
    yield Stage(runs, run.id, open_page)
    for page in pages:
        # Nothing runs there, and nobody is at it any more.
        await page.goto("/icon.svg")
        await page.evaluate("() => { localStorage.clear(); sessionStorage.clear(); }")
    await runs.leave_nothing()
    await runs.abort(run.id)


@contextlib.asynccontextmanager
async def _opening_pages(browser: Browser, url: str) -> AsyncIterator[OpenPage]:
    mistakes: list[str] = []
    contexts: list[BrowserContext] = []

    async def open_page(
        path: str = "/",
        helper: str = "anna",
        *,
        drawn: bool = False,
        connected: str = "Connected",
        **options: object,
    ) -> Page:
        context = await browser.new_context(base_url=url, **options)
        contexts.append(context)
        if not drawn:
            await context.add_init_script(NO_WEBGL)
        signed_in = await context.request.post("/api/session", data={"token": TOKEN})
        assert signed_in.status == 204
        await context.add_init_script(f"localStorage.setItem('mend.helper', '\"{helper}\"')")
        page = await context.new_page()
        page.on("pageerror", lambda error: mistakes.append(str(error)))
        page.on("console", lambda message: _note(message, mistakes))
        await page.goto(path)
        await page.get_by_role("status").filter(has_text=connected).wait_for()
        return page

    yield open_page
    for context in contexts:
        for page in context.pages:
            # What is still on its way is nobody's any more.
            await page.unroute_all(behavior="ignoreErrors")
        await context.close()
    assert mistakes == []


def _note(message: ConsoleMessage, mistakes: list[str]) -> None:
    if message.type == "error" and "Content Security Policy" in message.text:
        mistakes.append(message.text)
