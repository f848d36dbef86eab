"""How much more probable each command is than anything else, to a model that writes texts.

A likelihood ratio. For a command: every phrase of it, however far behind (`phrase_search.py`), and
what else means it; against it: the most probable texts of all (`beam_search.py`), and other
commands. It is the average over the sound as it came and the same somewhat faster (speed
perturbation, Ko et al. 2015): a voice that is hard for the model is often clearer in one of them.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from mend.server.speech.beam_search import best_readings
from mend.server.speech.commands import Command
from mend.server.speech.meaning import meaning_of
from mend.server.speech.moonshine import TokenModel
from mend.server.speech.phrase_search import FAR_BEHIND, PhraseSearch
from mend.server.speech.vocabulary import Vocabulary, phrase_commands

TEXTS = 8
"""So many texts are compared."""
FASTER = 1.1


@dataclass(frozen=True, slots=True)
class Candidate:
    """A command that an utterance may have been, by the most probable of its phrases.

    `ahead` is the natural logarithm of how many times it is as probable as all else together,
    within `FAR_BEHIND`.
    """

    command: Command
    phrase: str
    ahead: float


class Weighing(Protocol):
    """What weighs commands against all else that an utterance may have been."""

    def of(self, sound: bytes) -> tuple[str, Sequence[Candidate]]:
        """The most probable text of an utterance (PCM16, mono, 16 kHz), and the commands."""
        ...


class WrittenEvidence:
    """Implements `Weighing` with a model that writes texts."""

    def __init__(self, model: TokenModel, vocabulary: Vocabulary = Vocabulary.ANSWER) -> None:
        self._model = model
        self._vocabulary = vocabulary
        self._commands = phrase_commands(vocabulary)
        self._search = PhraseSearch(model.tokens, self._commands)

    def of(self, sound: bytes) -> tuple[str, Sequence[Candidate]]:
        views = [self._heard_in(view) for view in (sound, _faster(sound))]
        return views[0][0], _on_average([candidates for _, candidates in views])

    def _heard_in(self, sound: bytes) -> tuple[str, dict[Command, Candidate]]:
        texts = self._model.begin(sound)
        phrases: dict[Command, dict[str, float]] = {}
        for phrase, log in self._search.logs_of(texts).items():
            phrases.setdefault(self._commands[phrase], {})[phrase] = log
        others: list[float] = []
        readings = best_readings(self._model, texts, TEXTS)
        for reading in readings:
            command, words = meaning_of(reading.text, self._vocabulary)
            if command is None or words is None:
                others.append(reading.log)
            # What is a phrase as it stands has been counted, with all ways to write it.
            elif words not in self._commands:
                logs = phrases.setdefault(command, {})
                logs[words] = _together([logs.get(words, -math.inf), reading.log])
        return (readings[0].text if readings else ""), _compared(phrases, others)


def _compared(
    phrases: dict[Command, dict[str, float]], others: Sequence[float]
) -> dict[Command, Candidate]:
    together = {command: _together([*logs.values()]) for command, logs in phrases.items()}
    found = {}
    for command, log in together.items():
        rest = _together([*others, *(each for of, each in together.items() if of is not command)])
        phrase = max(phrases[command], key=lambda each: phrases[command][each])
        ahead = max(-FAR_BEHIND, min(FAR_BEHIND, log - rest))
        found[command] = Candidate(command, phrase, ahead)
    return found


def _on_average(views: Sequence[Mapping[Command, Candidate]]) -> list[Candidate]:
    found = []
    for command in {command: None for view in views for command in view}:
        best = max((view[command] for view in views if command in view), key=_ahead_of)
        aheads = [view[command].ahead if command in view else -FAR_BEHIND for view in views]
        found.append(Candidate(command, best.phrase, sum(aheads) / len(aheads)))
    return found


def _ahead_of(candidate: Candidate) -> float:
    return candidate.ahead


def _faster(sound: bytes) -> bytes:
    """As a somewhat faster and higher voice would say it."""
    samples = np.frombuffer(sound, np.int16)
    places = np.arange(0, len(samples), FASTER)
    faster: bytes = np.interp(places, np.arange(len(samples)), samples).astype(np.int16).tobytes()
    return faster


def _together(logs: Sequence[float]) -> float:
    return float(np.logaddexp.reduce(logs)) if logs else -math.inf
