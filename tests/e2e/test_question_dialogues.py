"""Dialogues by button, and every kind of answer by button and by key, in a real browser.

What each script says on each of its branches is for the tests of dialogues: the suite draws some
dialogues, and the benchmarks walk all of them, on all ways.
"""

import random
from collections.abc import Awaitable, Callable, Sequence
from uuid import UUID

import pytest
from console_in_browser import Stage
from dialogue_paths import Path, every_branch, every_kind_of_answer, shortest_of_each
from played_dialogues import DETECTION
from playwright.async_api import Page, expect
from sampled import sample

from mend.dialogue.conversation import Conversation
from mend.dialogue.outlook import Outlook
from mend.dialogue.registry import load_scripts
from mend.dialogue.script import Ask, AwaitHelp, Close, Remark, Turn
from mend.server.runtime.dialogue_state import converse
from mend.tasks.issue import Issue

pytestmark = pytest.mark.asyncio(loop_scope="session")

SCRIPTS = load_scripts()

# A little longer than the page takes answers after showing a question, and holds back a final one.
ARMED_AFTER_MS = 550
HELD_MS = 3_100

DRAWN = 7
"""So many dialogues the suite walks from their opening to their end."""

Answer = Callable[[Page, str], Awaitable[None]]


async def by_button(page: Page, answer: str) -> None:
    await page.locator(f".answer.{answer}").click()


async def by_key(page: Page, answer: str) -> None:
    # As soon as the button is seen to take it, and not before.
    await expect(page.locator(f".answer.{answer}")).to_be_enabled()
    await page.keyboard.press(answer[0])


@pytest.mark.slow(10)
async def test_dialogues_are_answered_by_button(stage: Stage) -> None:
    """All at one page: a page takes as long to open as a dialogue to be walked."""
    await walk(stage, sample(some_ways, every_way_through_each)(), by_button)


async def test_every_kind_of_answer_is_given_by_key(stage: Stage) -> None:
    every_kind = every_kind_of_answer(SCRIPTS, issue_of("dropped"))
    # The longest has yes and no, final and not, to an opening and after a look.
    longest = max(every_kind, key=lambda each: len(each[1]))
    await walk(stage, sample([longest], every_kind), by_key)


def some_ways() -> list[tuple[str, Path]]:
    """Through some dialogues that are drawn, and through every kind of answer in any."""
    some_issue = issue_of("dropped")
    drawn = random.sample(shortest_of_each(SCRIPTS, some_issue), DRAWN)
    return [*drawn, *every_kind_of_answer(SCRIPTS, some_issue)]


def every_way_through_each() -> list[tuple[str, Path]]:
    return [
        (kind, path)
        for kind, script in sorted(SCRIPTS.items())
        for path in every_branch(script, issue_of(kind))
    ]


async def walk(stage: Stage, paths: Sequence[tuple[str, Path]], answer: Answer) -> None:
    page = await stage.open_page()
    # Time passes as soon as the test says so.
    await page.clock.install()
    for kind, path in paths:
        try:
            await walk_one(stage, page, kind, path, answer)
        except AssertionError as error:
            error.add_note(f"in the dialogue '{kind}', on the way {path}")
            raise


async def walk_one(stage: Stage, page: Page, kind: str, path: Path, answer: Answer) -> None:
    conversation = Conversation(SCRIPTS[kind], issue_of(kind), Outlook())
    dialogue = await stage.runs.open(stage.run, kind)
    turns = conversation.open()
    for call in path:
        await expect_shown(page, turns)
        await make(stage, page, dialogue, call, answer)
        turns = converse(conversation, call)
    await expect_shown(page, turns)
    await stage.runs.finish_leaf(dialogue)
    await expect(page.get_by_text("No robot asks anything")).to_be_visible()


def issue_of(kind: str) -> Issue:
    """What `PlayedDialogues` opens a dialogue about."""
    return Issue(
        kind,
        "pr2",
        "/0",
        "yellow_bar",
        "yellow_bar",
        "yellow_bar_place",
        5,
        reason=DETECTION.explanation,
    )


async def make(stage: Stage, page: Page, dialogue: UUID, call: str, answer: Answer) -> None:
    if call in ("seen:moved", "not_seen"):
        await stage.runs.see(dialogue, fulfilled=call == "seen:moved")
        return
    prompt = stage.runs.dialogue_now(dialogue).prompt
    assert prompt is not None
    final = next(each.final for each in prompt.answers if each.value == call)
    await page.clock.fast_forward(ARMED_AFTER_MS)
    await answer(page, call)
    held = page.get_by_role("button", name="Undo")
    if final:
        await expect(held).to_be_visible()
        await page.clock.fast_forward(HELD_MS)
    await expect(held).to_be_hidden()


async def expect_shown(page: Page, turns: list[Turn]) -> None:
    """The page shows what the robot says, and whether it asks, waits or is through."""
    for turn in turns:
        match turn:
            case Ask(text=text, no_effect=no, ways=ways, headline=headline):
                await expect(page.get_by_role("heading", name=text)).to_be_visible()
                await expect(page.locator(".question-text")).to_have_text(headline)
                await expect(page.locator(".spoken-question")).to_contain_text(no)
                labels = [each.label for each in ways]
                await expect(page.locator(".way-effects dt")).to_have_text(
                    [*labels, "Without an answer"]
                )
                for each in ways:
                    effect = page.locator(".way-effects dd").filter(has_text=each.effect)
                    await expect(effect.first).to_be_visible()
            case Remark(text=text):
                await expect(page.get_by_text(text).first).to_be_visible()
            case AwaitHelp():
                await expect(page.get_by_text("It goes on by itself as soon as")).to_be_visible()
            case Close():
                await expect(page.locator(".answer")).to_have_count(0)
