"""What a model's probabilities say for and against each command."""

import math

import pytest
from telling_model import Telling

from mend.server.speech.commands import Command
from mend.server.speech.phrase_search import FAR_BEHIND
from mend.server.speech.vocabulary import Vocabulary
from mend.server.speech.written_evidence import FASTER, Candidate, WrittenEvidence

SOUND = bytes(3200)


def candidates(
    told: dict[str, float], vocabulary: Vocabulary = Vocabulary.ANSWER
) -> dict[Command, Candidate]:
    _, found = WrittenEvidence(Telling(told), vocabulary).of(SOUND)
    return {each.command: each for each in found}


def test_a_command_is_weighed_against_all_else() -> None:
    found = candidates({"No.": 0.5, "Snow.": 0.2, "Yes.": 0.05, "Now.": 0.25})
    assert found[Command.NO].phrase == "no"
    assert found[Command.NO].ahead == pytest.approx(math.log(0.5 / 0.5), abs=0.01)
    assert found[Command.YES].ahead == pytest.approx(math.log(0.05 / 0.95), abs=0.01)


def test_all_phrases_of_a_command_speak_for_it_and_the_best_one_is_told() -> None:
    found = candidates({"Yes.": 0.3, "Yeah.": 0.5, "Guess.": 0.2})
    assert found[Command.YES].phrase == "yeah"
    assert found[Command.YES].ahead == pytest.approx(math.log(0.8 / 0.2), abs=0.01)


def test_words_of_ones_own_speak_for_a_command_too() -> None:
    found = candidates({"Yes, you can help.": 0.8, "Yes, I heard.": 0.2})
    assert found[Command.YES].phrase == "yes you can help"
    assert found[Command.YES].ahead == pytest.approx(math.log(0.8 / 0.2), abs=0.01)


def test_what_has_no_rival_is_as_far_ahead_as_anything_counts() -> None:
    assert candidates({"Yes.": 1.0})[Command.YES].ahead == FAR_BEHIND


def test_the_commands_are_those_of_the_vocabulary() -> None:
    assert Command.DONE in candidates({"I did it.": 1.0}, Vocabulary.PROMISE)
    assert candidates({"I did it.": 1.0}).get(Command.DONE) is None


def test_the_sound_is_heard_somewhat_faster_too() -> None:
    model = Telling({"Yes.": 1.0})
    WrittenEvidence(model).of(SOUND)
    assert len(model.sound) == pytest.approx(len(SOUND) / FASTER, abs=2)


def test_the_best_text_is_told_and_none_of_silence() -> None:
    model = Telling({"The weather.": 0.9, "Whether.": 0.1})
    assert WrittenEvidence(model).of(SOUND)[0] == "The weather."
    assert WrittenEvidence(Telling({"": 1.0})).of(SOUND)[0] == ""
