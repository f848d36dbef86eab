"""Which range of a log stands for "nothing came back": scanners write it as a large number."""

from collections.abc import Iterable, Sequence

import numpy as np

_NEAR_LARGEST = 0.97
"""Scanners write one of a few numbers near the largest, as error codes."""
_LARGE_M = 40.0
"""Below it the largest range may well be a wall."""


def no_return_range(sweeps: Iterable[Sequence[float]]) -> float:
    """The range in metres from which on nothing came back."""
    largest = 0.0
    for ranges in sweeps:
        values = np.asarray(ranges, dtype=np.float64)
        finite = values[np.isfinite(values)]
        if len(finite):
            largest = max(largest, float(finite.max()))
    return largest * _NEAR_LARGEST if largest > _LARGE_M else max(largest, 1e-3) * 1.001
