"""What a written text means: one command and nothing else, or none."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.server.speech.commands import AMBIGUOUS, Command
from mend.server.speech.meaning import meaning_of
from mend.server.speech.vocabulary import PHRASES_OF, Vocabulary, phrase_commands


@pytest.mark.parametrize("vocabulary", Vocabulary)
def test_every_phrase_of_a_vocabulary_means_its_command(vocabulary: Vocabulary) -> None:
    for phrase, command in phrase_commands(vocabulary).items():
        assert meaning_of(f"{phrase.capitalize()}.", vocabulary)[0] is command


@pytest.mark.parametrize(
    ("text", "command"),
    [
        ("Um, yes, please!", Command.YES),
        ("OK.", Command.YES),
        ("Alright.", Command.YES),
        ("Yes, you can do that.", Command.YES),
        ("Okay, that would be nice.", Command.YES),
        ("Yes, I\N{RIGHT SINGLE QUOTATION MARK}ll do it.", Command.YES),
        ("No, I have no time.", Command.NO),
        ("No, that is not right.", Command.NO),
        ("Stop, please.", Command.STOP),
        ("Could you repeat that, robot?", Command.REPEAT),
    ],
)
def test_a_command_may_be_said_in_words_of_ones_own(text: str, command: Command) -> None:
    assert meaning_of(text)[0] is command


@pytest.mark.parametrize(
    "text",
    [
        "",
        "...",
        "Yes and no.",
        "Yes, but not now.",
        "No problem.",
        "No one is in the office.",
        "Yesterday.",
        "Okay, so the meeting is on Monday.",
        "Sure about the price?",
        "He said yes.",
        "Don't stop.",
        "Don't it?",
        "Stop and go.",
        "Yes I can do that and then I will go to help you there again today please",
        "A robot",
        "Please.",
    ],
)
def test_what_is_something_else_as_well_is_no_command(text: str) -> None:
    assert meaning_of(text) == (None, None)


def test_what_is_near_to_a_command_is_none() -> None:
    for phrase in AMBIGUOUS:
        assert meaning_of(phrase)[0] is None


@given(
    st.sampled_from(PHRASES_OF[Vocabulary.ANSWER][Command.YES]),
    st.sampled_from(["not", "no", "never", "but", "don't", "can't", "stop", "later", "wait"]),
    st.integers(0, 6),
)
def test_a_yes_with_a_word_that_changes_it_is_never_a_yes(yes: str, changing: str, at: int) -> None:
    words = yes.split()
    words.insert(min(at, len(words)), changing)
    assert meaning_of(" ".join(words))[0] is not Command.YES


def test_promises_are_no_answers_and_answers_no_promises() -> None:
    assert meaning_of("I did it.", Vocabulary.PROMISE)[0] is Command.DONE
    assert meaning_of("I did it.") == (None, None)
    assert meaning_of("Yes, you can do that.", Vocabulary.PROMISE) == (None, None)
    assert meaning_of("Leave it out, please.", Vocabulary.WAYS)[0] is Command.LEAVE_OUT
