"""The most probable texts of an utterance, by a beam search."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from mend.server.speech.moonshine import END, Texts, TokenModel

MOST_TOKENS = 32
"""Of a text: what is longer is no answer, and is cut off here."""


@dataclass(frozen=True, slots=True)
class Reading:
    """A text, and the logarithm of how probable the model holds it, given the sound."""

    text: str
    log: float


class Transcriber(Protocol):
    """What writes down what is said."""

    def text_of(self, sound: bytes) -> str:
        """The text of an utterance (PCM16, mono, 16 kHz); empty where there is none."""
        ...


class GreedyTranscriber:
    """Implements `Transcriber`: always the most probable next token."""

    def __init__(self, model: TokenModel) -> None:
        self._model = model

    def text_of(self, sound: bytes) -> str:
        readings = best_readings(self._model, self._model.begin(sound), 1)
        return readings[0].text if readings else ""


def best_readings(model: TokenModel, texts: Texts, width: int) -> list[Reading]:
    """The best texts that go on from the empty one, `width` at most, the best first."""
    growing: list[tuple[tuple[int, ...], float]] = [((), 0.0)]
    ended: list[tuple[float, tuple[int, ...]]] = []
    for _ in range(MOST_TOKENS):
        logs = texts.next_logs + np.array([log for _, log in growing])[:, None]
        ended += [(float(logs[row, END]), text) for row, (text, _) in enumerate(growing)]
        ended = sorted(ended, reverse=True)[:width]
        logs[:, END] = -np.inf
        flat = logs.ravel()
        best = np.argpartition(-flat, width)[:width]
        # What grows only becomes less probable: nothing of it can still be among the best.
        worst = ended[-1][0] if len(ended) == width else -np.inf
        best = best[flat[best] > worst]
        if not len(best):
            break
        rows, tokens = np.divmod(best, logs.shape[1])
        growing = [
            ((*growing[row][0], int(token)), float(logs[row, token]))
            for row, token in zip(rows, tokens, strict=True)
        ]
        texts = texts.grown(rows.tolist(), tokens.tolist())
    else:
        ended += [(log, text) for text, log in growing]
    return [Reading(model.tokens.text_of(text), log) for log, text in sorted(ended, reverse=True)]
