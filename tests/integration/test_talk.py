"""A spoken helper against a service: it hears, is heard, and its answer goes the usual way."""

import asyncio
import shutil
from collections.abc import AsyncIterator

import pytest
from scripted_ears import ScriptedEars, ToneVoice
from service_under_test import ServiceUnderTest, serving
from wav_device import WavDevice, pcm_of

from mend.server.cli.spoken_helper import SpokenHelper
from mend.server.client import MendClient
from mend.server.journal.events import Answered, DialogueClosed, RunPaused
from mend.server.runtime.requests import RunRequest
from mend.server.speech.abilities import SpeechAbilities
from mend.server.speech.commands import Command
from mend.server.speech.ear import NoEars, ProcessEars, TooManyConversationsError, choose_ears
from mend.server.speech.rendering import SpokenTexts
from mend.server.speech.voice import CommandVoice, choose_voice

REQUEST = RunRequest(tree="eket", world="tabletop", speed="max")


@pytest.fixture
def voice() -> CommandVoice:
    """A person: flite's voice."""
    if shutil.which("flite") is None:
        pytest.skip("flite is not installed, and nobody else can speak here")
    person = choose_voice("flite", flite_voice="slt", piper_model=None)
    assert isinstance(person, CommandVoice)
    return person


@pytest.fixture
async def service() -> AsyncIterator[ServiceUnderTest]:
    ears = choose_ears(True, 2)
    if isinstance(ears, NoEars):
        pytest.skip(ears.why_not)
    speech = SpeechAbilities(SpokenTexts(ToneVoice()), ears)
    async with serving(speech) as service:
        yield service
    await speech.close()


async def help_by_voice(service: ServiceUnderTest, device: WavDevice, wanted: type) -> object:
    """Ask a question, have a helper say something to it, and return the event that follows."""
    run = await service.runs.start_run(REQUEST)
    async with MendClient(service.url) as client, asyncio.timeout(60):
        helping = asyncio.create_task(SpokenHelper(client, "anna", device, device.tell).run())
        await service.runs.raise_issue(run.id)
        async with client.follow("watcher", after=0) as events:
            async for event in events:
                if isinstance(event, wanted):
                    break
        helping.cancel()
        await asyncio.gather(helping, return_exceptions=True)
    return event


@pytest.mark.slow
@pytest.mark.parametrize(("says", "answer"), [("yes i will", "yes"), ("no thank you", "no")])
async def test_a_spoken_answer_is_an_answer(
    service: ServiceUnderTest, voice: CommandVoice, says: str, answer: str
) -> None:
    device = WavDevice(await voice.render(says))
    event = await help_by_voice(service, device, Answered)
    assert isinstance(event, Answered)
    assert (event.answer, event.helper) == (answer, "anna")
    assert "I dropped the pink bar. Shall I pick it up again?" in device.told
    assert f'You: "{says}"' in device.told
    assert device.played[0].startswith(b"RIFF")


@pytest.mark.slow
async def test_a_spoken_stop_pauses_the_run(service: ServiceUnderTest, voice: CommandVoice) -> None:
    device = WavDevice(await voice.render("stop the robot"))
    event = await help_by_voice(service, device, RunPaused)
    assert isinstance(event, RunPaused)


async def test_a_service_without_speech_is_read_instead() -> None:
    device, told = WavDevice(await ToneVoice().render("-")), asyncio.Event()

    def tell(line: str) -> None:
        device.tell(line)
        told.set()

    async with serving() as service, MendClient(service.url) as client, asyncio.timeout(60):
        helping = asyncio.create_task(SpokenHelper(client, "anna", device, tell).run())
        run = await service.runs.start_run(REQUEST)
        view = await service.runs.raise_issue(run.id)
        assert view.prompt is not None
        await client.answer(view.dialogue, view.prompt.prompt, "yes", "ben")
        async with client.follow("watcher", after=0) as events:
            async for event in events:
                if isinstance(event, DialogueClosed):
                    break
        await told.wait()
        helping.cancel()
        await asyncio.gather(helping, return_exceptions=True)
    assert device.told[0].startswith("The service has no voice")
    assert device.told[1].startswith("The service hears nothing")


