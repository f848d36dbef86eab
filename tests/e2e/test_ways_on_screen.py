"""Somebody who has never seen a question reads little, presses what fits, and gets what it says.

The player knows nothing but what stands on the screen: the headline, the buttons, what each does.
"""

from typing import Any
from uuid import UUID

import pytest
from console_in_browser import Stage
from played_dialogues import DETECTION
from playwright.async_api import Page, expect
from sampled import sample
from ways_on_screen import MOST_WORDS, came_as_said, effect_of, labels_on, of, read_before

from mend.dialogue.outlook import Outlook
from mend.dialogue.registry import load_scripts
from mend.dialogue.script import CloseReason
from mend.server.journal import events as ev

pytestmark = pytest.mark.asyncio(loop_scope="session")

ARMED_AFTER_MS = 550
HELD_MS = 3_100

LASER = DETECTION.model_copy(update={"camera": "laser", "guesses": ["at F1 101", "near F2 204"]})
IN_A_BUILDING: dict[str, Any] = {
    "object": None,
    "place": "F1_101",
    "item": "mail",
    "message": "Lunch is ready",
    "person": "Dr Lee",
    "detection": LASER,
}
SITUATIONS = {
    "first time": {"outlook": Outlook()},
    "again": {"outlook": Outlook(attempt=2, times=2)},
    "too often": {"outlook": Outlook(attempt=3, times=3, unchanged=3)},
    "in a building": {"outlook": Outlook(attempt=2, times=2), **IN_A_BUILDING},
    "felt": {"detection": DETECTION.model_copy(update={"felt": True})},
    "seen nowhere": {"detection": DETECTION.model_copy(update={"center": None})},
}


@pytest.mark.drawn(3)
@pytest.mark.slow(5)
@pytest.mark.parametrize("situation", SITUATIONS)
async def test_each_button_does_what_it_says_after_few_words(stage: Stage, situation: str) -> None:
    page = await stage.open_page()
    # Time passes as soon as the test says so.
    await page.clock.install()
    for kind in kinds_in(situation):
        number = 0
        while await play(stage, page, kind, situation, number):
            number += 1
        assert number >= 2, kind


def kinds_in(situation: str) -> list[str]:
    """Every kind that there is so; in the suite every other one, in one usual situation."""
    kinds = sorted(load_scripts())
    if situation == "felt":
        return ["blocked"]
    if situation == "seen nowhere":
        return ["undone", "missing"]
    usual = list(SITUATIONS)[:4]
    return sample(kinds[usual.index(situation) :: 2 * len(usual)], kinds)


async def play(stage: Stage, page: Page, kind: str, situation: str, number: int) -> bool:
    """Press the button of that number, if there is one; everything comes as it said."""
    dialogue = await stage.runs.open(stage.run, kind, **SITUATIONS[situation])
    await expect(page.locator(".way").first).to_be_visible()
    labels = await labels_on(page)
    if number == len(labels):
        await stage.runs.call(dialogue, "abort")
        await expect(page.locator(".way")).to_have_count(0)
        return False
    label = labels[number]
    about = f"{label!r} of {kind}, {situation}"
    read = await read_before(page, label)
    assert len(read) <= MOST_WORDS, (about, read)
    said = await effect_of(page, label)
    await press(page, label)
    if said.startswith("You ") and "both of us" not in said:
        await expect(page.get_by_text("It goes on by itself as soon as")).to_be_visible()
    await finish(stage, dialogue)
    await expect(page.get_by_text("No robot asks anything")).to_be_visible()
    events = await stage.runs.came_of(dialogue)
    assert came_as_said(said, events), (about, said)
    assert of(events, ev.DialogueClosed)[0].reason in (CloseReason.RESOLVED, CloseReason.LEFT_OUT)
    return True


async def press(page: Page, label: str) -> None:
    await page.clock.fast_forward(ARMED_AFTER_MS)
    await page.locator(".way").filter(has_text=label).first.click()
    await page.clock.fast_forward(HELD_MS)
    await expect(page.locator(".way")).to_have_count(0)


async def finish(stage: Stage, dialogue: UUID) -> None:
    """What was promised is done, and the robot is through with it."""
    if stage.runs.dialogue_now(dialogue).awaiting == "help":
        await stage.runs.see(dialogue)
    await stage.runs.finish_leaf(dialogue)


async def test_a_way_is_chosen_by_its_number(stage: Stage) -> None:
    page = await stage.open_page()
    dialogue = await stage.runs.open(stage.run, "dropped")
    await expect(page.locator(".way").first).to_be_enabled()
    await page.keyboard.press("2")
    await expect(
        page.get_by_text("The robot watches for the yellow bar at its place")
    ).to_be_visible()
    answers = of(await stage.runs.came_of(dialogue), ev.Answered)
    assert [each.answer for each in answers] == ["no", "yes"]


async def test_a_way_that_ends_the_dialogue_can_be_undone(stage: Stage) -> None:
    page = await stage.open_page()
    dialogue = await stage.runs.open(stage.run, "dropped")
    await page.clock.install()
    await page.clock.fast_forward(ARMED_AFTER_MS)
    await page.get_by_role("button", name="Not now").click()
    await expect(page.get_by_text("“Not now” is sent in a moment")).to_be_visible()
    await page.get_by_role("button", name="Undo").click()
    await page.clock.fast_forward(10_000)
    assert stage.runs.dialogue_now(dialogue).awaiting == "answer"
    await page.get_by_role("button", name="Not now").click()
    await page.goto("/icon.svg")
    await expect_answers(stage, dialogue, ["no", "no"])


async def expect_answers(stage: Stage, dialogue: UUID, expected: list[str]) -> None:
    page = await stage.open_page()
    await expect(page.get_by_text("No robot asks anything")).to_be_visible()
    answers = of(await stage.runs.came_of(dialogue), ev.Answered)
    assert [each.answer for each in answers] == expected
