"""PocketSphinx over one utterance: its words, and by how much they are the best explanation.

The search runs while the person still speaks, so that little is left to do at the end.
"""

import math
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import numpy.typing as npt
import pocketsphinx

from mend.server.speech.commands import Command
from mend.server.speech.decoding import Hypothesis
from mend.server.speech.language_model import (
    COMMAND_MARK,
    Weights,
    command_in,
    name,
    write_language_model,
)
from mend.server.speech.vocabulary import Vocabulary, phrase_commands

Cepstrum = npt.NDArray[np.float64]

USUAL_MEAN: Cepstrum = np.array(
    [46.0, -3.0, 9.0, 12.0, 1.0, 0.5, 3.0, -6.0, -5.0, -5.0, 5.0, 1.3, 1.8]
)
"""The mean of the cepstra over the voices that the language model's weights were set with."""

USUAL_WEIGHT = 100.0
"""In frames: an utterance of a second counts as much."""

PRIOR_FRAMES = 500.0
"""How many frames the mean that PocketSphinx is given counts for."""

CEPSTRUM_BYTES = 320
"""Of sound, from one frame of cepstra to the next (10 ms)."""

ACQUAINTANCE_BYTES = 80 * CEPSTRUM_BYTES
"""So much of an utterance is heard before its mean is taken and the search begins.

A mean that is taken again later makes silence look like words.
"""

READINGS = 60
"""How many of the best readings of an utterance are compared."""
BREATHS = {"a", "ah", "are", "i", "oh", "or", "uh"}
"""What a breath or the silence around a phrase is heard as: no rival of the phrase alone."""
OTHER_SCALE = 10.0
"""Readings whose scores differ by more than this do not compare: some overflow."""
FAR_AHEAD = 0.2
"""The margin of a command that has no rival among them, or only poor ones; negative, the least."""


class SphinxDecoder:
    """PocketSphinx with a language model of one's own."""

    def __init__(
        self, vocabulary: Vocabulary = Vocabulary.ANSWER, weights: Weights | None = None
    ) -> None:
        self._vocabulary = vocabulary
        model = Path(pocketsphinx.get_model_path("en-us"))
        with TemporaryDirectory(prefix="mend-speech-") as folder:
            dictionary, language_model = write_language_model(
                Path(folder), model / "cmudict-en-us.dict", weights, vocabulary
            )
            self._search = pocketsphinx.Decoder(
                hmm=str(model / "en-us"),
                dict=str(dictionary),
                lm=str(language_model),
                # A second search changes no answer, and takes a third of the time.
                fwdflat=False,
                loglevel="FATAL",
            )
            # Never searches: it is there for the mean of the cepstra, before they are normalized.
            self._front = pocketsphinx.Decoder(
                hmm=str(model / "en-us"),
                dict=str(dictionary),
                keyphrase=COMMAND_MARK + name(next(iter(phrase_commands(vocabulary)))),
                lm=None,
                loglevel="FATAL",
            )
        self._begun = self._searching = False
        self._waiting: list[bytes] = []
        self._taken_bytes = 0
        self._heard: Command | None = None
        self._readings: list[tuple[Command | None, float]] | None = None

    def begin(self) -> None:
        if self._begun:
            self._finish()
        self._front.set_cmn(_text_of(USUAL_MEAN))
        self._front.start_utt()
        self._search.start_utt()
        self._begun, self._searching = True, False
        self._waiting, self._taken_bytes = [], 0
        self._heard = self._readings = None

    def take(self, sound: bytes) -> None:
        self._taken_bytes += len(sound)
        self._waiting.append(sound)
        if not self._searching:
            self._front.process_raw(sound, no_search=True)
        if self._taken_bytes >= ACQUAINTANCE_BYTES:
            self._search_on()

    def end(self) -> Hypothesis:
        self._search_on()
        self._finish()
        found = self._search.hyp()
        if found is None:
            return Hypothesis("")
        words = str(found.hypstr)
        known = command_in(words, self._vocabulary)
        if known is None:
            return Hypothesis(words)
        command, phrase = known
        self._heard = command
        return Hypothesis(words, command, phrase, self.margin_of(command))

    def margin_of(self, command: Command) -> float:
        """By how much the best reading as a command is ahead of the best other one.

        Negative where it is behind. Of the utterance that was ended last.
        """
        if self._readings is None:
            self._readings = [*self._best_readings()]
        ours = [score for meant, score in self._readings if meant is command]
        others = [score for meant, score in self._readings if meant is not command]
        if not ours and command is self._heard:
            return 0.0
        if not others:
            return FAR_AHEAD if ours else -FAR_AHEAD
        # What is not among the best readings is behind the last of them at least.
        return max(-FAR_AHEAD, min(FAR_AHEAD, max(ours or [min(others)]) - max(others)))

    def _best_readings(self) -> Iterator[tuple[Command | None, float]]:
        """What each of the best readings means, and its score."""
        first: float | None = None
        for reading in islice(self._search.nbest() or (), READINGS):
            if reading is None or not reading.hypstr or reading.score <= 0:
                continue
            score = math.log(reading.score)
            first = score if first is None else first
            if abs(score - first) < OTHER_SCALE:
                meant = command_in(_without_breaths(reading.hypstr), self._vocabulary)
                yield (None if meant is None else meant[0]), score

    def _search_on(self) -> None:
        if not self._searching:
            self._search.set_cmn(_text_of(self._mean()))
            self._searching = True
        for sound in self._waiting:
            self._search.process_raw(sound)
        self._waiting = []

    def _finish(self) -> None:
        self._front.end_utt()
        self._search.end_utt()
        self._begun = False

    def _mean(self) -> Cepstrum:
        """The mean of this utterance's cepstra, drawn towards the usual one while it is short.

        The decoder's own estimate moves so slowly that the first answers in a conversation, which
        are mostly the only ones, would be matched against a stranger's microphone.
        """
        blended = np.array([float(each) for each in self._front.get_cmn(True).split(",")])
        frames = max(1.0, self._taken_bytes / CEPSTRUM_BYTES)
        own = blended + (blended - USUAL_MEAN) * (PRIOR_FRAMES / frames)
        mean: Cepstrum = (USUAL_MEAN * USUAL_WEIGHT + own * frames) / (USUAL_WEIGHT + frames)
        return mean


def _without_breaths(words: str) -> str:
    return " ".join(word for word in words.split() if word.partition("(")[0] not in BREATHS)


def _text_of(mean: Cepstrum) -> str:
    return ",".join(f"{each:.3f}" for each in mean)
