# ruff: noqa: T201
"""Sets the weights with which PocketSphinx's margin and a model's odds are added up.

Logistic regression over what the tuned voices of `speech_corpus.py` say of the tuned phrases: of
the command that the sum holds for best, is it what was said? Printed are the weights, and how they
do on each voice where they are set with the others.
"""

import argparse
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize
from speech import VOCABULARY, Share
from speech_corpus import (
    FRAME_BYTES,
    MORE_TUNED_VOICES,
    PHRASES,
    TUNED_VOICES,
    Condition,
    Spoken,
    microphone,
)

from mend.server.speech.commands import Command
from mend.server.speech.decoding import Hypothesis
from mend.server.speech.fused_decoder import evidence_of
from mend.server.speech.moonshine import Moonshine
from mend.server.speech.recognizer import Recognizer
from mend.server.speech.speech_model import find_speech_model
from mend.server.speech.sphinx_decoder import SphinxDecoder
from mend.server.speech.written_evidence import WrittenEvidence

ODDS = 3.0
"""So many times as probable as not a command has to be."""
ROUNDS = 3
"""Which command is best depends on the weights, and they on which it is."""
PENALTY = 1e-3

Weights = npt.NDArray[np.float64]
FIRST: Weights = np.array([1.0, 10.0, 1.0, 0.0])


@dataclass(frozen=True, slots=True)
class Heard:
    """What both recognizers say of each command, where they do not hear two different ones."""

    said: Spoken
    evidence: dict[Command, Weights]
    alone: Command | None

    def best(self, weights: Weights) -> Command | None:
        return max(
            self.evidence, key=lambda each: float(self.evidence[each] @ weights), default=None
        )

    def taken(self, weights: Weights) -> Command | None:
        best = self.best(weights)
        if best is None or self.alone not in (None, best):
            return None
        return best if self.evidence[best] @ weights >= math.log(ODDS) else None


class Collecting:
    """Implements `Decoder`: keeps what both say, and hears nothing."""

    def __init__(self, decoder: SphinxDecoder, written: WrittenEvidence) -> None:
        self._decoder = decoder
        self._written = written
        self._taken: list[bytes] = []
        self.evidence: dict[Command, Weights] = {}
        self.alone: Command | None = None

    def begin(self) -> None:
        self._taken = []
        self._decoder.begin()

    def take(self, sound: bytes) -> None:
        self._taken.append(sound)
        self._decoder.take(sound)

    def end(self) -> Hypothesis:
        self.alone = self._decoder.end().command
        self.evidence = {
            each.command: np.array([*evidence_of(each, self._decoder.margin_of(each.command)), 1.0])
            for each in self._written.of(b"".join(self._taken))[1]
        }
        return Hypothesis("")


def listen(collecting: Collecting, said: Spoken) -> Heard:
    sound, _ = microphone(said, Condition("clean"), 0)
    collecting.evidence, collecting.alone = {}, None
    for _ in Recognizer(collecting).feed(sound[: len(sound) // FRAME_BYTES * FRAME_BYTES]):
        pass
    return Heard(said, collecting.evidence, collecting.alone)


def all_said(voice: str) -> list[Spoken]:
    tuned = PHRASES["tuned"]
    commands = [
        Spoken(voice, phrase, Command(command))
        for command, phrases in tuned["commands"].items()
        for phrase in phrases
        if phrase in VOCABULARY
    ]
    unrelated = [Spoken(voice, each, None) for few in tuned["unrelated"].values() for each in few]
    return commands + unrelated


def weights_by(heard: Sequence[Heard]) -> Weights:
    weights = FIRST
    for _ in range(ROUNDS):
        found = [(each, best) for each in heard if (best := each.best(weights)) is not None]
        evidence = np.array([each.evidence[best] for each, best in found])
        signs = np.array([1.0 if best is each.said.command else -1.0 for each, best in found])
        weights = _regression(evidence, signs)
    return weights


def _regression(evidence: npt.NDArray[np.float64], signs: npt.NDArray[np.float64]) -> Weights:
    scale = np.append(evidence[:, :-1].std(axis=0), 1.0)

    def loss(scaled: Weights) -> float:
        odds = signs * (evidence / scale @ scaled)
        return float(np.logaddexp(0.0, -odds).mean() + PENALTY * (scaled[:-1] ** 2).sum())

    found: Weights = minimize(loss, np.zeros(len(scale)), method="L-BFGS-B").x / scale
    return found


def print_shares(name: str, heard: Sequence[Heard], weights: Weights) -> None:
    commands = [each for each in heard if each.said.command is not None]
    right = sum(each.taken(weights) is each.said.command for each in commands)
    taken = sum(each.taken(weights) is not None for each in heard if each.said.command is None)
    print(
        f"{name}: right {Share(right, len(commands))}, unrelated taken "
        f"{Share(taken, len(heard) - len(commands))}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("model", type=Path, help="a folder with a speech model")
    written = WrittenEvidence(Moonshine(find_speech_model(parser.parse_args().model)))
    collecting = Collecting(SphinxDecoder(), written)
    heard = {
        voice: [listen(collecting, said) for said in all_said(voice)]
        for voice in (*TUNED_VOICES, *MORE_TUNED_VOICES)
    }
    print("set with all other voices:")
    for voice, of_voice in heard.items():
        others = [each for other, some in heard.items() if other != voice for each in some]
        print_shares(f"  {voice}", of_voice, weights_by(others))
    everything = [each for some in heard.values() for each in some]
    weights = weights_by(everything)
    print_shares("set with all of them", everything, weights)
    ahead, margin, letters, bias = weights
    print(f"ahead {ahead:.2f}, margin {margin:.1f}, letters {letters:.2f}, ", end="")
    print(f"least {math.log(ODDS) - bias:.2f}")


if __name__ == "__main__":
    main()
