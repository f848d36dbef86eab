"""What a text means that somebody has said: one command and nothing else, or none."""

import re
from collections.abc import Mapping, Sequence

from mend.server.speech.commands import Command
from mend.server.speech.vocabulary import Vocabulary, phrase_commands

_WORD = re.compile(r"[a-z]+(?:'[a-z]+)*")
_SPELLED: Mapping[str, str] = {"ok": "okay", "k": "okay", "alright": "all right"}
_HESITATION = frozenset({"ah", "er", "hmm", "mm", "oh", "uh", "um", "well"})
_POLITENESS = frozenset({"please", "robot", "sir", "thanks"})

_MOST_WORDS = 8
"""In an answer in words of one's own: longer ones tell of something else as well."""
_PLAIN = frozenset((
    "a", "again", "am", "an", "and", "are", "be", "can", "could", "do", "fine", "for", "get",
    "go", "going", "good", "great", "happy", "help", "here", "i", "i'd", "i'll", "i'm", "is",
    "it", "it's", "just", "let", "let's", "like", "love", "me", "my", "nice", "now", "on",
    "one", "or", "please", "right", "so", "that", "that's", "the", "them", "then", "there",
    "there's", "this", "thank", "thanks", "time", "to", "today", "try", "very", "want", "way",
    "we", "we'll", "will", "with", "would", "you", "your",
))  # fmt: skip
"""Words that leave the sense of a yes or no as it is."""
_REFUSING = frozenset((
    "anything", "at", "busy", "can't", "cannot", "don't", "have", "haven't", "moment", "no",
    "not", "really", "sorry", "won't", "wouldn't",
))  # fmt: skip
"""Words that a no may go on with, besides."""
_NO_ANSWERS = ("no idea", "no matter", "no one", "no problem", "no doubt", "no more", "no worries")
"""What begins like a no and is none."""
_WHOLE_PHRASES_ONLY = "don't"
"""What follows it is what not to do: `don't it` is a mishearing, not a no in words of one's own."""


def meaning_of(
    text: str, vocabulary: Vocabulary = Vocabulary.ANSWER
) -> tuple[Command | None, str | None]:
    """The command that a text is, and its words; None, None where it is none, or more than one.

    It is a phrase of the vocabulary, with or without hesitation and politeness around it, or, of
    yes and no, begins with one and goes on with words alone that leave its sense as it is.
    """
    words = _words_of(text)
    known = phrase_commands(vocabulary)
    for candidate in (words, _without(words, _HESITATION), _bare(words)):
        command = known.get(" ".join(candidate))
        if command is not None:
            return command, " ".join(candidate)
    command = _answer_in(_without(words, _HESITATION), known)
    return (None, None) if command is None else (command, " ".join(words))


def _words_of(text: str) -> list[str]:
    plain = text.lower().replace("\N{RIGHT SINGLE QUOTATION MARK}", "'")
    return " ".join(_SPELLED.get(each, each) for each in _WORD.findall(plain)).split()


def _without(words: Sequence[str], left_out: frozenset[str]) -> list[str]:
    return [each for each in words if each not in left_out]


def _bare(words: Sequence[str]) -> list[str]:
    return _without(words, _HESITATION | _POLITENESS)


def _answer_in(words: Sequence[str], known: Mapping[str, Command]) -> Command | None:
    """The yes or no that words begin with, where the others do not change it."""
    if len(words) > _MOST_WORDS or " ".join(words).startswith((*_NO_ANSWERS, _WHOLE_PHRASES_ONLY)):
        return None
    for count in range(len(words), 0, -1):
        command = known.get(" ".join(words[:count]))
        if command in (Command.YES, Command.NO):
            allowed = _PLAIN | _REFUSING if command is Command.NO else _PLAIN
            rest = words[count:]
            return command if all(each in allowed for each in rest) else None
    return None
