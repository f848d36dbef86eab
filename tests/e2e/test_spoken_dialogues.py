"""Answers by voice, and what else can be said, in a real browser.

That every dialogue is walked is for `test_question_dialogues.py`, by buttons.
"""

import asyncio
import shutil
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator
from contextlib import AsyncExitStack, asynccontextmanager
from importlib.util import find_spec
from uuid import UUID

import pytest
import pytest_asyncio
from console_in_browser import TOKEN, Stage
from dialogue_paths import Path, every_kind_of_answer
from fake_microphone import launch_speaking
from played_dialogues import PlayedDialogues
from playwright.async_api import Browser, async_playwright, expect
from sampled import sample
from scripted_ears import ToneVoice
from service_under_test import serving
from spoken_console import SpokenConsole
from test_question_dialogues import SCRIPTS, expect_shown, issue_of

from mend.dialogue.conversation import Conversation
from mend.dialogue.outlook import Outlook
from mend.server.runtime.dialogue_state import converse
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.run_state import RunStatus
from mend.server.speech.abilities import SpeechAbilities
from mend.server.speech.ear import ProcessEars
from mend.server.speech.rendering import SpokenTexts

pytestmark = [
    pytest.mark.asyncio(loop_scope="session"),
    pytest.mark.skipif(shutil.which("flite") is None, reason="flite is not installed"),
    pytest.mark.skipif(find_spec("pocketsphinx") is None, reason="pocketsphinx is not installed"),
]

WORDS = {"yes": "yes i will", "no": "no thank you"}

AT_ONCE = 2

HOLD_MS = 3_100

