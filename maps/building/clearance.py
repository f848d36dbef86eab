"""How near walls come to where robots drive."""

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.building import Floor, Lane

Matrix = NDArray[np.float64]
Point = tuple[float, float]

_STEP_M = 0.05
_ROUNDING_M = 1e-9


def distances_m(points: Matrix, segments: Matrix) -> Matrix:
    """How far each point (n, 2) is from the nearest of segments (m, 4); inf where there is none."""
    if not len(segments):
        return np.full(len(points), np.inf)
    return np.asarray(apart_m(points, segments).min(axis=1))


def apart_m(points: Matrix, segments: Matrix) -> Matrix:
    """How far each point (n, 2) is from each segment (m, 4), as (n, m)."""
    # One array for each coordinate: sums over a last axis of two take several times as long.
    x0, y0, x1, y1 = segments.T
    along_x, along_y = x1 - x0, y1 - y0
    lengths = np.maximum(along_x**2 + along_y**2, 1e-12)
    off_x, off_y = points[:, :1] - x0, points[:, 1:] - y0
    share = np.minimum(np.maximum((off_x * along_x + off_y * along_y) / lengths, 0.0), 1.0)
    return np.asarray(np.hypot(off_x - share * along_x, off_y - share * along_y))


def clearance_m(start: Point, end: Point, segments: Matrix) -> float:
    """How near the nearest of segments (m, 4) comes to a straight way; inf where there is none."""
    a, b = np.array(start), np.array(end)
    steps = max(2, int(np.hypot(*(b - a)) / _STEP_M) + 1)
    points = a + np.linspace(0.0, 1.0, steps)[:, None] * (b - a)
    return float(distances_m(points, segments).min())


def is_clear(start: Point, end: Point, segments: Matrix, needs_m: float) -> bool:
    """Whether all segments (m, 4) keep `needs_m` from a straight way."""
    x0, y0, x1, y1 = segments.T
    reach_m = needs_m + _ROUNDING_M
    beside = np.minimum(x0, x1) > max(start[0], end[0]) + reach_m
    beside |= np.maximum(x0, x1) < min(start[0], end[0]) - reach_m
    beside |= np.minimum(y0, y1) > max(start[1], end[1]) + reach_m
    beside |= np.maximum(y0, y1) < min(start[1], end[1]) - reach_m
    near = segments[~beside]
    return not len(near) or clearance_m(start, end, near) >= needs_m


def lane_clearance_m(floor: Floor, lane: Lane) -> float:
    """How near a wall of its floor comes to a lane."""
    start, end = ((floor.places[each].x, floor.places[each].y) for each in lane.between)
    return clearance_m(start, end, floor.wall_segments)
