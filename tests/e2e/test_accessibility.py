"""Every view for everybody: axe, WCAG 2.2 A and AA; every width; the keyboard alone."""

from pathlib import Path
from typing import Any

import pytest
from console_in_browser import OpenPage
from console_situations import SITUATIONS, Situation
from playwright.async_api import Page

from server.composition import Service

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

AXE = Path(__file__).parents[2] / "web/node_modules/axe-core/axe.min.js"
LEVELS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"]
WIDTHS = (360, 768, 1440)
# Nothing is under a sticky bar by the chance of where the page is scrolled to.
TALL = 3000

VIEWS = pytest.mark.parametrize("situation", SITUATIONS.values(), ids=SITUATIONS)


async def violations(page: Page) -> list[str]:
    """What axe finds against WCAG on a page as it is shown now."""
    found: list[dict[str, Any]] = await page.evaluate(
        "async (levels) => (await axe.run({runOnly: levels})).violations", LEVELS
    )
    return [
        f"{each['id']}: {node['target']} {node['failureSummary']}"
        for each in found
        for node in each["nodes"]
    ]


async def settle(page: Page) -> None:
    """Let what moves come to its end: axe would judge colours on their way."""
    await page.evaluate(
        "() => Promise.all(document.getAnimations()"
        ".filter((each) => each.effect.getComputedTiming().endTime < Infinity)"
        ".map((each) => each.finished.catch(() => null)))"
    )


@VIEWS
@pytest.mark.parametrize("width", [360, 1440])
@pytest.mark.parametrize("theme", ["light", "dark"])
async def test_axe_finds_nothing(
    service: Service, open_page: OpenPage, situation: Situation, theme: str, width: int
) -> None:
    async def opened(path: str) -> Page:
        return await open_page(
            path,
            viewport={"width": width, "height": TALL},
            color_scheme=theme,
            bypass_csp=True,
        )

    page = await situation(service, opened)
    await page.add_script_tag(path=AXE)
    await settle(page)
    assert await violations(page) == []


@VIEWS
async def test_nothing_has_to_be_scrolled_sideways(
    service: Service, open_page: OpenPage, situation: Situation
) -> None:
    page = await situation(service, open_page)
    for width in WIDTHS:
        await page.set_viewport_size({"width": width, "height": 900})
        await settle(page)
        beyond = await page.evaluate("document.documentElement.scrollWidth - innerWidth")
        assert beyond <= 0, f"{beyond} px too wide at {width} px"
