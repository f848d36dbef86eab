"""Answers by voice, and what else can be said, in a real browser.

That dialogues are walked is for `test_question_dialogues.py`, by buttons.
"""

import asyncio
import shutil
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager
from importlib.util import find_spec
from typing import NamedTuple
from uuid import UUID

import pytest
import pytest_asyncio
from console_in_browser import TOKEN
from dialogue_paths import Path, every_branch, every_kind_of_answer
from fake_microphone import Person, launch_speaking
from played_dialogues import PlayedDialogues
from playwright.async_api import async_playwright, expect
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

AT_ONCE = sample(1, 2)
"""So many walk at once: most of the time is taken by words."""

HOLD_MS = 3_100


class Played(NamedTuple):
    """A run of a service on which a test plays the robot."""

    runs: PlayedDialogues
    run: UUID


@pytest_asyncio.fixture(scope="module", loop_scope="session")
async def persons(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[list[Person]]:
    async with async_playwright() as playwright:
        persons = [
            await launch_speaking(
                playwright, WORDS["yes"], tmp_path_factory.mktemp("microphone"), again=False
            )
            for _ in range(AT_ONCE)
        ]
        yield persons
        for person in persons:
            await person.browser.close()


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
async def test_questions_are_answered_by_voice(
    persons: list[Person], speech: SpeechAbilities
) -> None:
    every_kind = every_kind_of_answer(SCRIPTS, issue_of("dropped"))
    through = every_branch(SCRIPTS["dropped"], issue_of("dropped"))
    both = min((path for path in through if {"yes", "no"} <= set(path)), key=len)
    paths = iter(sample([("dropped", both)], every_kind))
    async with asyncio.TaskGroup() as walks:
        for person in persons:
            walks.create_task(walk(paths, person, speech))


async def walk(paths: Iterator[tuple[str, Path]], person: Person, speech: SpeechAbilities) -> None:
    """Walk such paths as nobody else has walked yet."""
    async with at_work(speech, person) as (stage, console):
        for kind, path in paths:
            conversation = Conversation(SCRIPTS[kind], issue_of(kind), Outlook())
            dialogue = await stage.runs.open(stage.run, kind)
            turns = conversation.open()
            for call in path:
                await expect_shown(console.page, turns)
                await take(stage, console, dialogue, call)
                turns = converse(conversation, call)
            await expect_shown(console.page, turns)
            await stage.runs.finish_leaf(dialogue)
            await expect(console.page.get_by_text("No robot asks anything")).to_be_visible()


async def take(stage: Played, console: SpokenConsole, dialogue: UUID, call: str) -> None:
    if call in ("seen:moved", "not_seen"):
        await stage.runs.see(dialogue, fulfilled=call == "seen:moved")
        return
    await console.speak(WORDS[call], call)
    # A final answer is held back for a moment, which otherwise would pass by itself.
    await console.page.clock.fast_forward(HOLD_MS)


async def test_a_question_is_said_again_on_request(
    persons: list[Person], speech: SpeechAbilities
) -> None:
    async with at_work(speech, persons[0]) as (stage, console):
        dialogue = await stage.runs.open(stage.run, "dropped")
        await console.speak("say that again", "repeat")
        said = await console.message("say")
        prompt = stage.runs.dialogue_now(dialogue).prompt
        assert prompt is not None
        assert (said["what"], said["text"]) == ("question", prompt.text)
        await console.message("listening")
        await expect(console.page.get_by_text("Speak now: yes or no")).to_be_visible()
        assert stage.runs.dialogue_now(dialogue).awaiting == "answer"


async def test_help_says_what_each_answer_will_do(
    persons: list[Person], speech: SpeechAbilities
) -> None:
    async with at_work(speech, persons[0]) as (stage, console):
        dialogue = await stage.runs.open(stage.run, "dropped")
        async with console.page.expect_request("**/speech/help"):
            await console.speak("what can i say", "help")
        said = await console.message("say")
        prompt = stage.runs.dialogue_now(dialogue).prompt
        assert prompt is not None
        assert said["what"] == "help"
        assert all(each.effect in said["text"] for each in prompt.answers)
        await console.message("listening")
        assert stage.runs.dialogue_now(dialogue).awaiting == "answer"


async def test_stop_pauses_the_run_and_answers_nothing(
    persons: list[Person], speech: SpeechAbilities
) -> None:
    async with at_work(speech, persons[0]) as (stage, console):
        dialogue = await stage.runs.open(stage.run, "dropped")
        await console.speak("stop the robot", "stop")
        await expect(console.page.get_by_text("the run is paused").first).to_be_visible()
        assert stage.runs.run_now(stage.run).status is RunStatus.PAUSED
        assert stage.runs.dialogue_now(dialogue).awaiting == "answer"


@asynccontextmanager
async def at_work(
    speech: SpeechAbilities, person: Person
) -> AsyncIterator[tuple[Played, SpokenConsole]]:
    """A service on which a test plays the robot, and somebody's console at it."""
    async with serving(speech, runs_in=PlayedDialogues, token=TOKEN) as service:
        context = await person.browser.new_context(base_url=service.url)
        await context.request.post("/api/session", data={"token": TOKEN})
        await context.add_init_script("localStorage.setItem('mend.helper', '\"anna\"')")
        console = SpokenConsole(await context.new_page(), person)
        # Answers that are held back for a moment are sent as soon as the test says so.
        await console.page.clock.install()
        await console.page.goto("/")
        await console.page.get_by_role("status").filter(has_text="Connected").wait_for()
        assert isinstance(service.runs, PlayedDialogues)
        run = await service.runs.start_run(RunRequest(tree="eket", world="tabletop"))
        yield Played(service.runs, run.id), console
        await context.close()
