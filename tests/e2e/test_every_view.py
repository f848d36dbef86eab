"""Every view at every width, light and dark: what axe finds, what overlaps, what sticks out.

Each that is drawn is played once, and all is looked at in it, in English and then in German.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import TypeAlias

import pytest
from console_in_browser import NO_WEBGL, OpenPage, settle
from console_situations import (
    SITUATIONS,
    Situation,
    delete_tree,
    finished_run,
    live_run,
    no_question,
    no_runs,
    part_to_be_added,
    question_in_german,
    read_in_german,
    run_in_german,
    scene_out_of_reach,
    scenes,
    settings,
    sign_in,
    trees,
    unknown,
    wrong_tree,
)
from playwright.async_api import Page, ViewportSize, expect
from sampled import sample
from test_accessibility import PHONE, RULES, Theme, load_axe, violations
from test_layout import TALL, WIDTHS, overlaps

from mend.server.composition import Service

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

Themes: TypeAlias = Sequence[Theme]
BOTH: Themes = ("light", "dark")
NEITHER: Themes = ()
"""axe has gone through a page as wide as the phone, or in the suite, as both of its neighbours."""

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
        for width, themes in zip(WIDTHS, (NEITHER, sample(NEITHER, BOTH), BOTH), strict=True)
    ),
]


# What leaves nothing behind in the service, so that one is enough for all.
QUIET = (
    no_question,
    no_runs,
    trees,
    wrong_tree,
    scenes,
    scene_out_of_reach,
    part_to_be_added,
    delete_tree,
    settings,
    unknown,
)
# Where the scene in 3-D is looked at among all else.
DRAWN = (live_run, finished_run)
# Looked at in German besides, as each view is in the end; in the benchmarks as much as all others.
TWICE = sample((question_in_german, run_in_german), ())
EVENTFUL = [each for each in SITUATIONS.values() if each not in (*QUIET, *TWICE)]
# Of what axe looks for hardly anything depends on the language.
AXE_IN_GERMAN = sample((*SITUATIONS.values(),)[::4], (*SITUATIONS.values(),))
# What only a press opens is gone with the page that it was opened on.
PRESSED = (delete_tree, sign_in)

ENGLISH_LEFT = (Path(__file__).parent / "english_left.js").read_text().strip()
# Names, what people have written, and what is understood in English alone.
OWN_WORDS = (
    "pick and place",
    "the blue parcel",
    "its wheel squeaks",
    "the glue is still wet",
    "Builds the base of an EKET cabinet",
    "I do the",
    "bring the mail",
    "bring this to",
    "„yes“",
)


@pytest.mark.drawn(5)
@pytest.mark.parametrize("situation", QUIET, ids=lambda each: each.__name__)
async def test_nothing_is_wrong_where_nothing_goes_on(
    lasting_service: Service, reopen: OpenPage, lasting_page: Page, situation: Situation
) -> None:
    await lasting_page.emulate_media(color_scheme="light", forced_colors="none")
    await lasting_page.set_viewport_size(PHONE)
    await expect_nothing_wrong(await situation(lasting_service, reopen), situation)


@pytest.mark.drawn(12)
@pytest.mark.parametrize("situation", EVENTFUL, ids=lambda each: each.__name__)
async def test_nothing_is_wrong_with_it(
    service: Service, open_page: OpenPage, situation: Situation
) -> None:
    drawn = situation in DRAWN

    async def opened(path: str) -> Page:
        return await open_page(path, drawn=drawn, viewport=PHONE, color_scheme="light")

    await expect_nothing_wrong(await situation(service, opened), situation)


async def expect_nothing_wrong(page: Page, situation: Situation) -> None:
    """In both languages; a page of the phone's size is open in the light theme, in English."""
    await expect_room_and_contrast(page)
    await page.emulate_media(forced_colors="active")
    assert await page.evaluate(UNMARKED) == []
    await page.emulate_media(forced_colors="none", color_scheme="light")
    if situation not in PRESSED:
        if situation in DRAWN:
            # A language changes nothing of that.
            await page.add_init_script(NO_WEBGL)
        await expect_room_for_german(page, axe=situation in AXE_IN_GERMAN)


async def expect_room_and_contrast(page: Page) -> None:
    """At every size."""
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


async def expect_room_for_german(page: Page, *, axe: bool) -> None:
    """As narrow and as wide as can be, and nothing is left in English."""
    await page.set_viewport_size({"width": WIDTHS[0], "height": TALL})
    await read_in_german(page)
    await expect(page.locator("main")).to_be_visible()
    await expect(page.get_by_text("Wird geladen …")).to_have_count(0)
    if axe:
        await load_axe(page)
    for width in (WIDTHS[0], WIDTHS[-1]):
        await page.set_viewport_size({"width": width, "height": TALL})
        await settle(page)
        assert await overlaps(page) == [], f"in German, {width}"
        beyond = await page.evaluate("document.documentElement.scrollWidth - innerWidth")
        assert beyond <= 0, f"{beyond} px too wide in German at {width}"
        if axe and (width == WIDTHS[0] or sample(False, True)):
            assert await violations(page, RULES["light"]) == [], f"in German, {width}"
    left = await page.evaluate(ENGLISH_LEFT)
    assert [each for each in left if not any(own in each for own in OWN_WORDS)] == []
