"""A browser that asks for German: the helper's way from the question to its end."""

import pytest
from console_in_browser import OpenPage, Stage
from office_with_fleet import open_office_with_fleet
from played_dialogues import DETECTION
from playwright.async_api import expect

from mend.fleet.requests import Transport
from mend.server.composition import Service
from mend.server.fleets.request_refused import RequestRefusedError

# One event loop for all tests of the console, and so one browser.
pytestmark = pytest.mark.asyncio(loop_scope="session")


async def test_a_question_is_answered_to_its_end_and_then_in_english(stage: Stage) -> None:
    page = await stage.open_page(locale="de-DE", connected="Verbunden")
    await expect(page.locator("html")).to_have_attribute("lang", "de")
    await expect(page.get_by_text("Kein Roboter fragt etwas")).to_be_visible()
    dialogue = await stage.runs.open(stage.run, "missed")
    heading = page.locator(".question").get_by_role("heading", level=2)
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
    await expect(page.locator(".question").get_by_role("heading", level=2)).to_contain_text(
        "zurücklegen"
    )
    await expect(page.locator("[lang=en]", has_text="the wheel squeaks")).to_be_visible()


async def test_a_browser_with_a_language_that_there_is_not_reads_english(stage: Stage) -> None:
    page = await stage.open_page(locale="fi-FI")
    await expect(page.get_by_text("No robot asks anything.")).to_be_visible()


async def test_why_a_request_is_refused_is_told_with_times_and_places_as_people_know_them(
    service: Service, open_page: OpenPage
) -> None:
    site = await open_office_with_fleet(service)
    parcel = Transport(
        name="paket", what="das Paket", origin="F1/101", destination="F1/106", latest_s=4.25
    )
    with pytest.raises(RequestRefusedError):
        await service.fleets.submit(site, parcel, None)
    page = await open_page("/requests", locale="de-DE", connected="Verbunden")
    refused = page.get_by_role("listitem").filter(has_text="Abgelehnt")
    await expect(refused).to_contain_text("ROBOT1 muss hinkommen, um „paket“ in F1 101 abzuholen")
    await expect(refused).to_contain_text("bis 4 s muss begonnen sein, „paket“ in F1 101 abzuholen")
    await expect(refused.locator("[lang=en]")).to_have_count(0)
