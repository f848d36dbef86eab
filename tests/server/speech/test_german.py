"""What German that was written down means: one command and nothing else, or none."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from writing_transcriber import Writing

from mend.server.speech.commands import Command
from mend.server.speech.ear import NoEars, choose_ears
from mend.server.speech.german import PHRASES_IN_GERMAN, meaning_in_german
from mend.server.speech.phrases import FIXED, sorry_name
from mend.server.speech.vocabulary import PHRASES_OF, SpokenLanguage, Vocabulary
from mend.server.speech.written_decoder import WrittenDecoder


@pytest.mark.parametrize("vocabulary", Vocabulary)
def test_every_phrase_means_its_command_alone(vocabulary: Vocabulary) -> None:
    for command, phrases in PHRASES_IN_GERMAN[vocabulary].items():
        for phrase in phrases:
            assert meaning_in_german(f"{phrase.capitalize()}.", vocabulary) == (command, phrase)


@pytest.mark.parametrize("vocabulary", Vocabulary)
def test_there_is_a_phrase_for_every_command(vocabulary: Vocabulary) -> None:
    assert set(PHRASES_IN_GERMAN[vocabulary]) == set(PHRASES_OF[vocabulary])


@pytest.mark.parametrize(
    ("text", "command"),
    [
        ("Ähm, ja, bitte!", Command.YES),
        ("Ja, mach ich.", Command.YES),
        ("Ja, OK.", Command.YES),
        ("Nein, ich kann nicht.", Command.NO),
        ("Bitte nochmal.", Command.REPEAT),
        ("Stop, bitte!", Command.STOP),
    ],
)
def test_hesitation_and_spelling_change_nothing(text: str, command: Command) -> None:
    assert meaning_in_german(text, Vocabulary.ANSWER)[0] is command


@pytest.mark.parametrize(
    "text",
    [
        "",
        "Ja.",
        "Nein.",
        "Mach ich.",
        "Das stimmt.",
        "Ja, aber später.",
        "Nein, doch, ja bitte.",
        "Er sagte: ja, bitte.",
        "Warte.",
        "Ja bitte nicht.",
        "Ich weiß nicht.",
        "yes please",
    ],
)
def test_what_is_unclear_is_no_command(text: str) -> None:
    assert meaning_in_german(text, Vocabulary.ANSWER) == (None, None)


@given(st.text(max_size=80), st.sampled_from(Vocabulary))
def test_any_text_is_a_phrase_or_none(text: str, vocabulary: Vocabulary) -> None:
    command, phrase = meaning_in_german(text, vocabulary)
    assert command is None or phrase in PHRASES_IN_GERMAN[vocabulary][command]


def test_what_was_written_of_the_whole_utterance_is_what_was_said() -> None:
    transcriber = Writing("Ja, bitte.")
    decoder = WrittenDecoder(transcriber)
    decoder.begin()
    decoder.take(b"forgotten")
    decoder.begin()
    decoder.take(b"a")
    decoder.take(b"b")
    assert decoder.end().command is Command.YES
    assert transcriber.sound == b"ab"


def test_german_needs_a_model_of_ones_own() -> None:
    ears = choose_ears(True, 1, None, SpokenLanguage.GERMAN)
    assert isinstance(ears, NoEars)
    assert "speech_model" in ears.why_not


def test_who_was_not_understood_is_told_what_would_be() -> None:
    said = FIXED[sorry_name(SpokenLanguage.GERMAN, promised=False)]
    assert "ja bitte" in said
    assert FIXED[sorry_name(SpokenLanguage.ENGLISH, promised=True)].endswith("I can't.")
