"""What can be said at a time: the phrases that are commands then, and what is near to them."""

from collections.abc import Mapping
from enum import StrEnum

from mend.server.speech.commands import AMBIGUOUS, PHRASES, Command
from mend.server.speech.promise_phrases import PROMISE_AMBIGUOUS, PROMISE_PHRASES
from mend.server.speech.way_phrases import WAY_AMBIGUOUS, WAY_PHRASES


class SpokenLanguage(StrEnum):
    """In which language people are understood."""

    ENGLISH = "en"
    GERMAN = "de"


class Vocabulary(StrEnum):
    """What is listened for."""

    ANSWER = "answer"
    """Yes or no."""
    WAYS = "ways"
    """Yes or no, or one of several ways of help."""
    PROMISE = "promise"
    """That promised help is done, or cannot be given after all."""


PHRASES_OF: Mapping[Vocabulary, Mapping[Command, tuple[str, ...]]] = {
    Vocabulary.ANSWER: PHRASES,
    Vocabulary.WAYS: WAY_PHRASES,
    Vocabulary.PROMISE: PROMISE_PHRASES,
}
AMBIGUOUS_OF: Mapping[Vocabulary, tuple[str, ...]] = {
    Vocabulary.ANSWER: AMBIGUOUS,
    Vocabulary.WAYS: WAY_AMBIGUOUS,
    Vocabulary.PROMISE: PROMISE_AMBIGUOUS,
}


def phrase_commands(vocabulary: Vocabulary = Vocabulary.ANSWER) -> dict[str, Command]:
    """Every phrase with its command."""
    return {
        phrase: command for command, phrases in PHRASES_OF[vocabulary].items() for phrase in phrases
    }
