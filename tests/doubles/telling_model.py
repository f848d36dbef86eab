"""A model that holds for probable what a test tells it, whatever it hears; it spells by letters."""

import string
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mend.server.speech.moonshine import END, Logs
from mend.server.speech.speech_model import Tokens

LETTERS = Tokens(
    [b"<unk>", b"<s>", b"</s>"]
    + [each.encode() for each in "\N{LOWER ONE EIGHTH BLOCK}" + string.ascii_letters + "',.!?"]
)
HARDLY = 1e-9
"""The probability of a token that nothing told begins with."""


@dataclass(frozen=True, slots=True)
class TellingTexts:
    """Implements `Texts`."""

    told: Mapping[tuple[int, ...], float]
    begun: Sequence[tuple[int, ...]]

    @property
    def next_logs(self) -> Logs:
        chances = np.full((len(self.begun), len(LETTERS)), HARDLY)
        for row, text in enumerate(self.begun):
            for whole, chance in self.told.items():
                if whole[: len(text)] == text and len(whole) > len(text):
                    chances[row, whole[len(text)]] += chance
        logs: Logs = np.log(chances / chances.sum(axis=1, keepdims=True)).astype(np.float32)
        return logs

    def grown(self, rows: Sequence[int], tokens: Sequence[int]) -> "TellingTexts":
        begun = [(*self.begun[row], token) for row, token in zip(rows, tokens, strict=True)]
        return TellingTexts(self.told, begun)


class Telling:
    """Implements `TokenModel`; `sound` is all that it was given last."""

    tokens = LETTERS

    def __init__(self, told: Mapping[str, float]) -> None:
        self._told = {(*LETTERS.spelling_of(text), END): chance for text, chance in told.items()}
        self.sound = b""

    def begin(self, sound: bytes) -> TellingTexts:
        self.sound = sound
        return TellingTexts(self._told, [()])
