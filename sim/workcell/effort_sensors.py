"""What the joints' effort sensors tell: the motors' torques, with noise and a drifting bias."""

import math

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]

ARM_NOISE_NM: Vector = np.array([0.8, 0.8, 0.5, 0.5, 0.2, 0.2, 0.1])
"""Standard deviation of one reading, from the shoulder to the wrist."""

_BIAS_SHARE = 0.5
"""Standard deviation of the bias, as a share of that of the noise."""
_BIAS_LASTS_S = 20.0

FINGER_NOISE_N = 1.5
ENCODER_NOISE_M = 0.0002
"""Of the distance between the finger tips."""


class EffortSensors:
    """The arm's seven; the bias is an Ornstein-Uhlenbeck process."""

    def __init__(self, rng: np.random.Generator, period_s: float) -> None:
        self._rng = rng
        self._bias = _BIAS_SHARE * ARM_NOISE_NM * rng.standard_normal(len(ARM_NOISE_NM))
        self._kept = math.exp(-period_s / _BIAS_LASTS_S)
        self._wander: Vector = math.sqrt(1.0 - self._kept**2) * _BIAS_SHARE * ARM_NOISE_NM

    def read(self, torques_nm: Vector) -> Vector:
        """One reading of the torques that really act."""
        wander, noise = self._rng.standard_normal((2, len(ARM_NOISE_NM)))
        self._bias = self._kept * self._bias + self._wander * wander
        return np.asarray(torques_nm + self._bias + ARM_NOISE_NM * noise)
