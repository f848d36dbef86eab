"""What changes from picture to picture and from day to day: light, exposure and sensor noise."""

import numpy as np
from numpy.typing import NDArray

from sim.raster import Light

_DIRECTION = (0.6, -0.4, 2.0)
_AMBIENT = 0.60
_DIFFUSE = 0.35

_DIRECTION_SPREAD = 1.0
_AMBIENT_SPREAD = 0.10
_DIFFUSE_SPREAD = 0.15
_EXPOSURE_SPREAD = 0.25
_FLICKER_SPREAD = 0.04
"""How far these may vary when the option `light` is 1."""


class Lighting:
    """The light of one world and the noise of its cameras, by seed.

    `variation` in [0, 1] says how far the light's direction and strengths and the exposure may
    be from the usual, and how much the exposure flickers from picture to picture. `noise` is the
    standard deviation of each channel in grey levels of 255.
    """

    def __init__(self, variation: float, noise: float, rng: np.random.Generator) -> None:
        self._rng = rng
        self._noise = noise
        self._flicker = _FLICKER_SPREAD * variation
        dx, dy, ambient, diffuse, exposure = rng.uniform(-1.0, 1.0, 5) * variation
        self.light = Light(
            direction=(
                _DIRECTION[0] + _DIRECTION_SPREAD * dx,
                _DIRECTION[1] + _DIRECTION_SPREAD * dy,
                _DIRECTION[2],
            ),
            ambient=_AMBIENT + _AMBIENT_SPREAD * ambient,
            diffuse=_DIFFUSE + _DIFFUSE_SPREAD * diffuse,
        )
        self._exposure = 1.0 + _EXPOSURE_SPREAD * exposure

    def expose(self, bgr: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """A rendered picture as the camera's sensor would give it."""
        gain = self._exposure
        if self._flicker > 0.0:
            gain *= 1.0 + self._rng.uniform(-self._flicker, self._flicker)
        if gain == 1.0 and self._noise == 0.0:
            return bgr
        exposed = bgr.astype(np.float32) * np.float32(gain)
        if self._noise > 0.0:
            exposed += self._noise * self._rng.standard_normal(bgr.shape, dtype=np.float32)
        return np.asarray(np.clip(exposed, 0.0, 255.0), dtype=np.uint8)
