"""Nothing is on top of something else: that it is found, and the names in the scene."""

from pathlib import Path

import pytest
from console_in_browser import OpenPage, settle
from console_situations import ask, run_in_building
from playwright.async_api import Page, expect
from playwright.async_api import TimeoutError as PlaywrightTimeout

from mend.server.composition import Service

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

OVERLAPS = (Path(__file__).parent / "overlaps.js").read_text().strip()
WIDTHS = (360, 768, 1440)
ZOOMED_PHONE = 195
# Nothing is under a bar that sticks to an edge by the chance of where the page is scrolled to.
TALL = 4800


# Names of what moves are laid out anew three times a second: until then one may be over another.
LAID_OUT_MS = 1500


async def overlaps(page: Page) -> list[str]:
    """What is in the way of something else on a page, and stays there."""
    none = f"() => ({OVERLAPS})().length === 0"
    try:
        await page.wait_for_function(none, timeout=LAID_OUT_MS)
    except PlaywrightTimeout:
        found: list[str] = await page.evaluate(OVERLAPS)
        return found
    return []


async def test_what_overlaps_is_found(open_page: OpenPage) -> None:
    page = await open_page("/settings")
    await settle(page)
    assert await overlaps(page) == []
    await page.get_by_text("Colours", exact=True).evaluate(
        "each => { each.style.position = 'relative'; each.style.top = '48px'; }"
    )
    assert any("Colours" in each for each in await overlaps(page))


async def test_names_in_the_scene_do_not_overlap(service: Service, open_page: OpenPage) -> None:
    run = await ask(service)
    page = await open_page(
        f"/runs/{run}", drawn=True, viewport={"width": WIDTHS[0], "height": TALL}
    )
    tab = page.get_by_role("tab", name="Scene")
    names = page.get_by_role("button", name="Names")
    for width in WIDTHS:
        await page.set_viewport_size({"width": width, "height": TALL})
        await expect(tab.or_(names).first).to_be_visible()
        if await tab.is_visible():
            await tab.click()
        if await names.get_attribute("aria-pressed") != "true":
            await names.click()
        await expect(page.locator(".scene-name:not([hidden])")).to_have_count(5)
        assert await overlaps(page) == [], width


async def test_a_building_and_home_are_as_wide_as_a_phone_at_200_percent(
    service: Service, open_page: OpenPage
) -> None:
    page = await run_in_building(service, open_page)
    await page.set_viewport_size({"width": ZOOMED_PHONE, "height": 422})
    await page.get_by_role("tab", name="Building").click()
    await expect(page.get_by_role("list", name="Robots")).to_be_visible()
    assert await page.evaluate("document.scrollingElement.scrollWidth") == ZOOMED_PHONE
    await page.goto("/")
    await page.get_by_text("What else goes on").click()
    name = page.get_by_role("region", name="Robots").get_by_role("link", name="ROBOT1")
    # A word is on one line, and not a letter on each.
    height_px = await name.evaluate("each => each.getBoundingClientRect().height")
    line_px = await name.evaluate("each => parseFloat(getComputedStyle(each).lineHeight)")
    assert height_px < 2 * line_px
    assert await page.evaluate("document.scrollingElement.scrollWidth") == ZOOMED_PHONE
