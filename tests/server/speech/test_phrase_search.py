"""The probabilities of phrases, by a model that tells those of texts."""

import math

import pytest
from telling_model import LETTERS, Telling

from mend.server.speech.phrase_search import FAR_BEHIND, PhraseSearch
from mend.server.speech.speech_model import SpeechModelError

PHRASES = ("yes", "yes please", "i will", "no")


def chances(told: dict[str, float]) -> dict[str, float]:
    found = PhraseSearch(LETTERS, PHRASES).logs_of(Telling(told).begin(b""))
    return {phrase: math.exp(log) for phrase, log in found.items() if log > -FAR_BEHIND}


def test_a_phrase_is_found_however_it_is_written() -> None:
    told = {"Yes, please.": 0.4, "Yes please": 0.2, "Yes.": 0.3, "Yes": 0.1}
    assert chances(told) == pytest.approx({"yes please": 0.6, "yes": 0.4}, rel=1e-3)


def test_a_phrase_is_found_behind_texts_that_are_none() -> None:
    assert chances({"Snow.": 0.6, "Now.": 0.3, "No!": 0.1}) == pytest.approx({"no": 0.1}, rel=1e-3)


def test_who_speaks_is_written_with_a_capital() -> None:
    assert chances({"I will.": 1.0}) == pytest.approx({"i will": 1.0}, rel=1e-3)


def test_what_goes_on_after_a_phrase_is_not_that_phrase() -> None:
    assert chances({"Yes and no.": 1.0}) == {}
    assert chances({"Yes. Please.": 1.0}) == {}


def test_a_phrase_that_a_model_cannot_write_is_told() -> None:
    with pytest.raises(SpeechModelError, match="no token 'ß'"):
        PhraseSearch(LETTERS, ["ja heiß"])
