"""What two recognizers together make of one utterance."""

import math
from collections.abc import Mapping, Sequence

import pytest

from mend.server.speech.commands import Command
from mend.server.speech.decoding import Hypothesis
from mend.server.speech.fused_decoder import FusedDecoder, FusionWeights
from mend.server.speech.written_evidence import Candidate

WEIGHTS = FusionWeights(ahead=1.0, margin=10.0, letters=1.0, least=2.0)


class Listening:
    """Implements `ComparingDecoder`: hears what it is told, and keeps the sound."""

    def __init__(self, hypothesis: Hypothesis, margins: Mapping[Command, float]) -> None:
        self._hypothesis = hypothesis
        self._margins = margins
        self.sound = b""

    def begin(self) -> None:
        self.sound = b""

    def take(self, sound: bytes) -> None:
        self.sound += sound

    def end(self) -> Hypothesis:
        return self._hypothesis

    def margin_of(self, command: Command) -> float:
        return self._margins.get(command, -0.2)


class Weighed:
    """Implements `Weighing`: weighs as it is told, and keeps the sound."""

    def __init__(self, text: str, *candidates: Candidate) -> None:
        self._told = text, candidates
        self.sound = b""

    def of(self, sound: bytes) -> tuple[str, Sequence[Candidate]]:
        self.sound = sound
        return self._told


def yes(ahead: float) -> Candidate:
    return Candidate(Command.YES, "yes", ahead)


HEARD_YES = Hypothesis("c_yes", Command.YES, "yes", 0.05)
OTHER = Hypothesis("the chess")


def both(heard: Hypothesis, weighed: Weighed, margins: Mapping[Command, float]) -> Hypothesis:
    decoder = FusedDecoder(Listening(heard, margins), weighed, WEIGHTS)
    decoder.begin()
    return decoder.end()


@pytest.mark.parametrize(
    ("ahead", "margin", "counts"),
    [(0.5, 0.05, True), (0.3, 0.05, False), (0.5, 0.03, False), (3.0, -0.2, True)],
)
def test_a_command_counts_by_the_sum_of_what_both_say(
    ahead: float, margin: float, counts: bool
) -> None:
    found = both(OTHER, Weighed("Yes.", yes(ahead)), {Command.YES: margin})
    assert found == (
        Hypothesis("Yes.", Command.YES, "yes", math.inf) if counts else Hypothesis("Yes.")
    )


def test_a_longer_phrase_needs_less() -> None:
    longer = Candidate(Command.YES, "yes i will do it", 0.0)
    assert both(OTHER, Weighed("Yes, I will.", longer), {Command.YES: 0.0}).command is Command.YES
    assert both(OTHER, Weighed("Yes.", yes(0.0)), {Command.YES: 0.0}).command is None


def test_the_command_counts_that_both_together_hold_for_best() -> None:
    no = Candidate(Command.NO, "no", 3.0)
    weighed = Weighed("No.", no, yes(2.0))
    assert both(OTHER, weighed, {Command.NO: -0.1, Command.YES: 0.1}).command is Command.YES


def test_what_is_heard_as_two_commands_is_none() -> None:
    no = Candidate(Command.NO, "no", 8.0)
    found = both(HEARD_YES, Weighed("No.", no), {Command.NO: 0.2})
    assert found.command is None
    assert found.words, "it was said again, and is asked about again"


def test_what_is_no_command_for_the_model_is_none() -> None:
    assert both(HEARD_YES, Weighed("Chess."), {Command.YES: 0.2}) == Hypothesis("Chess.")
    assert both(Hypothesis(""), Weighed(""), {}).words == ""


def test_both_hear_the_same_sound_and_nothing_of_an_utterance_that_was_not_ended() -> None:
    listening, weighed = Listening(HEARD_YES, {}), Weighed("Yes.", yes(1.0))
    decoder = FusedDecoder(listening, weighed)
    decoder.begin()
    decoder.take(b"forgotten")
    decoder.begin()
    decoder.take(b"a")
    decoder.take(b"b")
    decoder.end()
    assert listening.sound == weighed.sound == b"ab"
