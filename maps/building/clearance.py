"""How near walls come to where robots drive."""

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.building import Floor, Lane

Matrix = NDArray[np.float64]
Point = tuple[float, float]

_STEP_M = 0.05


def distances_m(points: Matrix, segments: Matrix) -> Matrix:
    """How far each point (n, 2) is from the nearest of segments (m, 4); inf where there is none."""
    if not len(segments):
        return np.full(len(points), np.inf)
    return np.asarray(apart_m(points, segments).min(axis=1))


def apart_m(points: Matrix, segments: Matrix) -> Matrix:
    """How far each point (n, 2) is from each segment (m, 4), as (n, m)."""
    start, along = segments[:, :2], segments[:, 2:] - segments[:, :2]
    offset = points[:, None] - start
    lengths = np.maximum((along**2).sum(axis=1), 1e-12)
    share = np.clip((offset * along).sum(axis=2) / lengths, 0.0, 1.0)
    away = offset - share[..., None] * along
    return np.asarray(np.hypot(away[..., 0], away[..., 1]))


def clearance_m(start: Point, end: Point, segments: Matrix) -> float:
    """How near the nearest of segments (m, 4) comes to a straight way; inf where there is none."""
    a, b = np.array(start), np.array(end)
    steps = max(2, int(np.hypot(*(b - a)) / _STEP_M) + 1)
    points = a + np.linspace(0.0, 1.0, steps)[:, None] * (b - a)
    return float(distances_m(points, segments).min())


def lane_clearance_m(floor: Floor, lane: Lane) -> float:
    """How near a wall of its floor comes to a lane."""
    start, end = ((floor.places[each].x, floor.places[each].y) for each in lane.between)
    return clearance_m(start, end, floor.wall_segments)
