"""Every view at every width, light and dark: what axe finds, what overlaps, what sticks out.

Each is played once, and all is looked at in it.
"""

from collections.abc import Sequence
from typing import TypeAlias

import pytest
from console_in_browser import OpenPage, settle
from console_situations import SITUATIONS, Situation
from playwright.async_api import Page, ViewportSize
from sampled import sample
from test_accessibility import PHONE, RULES, Theme, load_axe, violations
from test_layout import TALL, WIDTHS, overlaps

from mend.server.composition import Service

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

Themes: TypeAlias = Sequence[Theme]
BOTH: Themes = ("light", "dark")
NEITHER: Themes = ()
"""A page as wide as the phone: axe has gone through it there."""

# Controls that look like plain text where a page has the system's colours alone.
UNMARKED = """() => [...document.querySelectorAll("button, .button")]
    .filter(each => each.checkVisibility() && each.closest("svg") === null)
    .filter(each => {
        const { borderTopWidth, borderBottomWidth, textDecorationLine } = getComputedStyle(each);
        return borderTopWidth === "0px" && borderBottomWidth === "0px"
            && textDecorationLine === "none";
    })
    .map(each => each.getAttribute("aria-label") ?? each.className ?? each.textContent)"""

ZOOMED = ViewportSize(width=320, height=256)
"""A window of 1280 x 1024 px at 400 %."""

# How wide, and in which themes axe goes through it, which takes longer than all else.
LOOKED_AT: Sequence[tuple[ViewportSize, Themes]] = [
    (PHONE, sample(("light",), BOTH)),
    (ZOOMED, NEITHER),
    *(
        # Tall: all of a page is looked at, and not only what the chance of scrolling shows of it.
        (ViewportSize(width=width, height=TALL), themes)
        for width, themes in zip(WIDTHS, (NEITHER, sample(("light",), BOTH), BOTH), strict=True)
    ),
]


@pytest.mark.parametrize("situation", SITUATIONS.values(), ids=SITUATIONS)
async def test_nothing_is_wrong_with_it(
    service: Service, open_page: OpenPage, situation: Situation
) -> None:
    async def opened(path: str) -> Page:
        return await open_page(path, viewport=PHONE, color_scheme="light")

    page = await situation(service, opened)
    await load_axe(page)
    for size, themes in LOOKED_AT:
        await page.set_viewport_size(size)
        if size is not PHONE:
            # A theme moves nothing.
            await settle(page)
            assert await overlaps(page) == [], size
        for theme in themes:
            await page.emulate_media(color_scheme=theme)
            await settle(page)
            assert await violations(page, RULES[theme]) == [], f"{size}, {theme}"
        beyond = await page.evaluate("document.documentElement.scrollWidth - innerWidth")
        assert beyond <= 0, f"{beyond} px too wide at {size}"
    await page.emulate_media(forced_colors="active")
    assert await page.evaluate(UNMARKED) == []
