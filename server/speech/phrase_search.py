"""How probable each phrase of a vocabulary is, by the model's own decoder (forced scoring).

A beam search through the tree of all phrases: a phrase is found however far behind other texts
it is. A comma may stand between two words, and any punctuation or none at the end.
"""

import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np

from mend.server.speech.moonshine import END, Logs, Texts
from mend.server.speech.speech_model import Tokens

WIDTH = 16
"""So many beginnings of phrases are followed at a time."""
FAR_BEHIND = 8.0
"""In natural logarithms: what is so far behind the best phrase is not followed."""

_I = re.compile(r"\bi\b")
_MARKS = (b".", b"!", b"?", b",")
_COMMA = b","


@dataclass(slots=True)
class _Node:
    """A beginning of phrases, and the phrase that it is itself."""

    following: dict[int, "_Node"] = field(default_factory=dict)
    phrase: str | None = None


@dataclass(frozen=True, slots=True)
class _Path:
    """A way to write the beginning of a phrase; `punctuated` if no other mark may follow."""

    node: _Node
    log: float
    punctuated: bool = True
    over: bool = False


class PhraseSearch:
    """Finds the phrases that an utterance may have been."""

    def __init__(self, tokens: Tokens, phrases: Iterable[str]) -> None:
        self._root = _Node()
        self._comma = tokens.number_of(_COMMA)
        self._marks = [tokens.number_of(each) for each in _MARKS]
        for phrase in phrases:
            node = self._root
            for token in tokens.spelling_of(_written(phrase)):
                node = node.following.setdefault(token, _Node())
            node.phrase = phrase

    def logs_of(self, texts: Texts) -> dict[str, float]:
        """The phrases and the logarithms of how probable they are, over all ways to write them.

        Phrases that are far less probable than the best one are not among them.
        """
        found: dict[str, float] = {}
        paths = [_Path(self._root, 0.0)]
        while True:
            for phrase, log in _ended(paths, texts.next_logs):
                found[phrase] = float(np.logaddexp(found.get(phrase, -math.inf), log))
            ways = self._best_ways(paths, texts.next_logs, max(found.values(), default=-math.inf))
            if not ways:
                return found
            paths = [path for _, _, path in ways]
            texts = texts.grown([row for row, _, _ in ways], [token for _, token, _ in ways])

    def _best_ways(
        self, paths: list[_Path], logs: Logs, best: float
    ) -> list[tuple[int, int, _Path]]:
        ways = [
            way for row, path in enumerate(paths) for way in self._ways_on(row, path, logs[row])
        ]
        ways.sort(key=lambda way: -way[2].log)
        least = max([best, *(path.log for _, _, path in ways[:1])]) - FAR_BEHIND
        return [way for way in ways[:WIDTH] if way[2].log > least]

    def _ways_on(self, row: int, path: _Path, logs: Logs) -> Iterator[tuple[int, int, _Path]]:
        if path.over:
            return
        for token, node in path.node.following.items():
            yield row, token, _Path(node, path.log + float(logs[token]), punctuated=False)
        if path.punctuated:
            return
        if path.node.following:
            log = path.log + float(logs[self._comma])
            yield row, self._comma, _Path(path.node, log)
        if path.node.phrase is not None:
            for mark in self._marks:
                log = path.log + float(logs[mark])
                yield row, mark, _Path(path.node, log, over=True)


def _ended(paths: list[_Path], logs: Logs) -> Iterator[tuple[str, float]]:
    for path, of_path in zip(paths, logs, strict=True):
        if path.node.phrase is not None and (path.over or not path.punctuated):
            yield path.node.phrase, path.log + float(of_path[END])


def _written(phrase: str) -> str:
    """As the model writes it: with a capital letter at the beginning, and `I`."""
    written = _I.sub("I", phrase)
    return written[:1].upper() + written[1:]
