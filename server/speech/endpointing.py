"""Where an utterance begins and ends in a stream of sound.

PocketSphinx's own endpointer takes steady noise for speech and misses words shorter than its
window. Here speech is what stands out from the noise floor, in any one of a few bands.
"""

from collections import deque
from enum import StrEnum

import numpy as np
import numpy.typing as npt

SAMPLE_RATE_HZ = 16_000
FRAME_SAMPLES = 320
FRAME_S = FRAME_SAMPLES / SAMPLE_RATE_HZ

BAND_EDGES_HZ = (250, 600, 1200, 2200, 3800, 7600)
"""Vowels are loud in the lower bands, the sounds of `yes` and `stop` in the highest."""

FLOOR_WINDOW_S = 1.5
"""Longer than anybody speaks without a gap."""
SMOOTHING = 0.6
QUIETEST_DB = -90.0

Levels = npt.NDArray[np.float64]


class Edge(StrEnum):
    """What a frame changed."""

    BEGAN = "began"
    ENDED = "ended"


class NoiseFloor:
    """The level of what is always there, per band: the quietest recent moment."""

    def __init__(self) -> None:
        self._recent: deque[Levels] = deque(maxlen=round(FLOOR_WINDOW_S / FRAME_S))

    def above(self, levels_db: Levels) -> float:
        """Take a frame's levels; by how many decibels it stands out in its best band."""
        smooth = levels_db
        if self._recent:
            smooth = SMOOTHING * self._recent[-1] + (1 - SMOOTHING) * levels_db
        self._recent.append(smooth)
        return float(np.max(levels_db - np.min(self._recent, axis=0)))


class Endpointer:
    """Tells the first and the last frame of each utterance."""

    def __init__(
        self, *, margin_db: float = 10.0, onset_s: float = 0.1, hangover_s: float = 0.3
    ) -> None:
        self._margin_db = margin_db
        self._onset_frames = round(onset_s / FRAME_S)
        self._hangover_frames = round(hangover_s / FRAME_S)
        self._floor = NoiseFloor()
        self._begins: deque[bool] = deque(maxlen=self._onset_frames + 2)
        self._ends: deque[bool] = deque(maxlen=self._hangover_frames)
        self._speaking = False
        self._quiet_frames = 0

    @property
    def quiet_frames(self) -> int:
        """How many frames ago speech was last heard."""
        return self._quiet_frames

    def take(self, frame: bytes) -> Edge | None:
        """Take the next frame, `FRAME_SAMPLES` of PCM16."""
        speech = self._floor.above(band_levels_db(frame)) > self._margin_db
        self._quiet_frames = 0 if speech else self._quiet_frames + 1
        self._begins.append(speech)
        self._ends.append(speech)
        if not self._speaking and sum(self._begins) >= self._onset_frames:
            self._speaking = True
            return Edge.BEGAN
        # One click in the pause does not make it longer.
        if self._speaking and len(self._ends) == self._hangover_frames and sum(self._ends) <= 1:
            self.interrupt()
            return Edge.ENDED
        return None

    def interrupt(self) -> None:
        """Forget an utterance that was going on; the noise floor stays."""
        self._speaking = False
        self._begins.clear()
        self._ends.clear()


_WINDOW = np.hanning(FRAME_SAMPLES)
_FIRST_BINS = [round(edge * FRAME_SAMPLES / SAMPLE_RATE_HZ) for edge in BAND_EDGES_HZ]


def band_levels_db(frame: bytes) -> Levels:
    """How loud a frame is in each band, in decibels below full scale."""
    samples = np.frombuffer(frame, np.int16) / 32768.0
    power = np.abs(np.fft.rfft(samples * _WINDOW)) ** 2 / FRAME_SAMPLES
    bands = np.add.reduceat(power, _FIRST_BINS)[:-1]
    levels_db: Levels = np.maximum(QUIETEST_DB, 10 * np.log10(bands + 1e-12))
    return levels_db


def level_db(frame: bytes) -> float:
    """How loud a frame is, in decibels below full scale."""
    samples = np.frombuffer(frame, np.int16) / 32768.0
    return max(QUIETEST_DB, float(10 * np.log10(np.mean(samples**2) + 1e-12)))
