"""What two recognizers make of one utterance."""

import math

import pytest
from writing_transcriber import Writing

from mend.server.speech.agreeing_decoder import ALONE_MARGIN, AgreeingDecoder
from mend.server.speech.commands import Command
from mend.server.speech.decoding import Hypothesis


class Listening:
    """Implements `Decoder`: hears what it is told, and keeps the sound."""

    def __init__(self, hypothesis: Hypothesis) -> None:
        self._hypothesis = hypothesis
        self.sound = b""

    def begin(self) -> None:
        self.sound = b""

    def take(self, sound: bytes) -> None:
        self.sound += sound

    def end(self) -> Hypothesis:
        return self._hypothesis


YES = Hypothesis("c_yes", Command.YES, "yes", 0.025)
OTHER = Hypothesis("the chess")


def both(heard: Hypothesis, text: str) -> Hypothesis:
    decoder = AgreeingDecoder(Listening(heard), Writing(text))
    decoder.begin()
    return decoder.end()


def test_what_both_hear_is_sure_however_little_ahead_it_is() -> None:
    assert both(YES, "Yes.") == Hypothesis("Yes.", Command.YES, "yes", math.inf)


def test_what_is_heard_as_two_commands_is_none() -> None:
    assert both(YES, "No.").command is None
    assert both(YES, "No.").words, "it was said again, and is asked about again"


def test_a_command_that_the_text_does_not_have_needs_to_be_surer() -> None:
    found = both(YES, "Chess.")
    assert found.command is Command.YES
    assert found.margin == pytest.approx(YES.margin - ALONE_MARGIN)


def test_a_written_command_counts_alone_if_it_is_no_single_short_word() -> None:
    assert both(OTHER, "Yes, please.").command is Command.YES
    assert both(OTHER, "Yes.").command is None


def test_what_is_no_command_for_either_is_none() -> None:
    assert both(OTHER, "The meeting is on the third floor.").command is None
    assert both(Hypothesis(""), "").words == ""


def test_both_hear_the_same_sound_and_nothing_of_an_utterance_that_was_not_ended() -> None:
    listening, writing = Listening(YES), Writing("Yes.")
    decoder = AgreeingDecoder(listening, writing)
    decoder.begin()
    decoder.take(b"forgotten")
    decoder.begin()
    decoder.take(b"a")
    decoder.take(b"b")
    decoder.end()
    assert listening.sound == writing.sound == b"ab"
