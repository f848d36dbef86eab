"""How near walls come to where robots drive."""

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.building import Floor, Lane

Matrix = NDArray[np.float64]

_STEP_M = 0.05


def distances_m(points: Matrix, segments: Matrix) -> Matrix:
    """How far each point (n, 2) is from the nearest of segments (m, 4); inf where there is none."""
    if not len(segments):
        return np.full(len(points), np.inf)
    start, along = segments[:, :2], segments[:, 2:] - segments[:, :2]
    offset = points[:, None] - start
    lengths = np.maximum((along**2).sum(axis=1), 1e-12)
    share = np.clip((offset * along).sum(axis=2) / lengths, 0.0, 1.0)
    away = offset - share[..., None] * along
    return np.asarray(np.hypot(away[..., 0], away[..., 1]).min(axis=1))


def lane_clearance_m(floor: Floor, lane: Lane) -> float:
    """How near a wall of its floor comes to a lane."""
    walls = np.array(floor.walls, np.float64).reshape(-1, 4)
    a, b = (np.array([floor.places[each].x, floor.places[each].y]) for each in lane.between)
    steps = max(2, int(np.hypot(*(b - a)) / _STEP_M) + 1)
    points = a + np.linspace(0.0, 1.0, steps)[:, None] * (b - a)
    return float(distances_m(points, walls).min())
