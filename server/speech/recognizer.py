"""PocketSphinx over a stream of sound: what an utterance means."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Protocol

import numpy as np
import numpy.typing as npt
import pocketsphinx

from server.speech.commands import Command
from server.speech.endpointing import FRAME_S, FRAME_SAMPLES, Edge, Endpointer
from server.speech.language_model import Weights, command_in, write_language_model

FRAME_BYTES = FRAME_SAMPLES * 2

NOISE_DBFS = -60.0
"""Exact zeros, as a muted microphone sends, ruin the features: so much noise is laid under."""

LEAD_S = 0.4
"""Decoded from before speech was noticed: the weak sounds at its beginning."""

EARLY_FRAMES = 8
"""After so much quiet an utterance is decoded, in the hope that it has ended: when it has, the
answer is there at once."""

LONGEST_UTTERANCE_S = 5.0
"""Longer than any phrase: what is cut off here is no command."""


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


@dataclass(frozen=True, slots=True)
class SpeechBegan:
    """Somebody has begun to speak."""


@dataclass(frozen=True, slots=True)
class Utterance:
    """What was said from one silence to the next; `command` None where it is not one.

    `words` says whether there were any: noise has none. `hangover_s` is the sound that came
    after its end and before it was known to have ended.
    """

    command: Command | None
    phrase: str | None
    words: bool
    hangover_s: float


Heard = SpeechBegan | Utterance


class Decoder(Protocol):
    """What turns the sound of one utterance into words."""

    def decode(self, sound: bytes) -> str:
        """The words; phrases of commands are one word each."""
        ...


class Recognizer:
    """One conversation's ear. Feed it sound; it tells when speech begins and what was said."""

    def __init__(self, decoder: Decoder) -> None:
        self._decoder = decoder
        self._noise = _Noise()
        self._rest = b""
        self._lead: deque[bytes] = deque(maxlen=round(LEAD_S / FRAME_S))
        self._endpointer = Endpointer()
        self._utterance: list[bytes] = []
        self._early: str | None = None

    def feed(self, pcm: bytes) -> Iterator[Heard]:
        """Take sound (PCM16, mono, 16 kHz) in pieces of any size."""
        sound = self._rest + pcm
        whole = len(sound) // FRAME_BYTES * FRAME_BYTES
        self._rest = sound[whole:]
        for start in range(0, whole, FRAME_BYTES):
            yield from self._take(self._noise.under(sound[start : start + FRAME_BYTES]))

    def interrupt(self) -> None:
        """Forget an utterance that was going on: what comes next does not follow it."""
        self._utterance, self._early = [], None
        self._rest = b""
        self._lead.clear()
        self._endpointer.interrupt()

    def _take(self, frame: bytes) -> Iterator[Heard]:
        edge = self._endpointer.take(frame)
        if edge is Edge.BEGAN:
            self._utterance = [*self._lead]
            yield SpeechBegan()
        self._lead.append(frame)
        if not self._utterance:
            return
        self._utterance.append(frame)
        if edge is Edge.ENDED:
            yield self._ended()
        elif self._endpointer.quiet_frames == 0:
            self._early = None
        elif self._endpointer.quiet_frames == EARLY_FRAMES:
            self._early = self._decoder.decode(b"".join(self._utterance))
        if len(self._utterance) * FRAME_S > LONGEST_UTTERANCE_S:
            self._utterance, self._early = [], None
            self._endpointer.interrupt()
            yield Utterance(None, None, words=True, hangover_s=0.0)

    def _ended(self) -> Utterance:
        hangover_s = self._endpointer.quiet_frames * FRAME_S
        hypothesis = self._early
        if hypothesis is None:
            hypothesis = self._decoder.decode(b"".join(self._utterance))
        self._utterance, self._early = [], None
        found = command_in(hypothesis)
        command, phrase = found if found is not None else (None, None)
        return Utterance(command, phrase, bool(hypothesis), hangover_s)


class SphinxDecoder:
    """PocketSphinx with a language model of one's own."""

    def __init__(self, weights: Weights | None = None) -> None:
        model = Path(pocketsphinx.get_model_path("en-us"))
        with TemporaryDirectory(prefix="mend-speech-") as folder:
            dictionary, language_model = write_language_model(
                Path(folder), model / "cmudict-en-us.dict", weights
            )
            self._decoder = pocketsphinx.Decoder(
                hmm=str(model / "en-us"),
                dict=str(dictionary),
                lm=str(language_model),
                # A second search changes no answer, and takes a third of the time.
                fwdflat=False,
                loglevel="FATAL",
            )

    def decode(self, sound: bytes) -> str:
        # As a whole, not as it comes: the mean has to be known before the search begins.
        self._decoder.set_cmn(_text_of(self._mean_of(sound)))
        self._pass_over(sound, no_search=False)
        found = self._decoder.hyp()
        return str(found.hypstr) if found is not None else ""

    def _mean_of(self, sound: bytes) -> Cepstrum:
        """The mean of this utterance's cepstra, drawn towards the usual one while it is short.

        The decoder's own estimate moves so slowly that the first answers in a conversation, which
        are mostly the only ones, would be matched against a stranger's microphone.
        """
        self._decoder.set_cmn(_text_of(USUAL_MEAN))
        self._pass_over(sound, no_search=True)
        blended = np.array([float(each) for each in self._decoder.get_cmn(False).split(",")])
        frames = max(1.0, len(sound) / CEPSTRUM_BYTES)
        own = blended + (blended - USUAL_MEAN) * (PRIOR_FRAMES / frames)
        mean: Cepstrum = (USUAL_MEAN * USUAL_WEIGHT + own * frames) / (USUAL_WEIGHT + frames)
        return mean

    def _pass_over(self, sound: bytes, *, no_search: bool) -> None:
        self._decoder.start_utt()
        for start in range(0, len(sound), FRAME_BYTES):
            self._decoder.process_raw(sound[start : start + FRAME_BYTES], no_search=no_search)
        self._decoder.end_utt()


def _text_of(mean: Cepstrum) -> str:
    return ",".join(f"{each:.3f}" for each in mean)


class _Noise:
    """A little noise, the same for every conversation."""

    def __init__(self) -> None:
        amplitude = 32768 * 10 ** (NOISE_DBFS / 20)
        frames = np.random.default_rng(0).normal(0.0, amplitude, (251, FRAME_SAMPLES))
        self._frames = np.round(frames).astype(np.int32)
        self._next = 0

    def under(self, frame: bytes) -> bytes:
        noisy = np.frombuffer(frame, np.int16) + self._frames[self._next]
        self._next = (self._next + 1) % len(self._frames)
        sound: bytes = np.clip(noisy, -32768, 32767).astype(np.int16).tobytes()
        return sound
