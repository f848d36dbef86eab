"""The recognizer around a decoder that is told what it hears."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("pocketsphinx", reason="pocketsphinx is not installed")

from mend.server.speech.commands import Command
from mend.server.speech.decoding import Hypothesis
from mend.server.speech.endpointing import SAMPLE_RATE_HZ
from mend.server.speech.recognizer import (
    FRAME_BYTES,
    LEAD_S,
    Heard,
    Recognizer,
    SpeechBegan,
    Utterance,
)
from mend.server.speech.vocabulary import phrase_commands


class ToldDecoder:
    """Implements `server.speech.decoding.Decoder`: hears `phrase`, so sure as it is told to be."""

    def __init__(self, phrase: str, margin: float = 0.1) -> None:
        self._phrase = phrase
        self._margin = margin
        self._taken: list[bytes] = []
        self.sound = b""

    def begin(self) -> None:
        self._taken = []

    def take(self, sound: bytes) -> None:
        self._taken.append(sound)

    def end(self) -> Hypothesis:
        self.sound = b"".join(self._taken)
        command = phrase_commands()[self._phrase]
        return Hypothesis(self._phrase, command, self._phrase, self._margin)


def noise(duration_s: float, level: float) -> bytes:
    samples = np.random.default_rng(0).normal(0, level, round(duration_s * SAMPLE_RATE_HZ))
    return samples.astype(np.int16).tobytes()


def silence(duration_s: float) -> bytes:
    return bytes(round(duration_s * SAMPLE_RATE_HZ) * 2)


def word(duration_s: float = 0.5) -> bytes:
    return silence(1.0) + noise(duration_s, 3000) + silence(0.5)


def heard(recognizer: Recognizer, sound: bytes, piece: int = FRAME_BYTES) -> list[Heard]:
    return [
        each
        for start in range(0, len(sound), piece)
        for each in recognizer.feed(sound[start : start + piece])
    ]


def test_an_utterance_is_told_when_it_begins_and_when_it_has_ended() -> None:
    began, utterance = heard(Recognizer(ToldDecoder("yes please")), word())
    assert began == SpeechBegan()
    assert isinstance(utterance, Utterance)
    assert (utterance.command, utterance.phrase) == (Command.YES, "yes please")
    assert utterance.hangover_s == pytest.approx(0.3, abs=0.05)


@pytest.mark.parametrize("piece", [2, 320, 1000, 10**6])
def test_sound_may_come_in_pieces_of_any_size(piece: int) -> None:
    assert heard(Recognizer(ToldDecoder("no")), word(), piece) == heard(
        Recognizer(ToldDecoder("no")), word()
    )


def test_the_weak_beginning_of_a_word_is_decoded_too() -> None:
    decoder = ToldDecoder("yes")
    heard(Recognizer(decoder), word())
    before_and_after_s = len(decoder.sound) / 2 / SAMPLE_RATE_HZ - 0.5
    assert before_and_after_s > LEAD_S / 2 + 0.1


def test_what_is_longer_than_any_phrase_is_no_command() -> None:
    decoder = ToldDecoder("yes")
    chopped = b"".join(noise(0.2, 3000) + noise(0.1, 30) for _ in range(30))
    found = heard(Recognizer(decoder), silence(1.0) + chopped)
    assert found[1] == Utterance(None, None, words=True, hangover_s=0.0)
    assert decoder.sound == b""


def test_a_pause_within_an_utterance_does_not_cut_it_in_two() -> None:
    decoder = ToldDecoder("no thanks")
    sound = silence(1.0) + noise(0.4, 3000) + silence(0.22) + noise(0.4, 3000) + silence(0.5)
    assert [type(each) for each in heard(Recognizer(decoder), sound)] == [SpeechBegan, Utterance]
    assert len(decoder.sound) / 2 / SAMPLE_RATE_HZ > 0.4 + 0.22 + 0.4


def test_an_interrupted_utterance_is_never_told() -> None:
    decoder = ToldDecoder("yes")
    recognizer = Recognizer(decoder)
    assert heard(recognizer, silence(1.0) + noise(0.3, 3000)) == [SpeechBegan()]
    recognizer.interrupt()
    assert heard(recognizer, silence(1.0)) == []
    assert decoder.sound == b""


def heard_round_gap(at_s: float) -> Utterance:
    """What becomes of a word of half a second, a second from the start, if some is missing."""
    decoder = ToldDecoder("yes")
    recognizer = Recognizer(decoder)
    sound = word()
    cut = round(at_s * SAMPLE_RATE_HZ) * 2
    before = heard(recognizer, sound[:cut])
    recognizer.skip()
    utterance = [*before, *heard(recognizer, sound[cut:])][-1]
    assert isinstance(utterance, Utterance)
    return utterance


@given(at_s=st.floats(0.9, 1.7))
def test_what_has_a_gap_is_no_command(at_s: float) -> None:
    utterance = heard_round_gap(at_s)
    assert (utterance.command, utterance.phrase, utterance.words) == (None, None, True)
    assert utterance.hangover_s == pytest.approx(0.3, abs=0.05)


@given(at_s=st.floats(0.0, 1.0 - LEAD_S - 0.1))
def test_a_gap_in_the_silence_before_does_no_harm(at_s: float) -> None:
    assert heard_round_gap(at_s).command is Command.YES


def test_what_begins_with_a_gap_is_no_command_even_where_nothing_came_before() -> None:
    recognizer = Recognizer(ToldDecoder("yes"))
    heard(recognizer, silence(1.0))
    recognizer.interrupt()
    recognizer.skip()
    utterance = heard(recognizer, noise(0.5, 3000) + silence(0.5))[-1]
    assert isinstance(utterance, Utterance)
    assert utterance.command is None


def test_what_is_said_after_what_had_a_gap_is_understood() -> None:
    recognizer = Recognizer(ToldDecoder("yes"))
    heard(recognizer, silence(1.0) + noise(0.2, 3000))
    recognizer.skip()
    said = heard(recognizer, noise(0.3, 3000) + silence(0.5) + word())
    commands = [each.command for each in said if isinstance(each, Utterance)]
    assert commands == [None, Command.YES]


def test_digital_silence_gets_a_little_noise() -> None:
    decoder = ToldDecoder("yes")
    heard(Recognizer(decoder), word())
    samples = np.frombuffer(decoder.sound, np.int16)
    assert np.count_nonzero(samples) > 0.9 * len(samples)


def test_what_something_else_explains_almost_as_well_is_not_understood() -> None:
    _, utterance = heard(Recognizer(ToldDecoder("yes", margin=0.001)), word())
    assert isinstance(utterance, Utterance)
    assert (utterance.command, utterance.phrase, utterance.words) == (None, None, True)


def test_the_decoder_has_the_sound_while_somebody_still_speaks() -> None:
    decoder = ToldDecoder("yes")
    assert heard(Recognizer(decoder), silence(1.0) + noise(0.5, 3000)) == [SpeechBegan()]
    assert sum(len(each) for each in decoder._taken) > 0.5 * SAMPLE_RATE_HZ * 2
