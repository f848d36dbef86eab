"""PocketSphinx over a stream of sound: what an utterance means."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from mend.server.speech.commands import Command
from mend.server.speech.decoding import Decoder
from mend.server.speech.endpointing import FRAME_S, FRAME_SAMPLES, Edge, Endpointer, level_db
from mend.server.speech.sureness import is_sure

FRAME_BYTES = FRAME_SAMPLES * 2

NOISE_DBFS = -60.0
"""Exact zeros, as a muted microphone sends, ruin the features: so much noise is laid under."""

LEAD_S = 0.4
"""Decoded from before speech was noticed: the weak sounds at its beginning."""

LONGEST_UTTERANCE_S = 5.0
"""Longer than any phrase: what is cut off here is no command."""


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


class Recognizer:
    """One conversation's ear. Feed it sound; it tells when speech begins and what was said."""

    def __init__(self, decoder: Decoder) -> None:
        self._decoder = decoder
        self._noise = _Noise()
        self._rest = b""
        self._lead: deque[bytes] = deque(maxlen=round(LEAD_S / FRAME_S))
        self._endpointer = Endpointer()
        self._levels_db: list[float] = []
        """Of the frames of the utterance that goes on, its lead included; empty between two."""
        self._frames_since_gap: int | None = None
        """None while nothing was missing."""

    def feed(self, pcm: bytes) -> Iterator[Heard]:
        """Take sound (PCM16, mono, 16 kHz) in pieces of any size."""
        sound = self._rest + pcm
        whole = len(sound) // FRAME_BYTES * FRAME_BYTES
        self._rest = sound[whole:]
        for start in range(0, whole, FRAME_BYTES):
            yield from self._take(self._noise.under(sound[start : start + FRAME_BYTES]))

    def interrupt(self) -> None:
        """Forget an utterance that was going on: what comes next does not follow it."""
        self._levels_db = []
        self._rest = b""
        self._lead.clear()
        self._endpointer.interrupt()
        self._frames_since_gap = None

    def skip(self) -> None:
        """Sound is missing here: an utterance around it is no command, whatever is left of it."""
        self._rest = b""
        self._frames_since_gap = 0

    def _take(self, frame: bytes) -> Iterator[Heard]:
        edge = self._endpointer.take(frame)
        if edge is Edge.BEGAN:
            self._decoder.begin()
            for before in self._lead:
                self._hear(before)
            yield SpeechBegan()
        self._lead.append(frame)
        if self._frames_since_gap is not None:
            self._frames_since_gap += 1
        if not self._levels_db:
            return
        self._hear(frame)
        if edge is Edge.ENDED:
            yield self._utterance()
            self._levels_db = []
        elif len(self._levels_db) * FRAME_S > LONGEST_UTTERANCE_S:
            self._levels_db = []
            self._endpointer.interrupt()
            yield Utterance(None, None, words=True, hangover_s=0.0)

    def _hear(self, frame: bytes) -> None:
        self._levels_db.append(level_db(frame))
        self._decoder.take(frame)

    def _utterance(self) -> Utterance:
        if self._has_gap():
            return Utterance(None, None, words=True, hangover_s=self._hangover_s())
        hypothesis = self._decoder.end()
        sure = is_sure(hypothesis, self._levels_db)
        return Utterance(
            hypothesis.command if sure else None,
            hypothesis.phrase if sure else None,
            bool(hypothesis.words),
            self._hangover_s(),
        )

    def _has_gap(self) -> bool:
        """Also where it begins at a gap: who knows what came before."""
        since = self._frames_since_gap
        return since is not None and since <= len(self._levels_db)

    def _hangover_s(self) -> float:
        return self._endpointer.quiet_frames * FRAME_S


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
