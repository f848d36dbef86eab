"""Every view for everybody: axe, WCAG 2.2 A and AA, and where the focus is."""

from pathlib import Path
from typing import Any

import pytest
from console_in_browser import OpenPage, settle
from console_situations import SITUATIONS, Situation, live_run, open_question
from playwright.async_api import Page, ViewportSize

from server.composition import Service

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

AXE = Path(__file__).parents[2] / "web/node_modules/axe-core/axe.min.js"
LEVELS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"]
PHONE = ViewportSize(width=360, height=640)
# Tall: all of a page is looked at, and not only what the chance of scrolling shows of it.
SIZES = [PHONE, ViewportSize(width=360, height=3000), ViewportSize(width=1440, height=3000)]

MOST_TABS = 60
# What has the focus, and whether some of it can be seen; null once the page has been gone through.
FOCUSED = """() => {
    const focused = document.activeElement;
    if (focused === null || focused === document.body) return null;
    const { left, top, width, height } = focused.getBoundingClientRect();
    const at = (x, y) => document.elementFromPoint(left + x * width, top + y * height);
    const spots = [at(0.5, 0.5), at(0.1, 0.1), at(0.9, 0.1), at(0.1, 0.9), at(0.9, 0.9)];
    const mine = (spot) => spot !== null && focused.contains(spot);
    const name = focused.getAttribute("aria-label") ?? focused.textContent;
    return { name, seen: spots.some(mine) };
}"""

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


@VIEWS
@pytest.mark.parametrize("theme", ["light", "dark"])
async def test_axe_finds_nothing(
    service: Service, open_page: OpenPage, situation: Situation, theme: str
) -> None:
    async def opened(path: str) -> Page:
        return await open_page(path, viewport=SIZES[0], color_scheme=theme, bypass_csp=True)

    page = await situation(service, opened)
    await page.add_script_tag(path=AXE)
    for size in SIZES:
        await page.set_viewport_size(size)
        await settle(page)
        assert await violations(page) == [], size


@pytest.mark.parametrize("situation", [open_question, live_run])
async def test_focus_is_never_hidden_by_what_sticks_to_an_edge(
    service: Service, open_page: OpenPage, situation: Situation
) -> None:
    async def opened(path: str) -> Page:
        return await open_page(path, viewport=PHONE)

    page = await situation(service, opened)
    seen = set()
    for _ in range(MOST_TABS):
        await page.keyboard.press("Tab")
        focused = await page.evaluate(FOCUSED)
        if focused is None:
            break
        assert focused["seen"], focused["name"]
        seen.add(focused["name"])
    assert len(seen) >= 8
