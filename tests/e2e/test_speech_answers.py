"""Answering by voice: a real browser whose microphone is a sound file."""

import shutil
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import AsyncExitStack
from importlib.util import find_spec
from pathlib import Path
from uuid import UUID

import pytest
import pytest_asyncio
from console_in_browser import TOKEN
from fake_microphone import launch_speaking
from played_dialogues import PlayedDialogues
from playwright.async_api import Page, async_playwright, expect
from scripted_ears import MishearingEars
from service_under_test import serving

from mend.server.runtime.requests import RunRequest
from mend.server.speech.abilities import NO_SPEECH, SpeechAbilities
from mend.server.speech.ear import choose_ears
from mend.server.speech.rendering import SpokenTexts
from mend.server.speech.voice import NoVoice, choose_voice

pytestmark = [
    pytest.mark.asyncio(loop_scope="session"),
    pytest.mark.skipif(shutil.which("flite") is None, reason="flite is not installed"),
    pytest.mark.skipif(find_spec("pocketsphinx") is None, reason="pocketsphinx is not installed"),
]

Spoken = Callable[..., Awaitable[tuple[PlayedDialogues, UUID, Page]]]


@pytest_asyncio.fixture(loop_scope="session")
async def spoken(tmp_path: Path) -> AsyncIterator[Spoken]:
    """Opens a console whose helper says the same words again and again."""
    async with AsyncExitStack() as stack:

        async def open_spoken(
            words: str, speech: SpeechAbilities | None = None
        ) -> tuple[PlayedDialogues, UUID, Page]:
            if speech is None:
                voice = choose_voice("flite", flite_voice="slt", piper_model=None)
                assert not isinstance(voice, NoVoice)
                speech = SpeechAbilities(SpokenTexts(voice), choose_ears(wanted=True, at_once=2))
                stack.push_async_callback(speech.close)
            service = await stack.enter_async_context(
                serving(speech, runs_in=PlayedDialogues, token=TOKEN)
            )
            playwright = await stack.enter_async_context(async_playwright())
            browser = (await launch_speaking(playwright, words, tmp_path, again=True)).browser
            stack.push_async_callback(browser.close)
            context = await browser.new_context(base_url=service.url)
            await context.request.post("/api/session", data={"token": TOKEN})
            await context.add_init_script("localStorage.setItem('mend.helper', '\"anna\"')")
            page = await context.new_page()
            await page.goto("/")
            await page.get_by_role("status").filter(has_text="Connected").wait_for()
            runs = service.runs
            assert isinstance(runs, PlayedDialogues)
            run = await runs.start_run(RunRequest(tree="eket", world="tabletop"))
            dialogue = await runs.open(run.id, "dropped")
            await page.locator(".fault-picture .overlay").wait_for()
            await page.get_by_role("button", name="Listen and speak").click()
            return runs, dialogue, page

        yield open_spoken


async def test_no_answers_every_question_until_the_dialogue_closes(spoken: Spoken) -> None:
    runs, dialogue, page = await spoken("no")
    # The second no is final: it is held back like that of a button, and then sent.
    await expect(page.get_by_role("button", name="Undo")).to_be_visible(timeout=60_000)
    await expect(page.get_by_text("No robot asks anything")).to_be_visible(timeout=60_000)
    assert runs.dialogue_now(dialogue).reason == "resolved"
    assert runs.dialogue_now(dialogue).answered_by == "anna"


async def test_what_is_not_understood_ends_at_the_buttons(spoken: Spoken) -> None:
    runs, dialogue, page = await spoken(
        "something else", SpeechAbilities(NoVoice("no voice here"), MishearingEars())
    )
    await expect(page.get_by_text("Not understood. Please use the buttons.")).to_be_visible(
        timeout=60_000
    )
    assert runs.dialogue_now(dialogue).awaiting == "answer"
    await page.locator(".answer.yes").click()
    await expect(page.get_by_text("The robot watches for")).to_be_visible()


async def test_console_says_what_it_cannot_hear_or_say(spoken: Spoken) -> None:
    _, _, page = await spoken("yes", NO_SPEECH)
    await expect(page.get_by_text("please use the buttons")).to_be_visible()
    await expect(page.get_by_text("questions are shown")).to_be_visible()
    await page.locator(".answer.yes").click()
    await expect(page.get_by_text("The robot watches for")).to_be_visible()
