"""A made-up robot's way: through rooms and corridors, a pose every few centimetres."""

import numpy as np
from numpy.typing import NDArray

from mend.localization.pose import Poses, wrap
from synthetic.free_space import FreeSpace

_SMOOTHING = 9
"""Cells over which the way is smoothed."""
_HEADING_SMOOTHING_M = 1.0


def drive(
    space: FreeSpace, length_m: float, step_m: float, generator: np.random.Generator
) -> Poses:
    """Poses (n, 3) along a way from one far place to the next, `step_m` apart."""
    cell = int(generator.integers(len(space.centers)))
    cells: list[NDArray[np.int64]] = [np.array([cell])]
    driven = 0.0
    while driven < length_m + step_m:
        leg = space.way(int(cells[-1][-1]), generator)
        cells.append(leg[1:])
        driven += float(np.hypot(*np.diff(space.centers[leg], axis=0).T).sum())
    corners = _smoothed(space.centers[np.concatenate(cells)], _SMOOTHING)
    along = np.r_[0.0, np.cumsum(np.hypot(*np.diff(corners, axis=0).T))]
    stops = np.arange(0.0, min(float(along[-1]), length_m), step_m)
    places = np.column_stack([np.interp(stops, along, corners[:, axis]) for axis in range(2)])
    ahead = np.gradient(places, axis=0)
    window = max(int(_HEADING_SMOOTHING_M / step_m) | 1, 3)
    heading = _smoothed(np.unwrap(np.arctan2(ahead[:, 1], ahead[:, 0]))[:, None], window)
    return np.column_stack((places, wrap(heading[:, 0])))


def _smoothed(values: NDArray[np.float64], window: int) -> NDArray[np.float64]:
    """The running mean of each column, as long as before."""
    half = window // 2
    padded = np.pad(values, ((half, half), (0, 0)), mode="edge")
    kernel = np.ones(2 * half + 1) / (2 * half + 1)
    return np.column_stack(
        [np.convolve(padded[:, column], kernel, "valid") for column in range(values.shape[1])]
    )
