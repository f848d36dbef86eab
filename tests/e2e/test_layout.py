"""Every view at every width: nothing on top of something else, nothing beyond the edge."""

from pathlib import Path

import pytest
from console_in_browser import OpenPage, settle
from console_situations import SITUATIONS, Situation, ask
from playwright.async_api import Page, expect

from mend.server.composition import Service

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

OVERLAPS = (Path(__file__).parent / "overlaps.js").read_text()
WIDTHS = (360, 768, 1440)
# Nothing is under a bar that sticks to an edge by the chance of where the page is scrolled to.
TALL = 3000


async def overlaps(page: Page) -> list[str]:
    """What is in the way of something else on a page as it is shown now."""
    found: list[str] = await page.evaluate(OVERLAPS)
    return found


@pytest.mark.parametrize("situation", SITUATIONS.values(), ids=SITUATIONS)
async def test_nothing_overlaps_and_nothing_has_to_be_scrolled_sideways(
    service: Service, open_page: OpenPage, situation: Situation
) -> None:
    page = await situation(service, open_page)
    for width in WIDTHS:
        await page.set_viewport_size({"width": width, "height": TALL})
        for theme in ("light", "dark"):
            await page.emulate_media(color_scheme=theme)
            await settle(page)
            assert await overlaps(page) == [], f"{width} px, {theme}"
        beyond = await page.evaluate("document.documentElement.scrollWidth - innerWidth")
        assert beyond <= 0, f"{beyond} px too wide at {width} px"


async def test_what_overlaps_is_found(open_page: OpenPage) -> None:
    page = await open_page("/settings")
    await settle(page)
    assert await overlaps(page) == []
    await page.get_by_text("Colours", exact=True).evaluate(
        "each => { each.style.position = 'relative'; each.style.top = '48px'; }"
    )
    assert any("Colours" in each for each in await overlaps(page))


@pytest.mark.parametrize("width", WIDTHS)
async def test_names_in_the_scene_do_not_overlap(
    service: Service, open_page: OpenPage, width: int
) -> None:
    run = await ask(service)
    page = await open_page(f"/runs/{run}", viewport={"width": width, "height": TALL})
    tab = page.get_by_role("tab", name="Scene")
    names = page.get_by_role("button", name="Names")
    await expect(tab.or_(names)).to_be_visible()
    if await tab.is_visible():
        await tab.click()
    await names.click()
    await expect(page.locator(".scene-name:not([hidden])")).to_have_count(5)
    assert await overlaps(page) == []
