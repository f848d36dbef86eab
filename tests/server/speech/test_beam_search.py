"""The most probable texts, of a model that tells its probabilities."""

import math

import pytest
from telling_model import LETTERS, Telling

from mend.server.speech.beam_search import MOST_TOKENS, GreedyTranscriber, best_readings
from mend.server.speech.moonshine import END


def found(told: dict[str, float], width: int) -> list[tuple[str, float]]:
    model = Telling(told)
    readings = best_readings(model, model.begin(b""), width)
    return [(each.text, math.exp(each.log)) for each in readings]


def test_the_best_texts_come_with_their_probabilities_and_the_best_first() -> None:
    texts = found({"No.": 0.5, "Nose.": 0.3, "Yes.": 0.2}, 3)
    assert [text for text, _ in texts] == ["No.", "Nose.", "Yes."]
    assert [chance for _, chance in texts] == pytest.approx([0.5, 0.3, 0.2], rel=1e-4)


def test_a_text_is_found_whose_beginning_is_not_the_best() -> None:
    told = {"Aa": 0.2, "Ab": 0.2, "Ac": 0.2, "Bb": 0.4}
    assert GreedyTranscriber(Telling(told)).text_of(b"") != "Bb"
    assert found(told, 2)[0][0] == "Bb"


def test_no_text_is_the_empty_one() -> None:
    model = Telling({"": 0.9, "Uh.": 0.1})
    assert GreedyTranscriber(model).text_of(b"sound") == ""
    assert model.sound == b"sound"


def test_a_text_without_end_is_cut_off() -> None:
    text = found({"a" * 100: 1.0}, 1)[0][0]
    assert text == "a" * (MOST_TOKENS - 1)


def test_tokens_are_spelled_as_they_were_merged() -> None:
    assert LETTERS.text_of(LETTERS.spelling_of("Yes, I'll")) == "Yes, I'll"
    assert END not in LETTERS.spelling_of("Yes")
