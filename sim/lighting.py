"""What changes from picture to picture and from day to day: light, exposure and sensor noise."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.sim.raster import Light

_DIRECTION_SPREAD = 1.0
_AMBIENT_SPREAD = 0.10
_DIFFUSE_SPREAD = 0.15
_EXPOSURE_SPREAD = 0.25
_FLICKER_SPREAD = 0.04
"""How far these may vary when the option `light` is 1."""

_DRIFT_SHARE = 0.3
"""So much of the variation comes and goes during a run, the rest is the seed's."""
_SLOWEST_DRIFT_S, _FASTEST_DRIFT_S = 240.0, 40.0


@dataclass(frozen=True, slots=True)
class _Varying:
    """A quantity in [-1, 1]: its share that stays, and one that swings, by the world's clock."""

    steady: float
    phase: float
    period_s: float

    def at(self, time_s: float) -> float:
        swing = math.sin(2 * math.pi * time_s / self.period_s + self.phase)
        return (1.0 - _DRIFT_SHARE) * self.steady + _DRIFT_SHARE * swing


class Lighting:
    """The light of one world and the colour noise of its cameras, by seed.

    `usual` is the light that `variation` in [0, 1] departs from: in direction, strengths and
    exposure, by the seed and slowly with time, and by a flicker from picture to picture. `noise`
    is the standard deviation of each channel in grey levels of 255.
    """

    def __init__(
        self, usual: Light, variation: float, noise: float, rng: np.random.Generator
    ) -> None:
        self._usual = usual
        self._variation = variation
        self._noise = noise
        self._rng = rng
        self._varying = [
            _Varying(
                float(rng.uniform(-1.0, 1.0)),
                float(rng.uniform(0.0, 2 * math.pi)),
                float(rng.uniform(_FASTEST_DRIFT_S, _SLOWEST_DRIFT_S)),
            )
            for _ in range(5)
        ]

    def light_at(self, time_s: float) -> Light:
        """The light at a time of the world's clock."""
        dx, dy, ambient, diffuse, _ = self._departures(time_s)
        x, y, z = self._usual.direction
        return Light(
            direction=(x + _DIRECTION_SPREAD * dx, y + _DIRECTION_SPREAD * dy, z),
            ambient=self._usual.ambient + _AMBIENT_SPREAD * ambient,
            diffuse=self._usual.diffuse + _DIFFUSE_SPREAD * diffuse,
        )

    def expose(self, bgr: NDArray[np.uint8], time_s: float) -> NDArray[np.uint8]:
        """A rendered picture as the camera's sensor would give it."""
        gain = 1.0 + _EXPOSURE_SPREAD * self._departures(time_s)[4]
        if self._variation > 0.0:
            flicker = _FLICKER_SPREAD * self._variation
            gain *= 1.0 + self._rng.uniform(-flicker, flicker)
        if gain == 1.0 and self._noise == 0.0:
            return bgr
        exposed = bgr.astype(np.float32) * np.float32(gain)
        if self._noise > 0.0:
            exposed += self._noise * self._rng.standard_normal(bgr.shape, dtype=np.float32)
        return np.asarray(np.clip(np.rint(exposed), 0.0, 255.0), dtype=np.uint8)

    def _departures(self, time_s: float) -> list[float]:
        return [each.at(time_s) * self._variation for each in self._varying]
