"""A browser that asks for German: the helper's way from the question to its end, and every page."""

from pathlib import Path

import pytest
from console_in_browser import OpenPage, Stage, settle
from console_situations import SITUATIONS, Situation, delete_tree, read_in_german, sign_in
from played_dialogues import DETECTION
from playwright.async_api import expect
from test_accessibility import RULES, load_axe, violations
from test_layout import TALL, overlaps

from mend.server.composition import Service

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")

ENGLISH_LEFT = (Path(__file__).parent / "english_left.js").read_text().strip()
NARROW_PX, WIDE_PX = 360, 1440

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
# What only a press opens is gone with the page that it was opened on.
LASTING = [each for each in SITUATIONS.values() if each not in (delete_tree, sign_in)]


async def test_a_question_is_answered_to_its_end_and_then_in_english(stage: Stage) -> None:
    page = await stage.open_page(locale="de-DE", connected="Verbunden")
    await expect(page.locator("html")).to_have_attribute("lang", "de")
    await expect(page.get_by_text("Kein Roboter fragt etwas")).to_be_visible()
    dialogue = await stage.runs.open(stage.run, "missed")
    heading = page.get_by_role("heading", level=2)
    await expect(heading).to_have_text("„yellow bar“ auf den Tisch zurücklegen")
    await expect(page.get_by_role("alert").first).to_contain_text(
        "Legen Sie es auf den Tisch zurück?"
    )
    await page.get_by_role("button", name="Es auf den Tisch zurücklegen").click()
    await expect(page.get_by_text("Sie haben zugesagt")).to_be_visible()
    await stage.runs.see(dialogue)
    told = page.get_by_role("status", name="Was aus Fragen geworden ist")
    await expect(told).to_contain_text("Danke. Ich sehe „yellow bar“ wieder auf dem Tisch.")

    await page.get_by_role("link", name="anna").click()
    await page.get_by_role("radio", name="English").check()
    await expect(page.get_by_role("heading", name="Settings")).to_be_visible()
    await expect(page.locator("html")).to_have_attribute("lang", "en")
    await page.goto("/")
    await stage.runs.open(stage.run, "missed")
    await expect(heading).to_have_text("Put the yellow bar back on the table")


async def test_what_a_robot_says_in_words_of_its_own_is_marked_as_english(stage: Stage) -> None:
    page = await stage.open_page(locale="de-DE", connected="Verbunden")
    squeaks = DETECTION.model_copy(update={"explanation": "the wheel squeaks"})
    await stage.runs.open(stage.run, "dropped", detection=squeaks)
    await expect(page.get_by_role("heading", level=2)).to_contain_text("zurücklegen")
    await expect(page.locator("[lang=en]", has_text="the wheel squeaks")).to_be_visible()


async def test_a_browser_with_a_language_that_there_is_not_reads_english(stage: Stage) -> None:
    page = await stage.open_page(locale="fi-FI")
    await expect(page.get_by_text("No robot asks anything.")).to_be_visible()


@pytest.mark.parametrize("situation", LASTING, ids=lambda each: each.__name__)
async def test_every_page_is_german_and_has_room_for_it(
    service: Service, open_page: OpenPage, situation: Situation
) -> None:
    page = await situation(service, open_page)
    await page.set_viewport_size({"width": NARROW_PX, "height": TALL})
    await read_in_german(page)
    await expect(page.locator("main")).to_be_visible()
    await expect(page.get_by_text("Wird geladen …")).to_have_count(0)
    await load_axe(page)
    for width in (NARROW_PX, WIDE_PX):
        await page.set_viewport_size({"width": width, "height": TALL})
        await settle(page)
        assert await overlaps(page) == [], width
        assert await violations(page, RULES["light"]) == [], width
        beyond = await page.evaluate("document.documentElement.scrollWidth - innerWidth")
        assert beyond <= 0, f"{beyond} px too wide at {width}"
    left = await page.evaluate(ENGLISH_LEFT)
    assert [each for each in left if not any(own in each for own in OWN_WORDS)] == []
