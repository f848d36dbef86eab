"""Helpers see who else is here, and whether they count as here themselves."""

import pytest
from axe_in_page import load_axe, violations
from console_in_browser import OpenPage
from playwright.async_api import Locator, Page, expect
from service_under_test import until

from mend.server.composition import Service

pytestmark = pytest.mark.asyncio(loop_scope="session")

LONG_MS = 301_000
AA = {"type": "tag", "values": ["wcag2a", "wcag2aa", "wcag21aa", "wcag22aa"]}
HIDE = """() => {
  Object.defineProperty(document, "visibilityState", { get: () => "hidden", configurable: true });
  document.dispatchEvent(new Event("visibilitychange"));
}"""


def who_helps(page: Page) -> Locator:
    return page.get_by_role("region", name="Who helps")


async def test_a_page_that_is_hidden_or_left_counts_as_away(
    service: Service, open_page: OpenPage
) -> None:
    ben = await open_page("/", helper="ben")
    anna = await open_page("/")
    await expect(who_helps(anna).get_by_role("listitem")).to_have_text(
        ["anna (you): here", "ben: here"]
    )
    await ben.evaluate(HIDE)
    await anna.clock.install()
    await anna.reload()
    away = "ben: away, with a page open"
    await expect(who_helps(anna).get_by_role("listitem")).to_have_text(["anna (you): here", away])
    await load_axe(anna)
    assert await violations(anna, AA) == []
    await anna.clock.fast_forward(LONG_MS)
    await expect(who_helps(anna).get_by_text("You count as away")).to_be_visible()
    await expect(anna.get_by_role("link", name="anna (away)")).to_be_visible()
    await until(lambda: {each.reach for each in service.runtime.helpers().helpers} == {"away"})
    await anna.mouse.move(100, 100)
    await expect(who_helps(anna).get_by_text("You count as here")).to_be_visible()


async def test_who_helps_alone_is_told_nothing_of_others(open_page: OpenPage) -> None:
    anna = await open_page("/")
    await expect(anna.get_by_text("No robot asks")).to_be_visible()
    await anna.wait_for_load_state("networkidle")
    await expect(who_helps(anna)).to_have_count(0)
