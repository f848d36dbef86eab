"""For everybody: that axe finds what is wrong, and where the focus is."""

from collections.abc import Mapping
from typing import Any, Literal

import pytest
from axe_in_page import WCAG, load_axe, violations
from console_in_browser import OpenPage, settle
from console_situations import Situation, live_run, open_question
from playwright.async_api import Page, ViewportSize

from mend.server.composition import Service

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

Theme = Literal["light", "dark"]

# A theme changes colours and nothing else: of the second one, only they are looked at.
COLORS = {"type": "rule", "values": ["color-contrast", "link-in-text-block"]}
RULES: Mapping[Theme, Mapping[str, Any]] = {"light": WCAG, "dark": COLORS}
PHONE = ViewportSize(width=360, height=640)

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


async def test_axe_finds_what_is_too_pale_in_one_theme_alone(open_page: OpenPage) -> None:
    page = await open_page("/settings", color_scheme="light", bypass_csp=True)
    await load_axe(page)
    await page.add_style_tag(
        content="@media (prefers-color-scheme: dark) { h1 { color: #222; background: #111 } }"
    )
    found = {}
    for theme, only in RULES.items():
        await page.emulate_media(color_scheme=theme)
        await settle(page)
        found[theme] = await violations(page, only)
    assert found["light"] == []
    assert [each.split(":")[0] for each in found["dark"]] == ["color-contrast"]


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
