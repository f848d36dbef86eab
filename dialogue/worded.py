"""Texts that know what they were made of, so that they can be said in other languages too."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Self

_APART = re.compile(r"(?<=[.!?]) |(?<=[.!?])(?=\{why\})|(?<=\{why\}) ")
"""Between two sentences; `why` is one of its own, with a blank before it, or nothing."""
_MOST_TEXTS = 1024
"""More than all scripts have: each is said again and again."""


@dataclass(frozen=True, slots=True)
class Sentence:
    """A sentence, or a part of one: `key` is its English text with fields, `args` fills them.

    An argument that is `Worded` can be said in other languages too, any other stays as it is.
    """

    key: str
    args: Mapping[str, str] = field(default_factory=dict)


class Worded(str):
    """An English text, and the `sentences` that it is made of, a blank between each two."""

    sentences: tuple[Sentence, ...]

    def __new__(cls, text: str, sentences: tuple[Sentence, ...]) -> Self:
        worded = super().__new__(cls, text)
        worded.sentences = sentences
        return worded

    def capitalized(self) -> "Worded":
        """The same, beginning with a capital."""
        return Worded(f"{self[:1].upper()}{self[1:]}", self.sentences)


def worded(key: str, /, **args: str) -> Worded:
    """One sentence, or a part of one, with its fields filled in."""
    return Worded(key.format(**args), (Sentence(key, args),))


def sentences_of(text: str) -> tuple[Sentence, ...]:
    """What a text is made of; one that does not say is one sentence without fields."""
    return text.sentences if isinstance(text, Worded) else (Sentence(text),)


def joined(*texts: str) -> Worded:
    """Texts one after the other, but for those that are empty."""
    some = [text for text in texts if text]
    return Worded(" ".join(some), tuple(each for text in some for each in sentences_of(text)))


def filled_in(text: str, args: Mapping[str, str]) -> Worded:
    """A text of several sentences with its fields filled in."""
    sentences = [each for piece in _pieces(text) for each in _filled_in(piece, args)]
    return Worded(text.format(**args), tuple(sentences))


@lru_cache(_MOST_TEXTS)
def _pieces(text: str) -> Sequence[str]:
    return tuple(_APART.split(text))


def _filled_in(piece: str, args: Mapping[str, str]) -> tuple[Sentence, ...]:
    if piece == "{why}":
        return sentences_of(args["why"]) if args["why"] else ()
    used = {name: text for name, text in args.items() if f"{{{name}}}" in piece}
    return (Sentence(piece, used),)