Persons = Callable[[str], Awaitable[Browser]]
"""`await persons(words)`: a browser into whose microphone these words are said."""


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def persons(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[Persons]:
    folder = tmp_path_factory.mktemp("microphones")
    browsers: dict[str, Browser] = {}
    async with async_playwright() as playwright:

        async def persons(words: str) -> Browser:
            if words not in browsers:
                browsers[words] = await launch_speaking(playwright, words, folder, again=False)
            return browsers[words]

        yield persons
        for browser in browsers.values():
            await browser.close()


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def speech() -> AsyncIterator[SpeechAbilities]:
    """A robot with ears, and a voice that takes no time."""
    # A conversation may still be closing when the next one begins.
    ears = ProcessEars(4 * AT_ONCE)
    speech = SpeechAbilities(SpokenTexts(ToneVoice()), ears)
    # Their processes are kept, and then ready at once.
    for ear in [await ears.open() for _ in range(AT_ONCE)]:
        await ear.close()
    yield speech
    await speech.close()


@pytest.mark.slow(15)
async def test_questions_are_answered_by_voice(persons: Persons, speech: SpeechAbilities) -> None:
    every_kind = every_kind_of_answer(SCRIPTS, issue_of("dropped"))
    # The longest has yes and no, final and not, to an opening and after a look.
    chosen = sample([max(every_kind, key=lambda each: len(each[1]))], every_kind)
    paths = iter(chosen)
    # Two at once: most of the time is taken by words.
    async with asyncio.TaskGroup() as walks:
        for _ in chosen[:AT_ONCE]:
            walks.create_task(walk(paths, persons, speech))


async def walk(
    paths: Iterator[tuple[str, Path]], persons: Persons, speech: SpeechAbilities
) -> None:
    """Walk such paths as nobody else has walked yet."""
    async with at_work(speech) as (stage, open_console):
        consoles = {answer: await open_console(persons, words) for answer, words in WORDS.items()}
        for kind, path in paths:
            conversation = Conversation(SCRIPTS[kind], issue_of(kind), Outlook())
            dialogue = await stage.runs.open(stage.run, kind)
            turns = conversation.open()
            for call in path:
                # What the robot sees is called without an answer, whoever's console it is.
                console = consoles.get(call, consoles["yes"])
                await expect_shown(console.page, turns)
                await take(stage, console, dialogue, call)
                turns = converse(conversation, call)
            await expect_shown(consoles["yes"].page, turns)
            await stage.runs.finish_leaf(dialogue)
            await expect(consoles["yes"].page.get_by_text("No robot asks anything")).to_be_visible()


async def take(stage: Stage, console: SpokenConsole, dialogue: UUID, call: str) -> None:
    if call in ("seen:moved", "not_seen"):
        await stage.runs.see(dialogue, fulfilled=call == "seen:moved")
        return
    await console.speak(call)
    # A final answer is held back for a moment, which otherwise would pass by itself.
    await console.page.clock.fast_forward(HOLD_MS)


async def test_a_question_is_said_again_on_request(
    persons: Persons, speech: SpeechAbilities
) -> None:
    async with at_work(speech) as (stage, open_console):
        console = await open_console(persons, "say that again")
        dialogue = await stage.runs.open(stage.run, "dropped")
        await console.speak("repeat")
        said = await console.message("say")
        prompt = stage.runs.dialogue_now(dialogue).prompt
        assert prompt is not None
        assert (said["what"], said["text"]) == ("question", prompt.text)
        await console.message("listening")
        await expect(console.page.get_by_text("Speak now: yes or no")).to_be_visible()
        assert stage.runs.dialogue_now(dialogue).awaiting == "answer"


async def test_help_says_what_each_answer_will_do(
    persons: Persons, speech: SpeechAbilities
) -> None:
    async with at_work(speech) as (stage, open_console):
        console = await open_console(persons, "what can i say")
        dialogue = await stage.runs.open(stage.run, "dropped")
        async with console.page.expect_request("**/speech/help"):
            await console.speak("help")
        said = await console.message("say")
        prompt = stage.runs.dialogue_now(dialogue).prompt
        assert prompt is not None
        assert said["what"] == "help"
        assert all(each.effect in said["text"] for each in prompt.answers)
        await console.message("listening")
        assert stage.runs.dialogue_now(dialogue).awaiting == "answer"


async def test_stop_pauses_the_run_and_answers_nothing(
    persons: Persons, speech: SpeechAbilities
) -> None:
    async with at_work(speech) as (stage, open_console):
        console = await open_console(persons, "stop the robot")
        dialogue = await stage.runs.open(stage.run, "dropped")
        await console.speak("stop")
        await expect(console.page.get_by_text("the run is paused").first).to_be_visible()
        assert stage.runs.run_now(stage.run).status is RunStatus.PAUSED
        assert stage.runs.dialogue_now(dialogue).awaiting == "answer"


OpenConsole = Callable[[Persons, str], Awaitable[SpokenConsole]]


@asynccontextmanager
async def at_work(speech: SpeechAbilities) -> AsyncIterator[tuple[Stage, OpenConsole]]:
    """A service on which a test plays the robot, and how consoles are opened at it."""
    async with AsyncExitStack() as stack:
        service = await stack.enter_async_context(
            serving(speech, runs_in=PlayedDialogues, token=TOKEN)
        )

        async def open_page(persons: Persons, words: str) -> SpokenConsole:
            browser = await persons(words)
            context = await browser.new_context(base_url=service.url)
            stack.push_async_callback(context.close)
            await context.request.post("/api/session", data={"token": TOKEN})
            await context.add_init_script("localStorage.setItem('mend.helper', '\"anna\"')")
            console = SpokenConsole(await context.new_page())
            # Answers that are held back for a moment are sent as soon as the test says so.
            await console.page.clock.install()
            await console.page.goto("/")
            await console.page.get_by_role("status").filter(has_text="Connected").wait_for()
            return console

        assert isinstance(service.runs, PlayedDialogues)
        run = await service.runs.start_run(RunRequest(tree="eket", world="tabletop"))
        yield Stage(service.runs, run.id, open_page), open_page
