"""What stands in a courtyard, and what a laser sees of it: walls, and round things."""

import numpy as np
from numpy.typing import NDArray

HALF_M = 6.0
"""The courtyard is a square around the middle; its walls are so far from there."""
REACH_M = 8.0

Circle = tuple[float, float, float]
"""x, y, radius (metres)."""


def ranges_m(
    at: tuple[float, float], bearings: NDArray[np.float64], circles: list[Circle]
) -> NDArray[np.float64]:
    """How far the next thing is along each bearing (n,); inf beyond the laser's reach."""
    along = np.stack([np.cos(bearings), np.sin(bearings)])
    nearest = _to_walls(at, along)
    for x, y, radius in circles:
        offset = np.array([x - at[0], y - at[1]])
        middle = offset @ along
        behind = radius**2 - (offset @ offset - middle**2)
        hit = middle - np.sqrt(np.maximum(behind, 0.0))
        nearest = np.where((behind > 0.0) & (hit > 0.0), np.minimum(nearest, hit), nearest)
    return np.where(nearest <= REACH_M, nearest, np.inf)


def _to_walls(at: tuple[float, float], along: NDArray[np.float64]) -> NDArray[np.float64]:
    here = np.array(at)[:, None]
    with np.errstate(divide="ignore"):
        return np.min(np.abs(np.where(along > 0, HALF_M - here, -HALF_M - here) / along), axis=0)
