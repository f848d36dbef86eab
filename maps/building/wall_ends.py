"""The ends of walls: plans draw walls as lines, which nobody sees who stands in line with them."""

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.clearance import apart_m

Matrix = NDArray[np.float64]

_JOINS_M = 0.02
"""An end that is no farther from another wall is joined to it."""


def wall_ends(walls: Matrix, thick_m: float) -> Matrix:
    """Across each end of walls (n, 4) that joins no other, as long as walls are thick (m, 4)."""
    lengths_m = np.hypot(walls[:, 2] - walls[:, 0], walls[:, 3] - walls[:, 1])
    drawn = walls[lengths_m > 1e-9]
    if not len(drawn):
        return np.zeros((0, 4))
    along = (drawn[:, 2:] - drawn[:, :2]) / lengths_m[lengths_m > 1e-9][:, None]
    across = np.column_stack([-along[:, 1], along[:, 0]]) * thick_m / 2.0
    ends = []
    for points in (drawn[:, :2], drawn[:, 2:]):
        away_m = apart_m(points, drawn)
        np.fill_diagonal(away_m, np.inf)
        free = away_m.min(axis=1) > _JOINS_M
        ends.append(np.hstack([points - across, points + across])[free])
    return np.concatenate(ends)
