"""PocketSphinx itself, on a real voice and on none."""

import asyncio
import shutil

import pytest

pytest.importorskip("pocketsphinx", reason="pocketsphinx is not installed")

from wav_device import pcm_of

from mend.server.speech.commands import Command
from mend.server.speech.decoding import Hypothesis
from mend.server.speech.recognizer import FRAME_BYTES, Recognizer, Utterance
from mend.server.speech.sphinx_decoder import FAR_AHEAD, SphinxDecoder
from mend.server.speech.voice import CommandVoice, choose_voice

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def decoder() -> SphinxDecoder:
    return SphinxDecoder()


def said(text: str) -> bytes:
    """A sentence by flite, in a quiet room."""
    if shutil.which("flite") is None:
        pytest.skip("flite is not installed, and nobody else can speak here")
    person = choose_voice("flite", flite_voice="slt", piper_model=None)
    assert isinstance(person, CommandVoice)
    return bytes(32_000) + pcm_of(asyncio.run(person.render(text))) + bytes(16_000)


def understood(decoder: SphinxDecoder, text: str) -> list[Command | None]:
    recognizer = Recognizer(decoder)
    return [each.command for each in recognizer.feed(said(text)) if isinstance(each, Utterance)]


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("yes please", Command.YES),
        ("no thank you", Command.NO),
        ("the meeting is on the third floor", None),
    ],
)
def test_a_sentence_is_one_command_or_none(
    decoder: SphinxDecoder, text: str, meant: Command | None
) -> None:
    assert understood(decoder, text) == [meant]


def test_an_utterance_that_is_not_ended_leaves_no_trace(decoder: SphinxDecoder) -> None:
    sound = said("yes please")
    decoder.begin()
    decoder.take(sound)
    assert understood(decoder, "no thank you") == [Command.NO]


def test_the_same_sound_is_heard_the_same_again(decoder: SphinxDecoder) -> None:
    sound = said("yes please")
    heard: list[Hypothesis] = []
    for _ in range(2):
        decoder.begin()
        for start in range(0, len(sound), FRAME_BYTES):
            decoder.take(sound[start : start + FRAME_BYTES])
        heard.append(decoder.end())
    assert heard[0] == heard[1]
    assert heard[0].margin > 0


def test_a_command_is_ahead_of_what_it_is_taken_for_least(decoder: SphinxDecoder) -> None:
    decoder.begin()
    decoder.take(said("yes please"))
    heard = decoder.end()
    assert decoder.margin_of(Command.YES) == heard.margin
    for other in (Command.NO, Command.STOP):
        assert -FAR_AHEAD <= decoder.margin_of(other) < 0
    decoder.begin()
    decoder.end()
    assert decoder.margin_of(Command.YES) == -FAR_AHEAD, "nothing was said since"


def test_no_sound_has_no_words(decoder: SphinxDecoder) -> None:
    decoder.begin()
    assert decoder.end() == Hypothesis("")