class SlowToCloseDevice(WavDevice):
    """A microphone that takes long to be let go of."""

    def __init__(self, says: bytes) -> None:
        super().__init__(says)
        self.listened, self.closing = asyncio.Event(), asyncio.Event()
        self.may_close = asyncio.Event()

    def tell(self, line: str) -> None:
        super().tell(line)
        if line == "(listening)":
            self.listened.set()

    async def microphone(self) -> AsyncIterator[bytes]:
        try:
            async for frame in super().microphone():
                yield frame
        finally:
            self.closing.set()
            await self.may_close.wait()


async def test_a_helper_is_stopped_also_while_a_conversation_ends() -> None:
    device = SlowToCloseDevice(await ToneVoice().render("-"))
    speech = SpeechAbilities(SpokenTexts(ToneVoice()), ScriptedEars())
    async with serving(speech) as service, MendClient(service.url) as client, asyncio.timeout(60):
        helping = asyncio.create_task(SpokenHelper(client, "anna", device, device.tell).run())
        run = await service.runs.start_run(REQUEST)
        view = await service.runs.raise_issue(run.id)
        assert view.prompt is not None
        await device.listened.wait()
        await client.answer(view.dialogue, view.prompt.prompt, "yes", "ben")
        await device.closing.wait()
        helping.cancel()
        await asyncio.sleep(0)
        device.may_close.set()
        await asyncio.gather(helping, return_exceptions=True)
        assert helping.cancelled()


@pytest.mark.slow
async def test_there_is_room_for_so_many_ears_and_no_more() -> None:
    if isinstance(choose_ears(True, 1), NoEars):
        pytest.skip("pocketsphinx is not installed")
    ears = ProcessEars(1)
    ear = await ears.open()
    with pytest.raises(TooManyConversationsError, match="1 spoken conversations are going on"):
        await ears.open()
    await ear.close()
    ears.check_room()
    await ears.close()


@pytest.mark.slow
async def test_an_ear_knows_nothing_of_the_conversation_before(voice: CommandVoice) -> None:
    if isinstance(choose_ears(True, 1), NoEars):
        pytest.skip("pocketsphinx is not installed")
    ears = ProcessEars(1)
    said = bytes(16_000) + pcm_of(await voice.render("yes i will"))
    first = await ears.open()
    first.hear(said)
    first.interrupt()
    await first.close()
    second = await ears.open()
    second.hear(said + bytes(32_000))
    async with asyncio.timeout(60):
        reports = [await second.report() for _ in range(2)]
    await second.close()
    await ears.close()
    assert [each.kind for each in reports] == ["began", "utterance"]
    assert [each.interruptions for each in reports] == [0, 0]
    assert reports[-1].command is Command.YES


@pytest.mark.slow
async def test_an_ear_understands_nothing_round_a_gap_and_what_comes_after_it(
    voice: CommandVoice,
) -> None:
    if isinstance(choose_ears(True, 1), NoEars):
        pytest.skip("pocketsphinx is not installed")
    ears = ProcessEars(1)
    said = bytes(32_000) + pcm_of(await voice.render("yes i will")) + bytes(32_000)
    middle = len(said) // 4 * 2
    ear = await ears.open()
    ear.hear(said[:middle])
    ear.skip()
    ear.hear(said[middle:])
    ear.interrupt()
    ear.hear(said)
    async with asyncio.timeout(60):
        reports = [await ear.report() for _ in range(4)]
    await ear.close()
    await ears.close()
    assert [each.command for each in reports] == [None, None, None, Command.YES]
    assert [each.words for each in reports] == [False, True, False, True]
    assert [each.interruptions for each in reports] == [0, 0, 1, 1]
