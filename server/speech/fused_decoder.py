"""Two recognizers that err differently, and one verdict from the evidence of both.

Their scores are combined as logarithms (Beyerlein 1998), with weights that make of the sum the
logarithm of the odds that a command was said (logistic regression, Brümmer and du Preez 2006).
"""

import math
from dataclasses import dataclass
from typing import Protocol

from mend.server.speech.commands import Command
from mend.server.speech.decoding import Decoder, Hypothesis
from mend.server.speech.written_evidence import Candidate, Weighing


class ComparingDecoder(Decoder, Protocol):
    """A decoder that can tell of each command how far it was ahead."""

    def margin_of(self, command: Command) -> float:
        """Of the utterance that was ended last; negative where something else was ahead."""
        ...


@dataclass(frozen=True, slots=True)
class FusionWeights:
    """Set by `benchmarks/speech_fusion.py` with the tuned voices and phrases alone."""

    ahead: float = 0.76
    """Of the model's likelihood ratio, a natural logarithm."""
    margin: float = 18.7
    """Of PocketSphinx's margin."""
    letters: float = 1.6
    """Of the logarithm of how many letters the phrase has: little else sounds like a long one."""
    least: float = 2.06
    """What the sum has to be for a command to count: it is then three times as probable as not."""


class FusedDecoder:
    """Implements `Decoder`: one that listens for commands, and a model that writes any text."""

    def __init__(
        self, decoder: ComparingDecoder, weighing: Weighing, weights: FusionWeights | None = None
    ) -> None:
        self._decoder = decoder
        self._weighing = weighing
        self._weights = weights or FusionWeights()
        self._taken: list[bytes] = []

    def begin(self) -> None:
        self._taken = []
        self._decoder.begin()

    def take(self, sound: bytes) -> None:
        self._taken.append(sound)
        self._decoder.take(sound)

    def end(self) -> Hypothesis:
        heard = self._decoder.end()
        text, candidates = self._weighing.of(b"".join(self._taken))
        self._taken = []
        best = max(candidates, key=self._sum_of, default=None)
        words = text or heard.words
        # What one hears as one command and the other as another is asked about again.
        if best is None or heard.command not in (None, best.command):
            return Hypothesis(words)
        if self._sum_of(best) < self._weights.least:
            return Hypothesis(words)
        return Hypothesis(words, best.command, best.phrase, math.inf)

    def _sum_of(self, candidate: Candidate) -> float:
        weights = self._weights
        evidence = evidence_of(candidate, self._decoder.margin_of(candidate.command))
        ahead, margin, letters = evidence
        return weights.ahead * ahead + weights.margin * margin + weights.letters * letters


def evidence_of(candidate: Candidate, margin: float) -> tuple[float, float, float]:
    """What is added up of a command, each with its weight; `margin` is PocketSphinx's."""
    letters = len(candidate.phrase.replace(" ", ""))
    return candidate.ahead, margin, math.log(letters)
