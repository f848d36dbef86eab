"""What a laser makes of true ranges: each a little off, and some that never come back."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class LaserNoise:
    """As of the laser scanners that robots of this kind have.

    `std_m`: of each range; `missing`: the share of beams that do not come back.
    """

    std_m: float = 0.01
    missing: float = 0.005


NOISE = LaserNoise()
_NEAREST_M = 0.02


def measured_m(ranges_m: Matrix, rng: np.random.Generator, noise: LaserNoise = NOISE) -> Matrix:
    """What is measured of true ranges; inf where nothing comes back."""
    off_m = noise.std_m * rng.standard_normal(len(ranges_m))
    lost = rng.random(len(ranges_m)) < noise.missing
    return np.where(lost, np.inf, np.maximum(ranges_m + off_m, _NEAREST_M))
