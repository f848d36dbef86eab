"""From ranges to points with normals, in the robot's frame."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.localization.pose import transform, turn
from mend.localization.scan import Scan
from mend.maps.compiled import compiled

Matrix = NDArray[np.float64]

DEFAULT_MIN_RANGE_M = 0.05
DEFAULT_MAX_RANGE_M = 30.0
"""Beyond it a beam's footprint and its spacing say little about a wall's place."""
REACH = 3
"""How many neighbours on either side a normal is fitted to."""
MIN_GAP_M = 0.2
"""Neighbours nearer than this belong to one surface at any range."""
GAP_IN_BEAM_SPACINGS = 5.0
"""Farther away, the gap grows with the beams' spacing: walls seen at a flat angle stay whole."""


@dataclass(frozen=True, slots=True, eq=False)
class ScanPoints:
    """The returns of a scan as points in the robot's frame (metres), in the order of the beams.

    `normals` are unit vectors towards the sensor, or (0, 0) where no surface could be fitted.
    `beams` are the indices into the scan's ranges.
    """

    points: Matrix
    normals: Matrix
    beams: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.points)


def scan_points(
    scan: Scan,
    min_range: float = DEFAULT_MIN_RANGE_M,
    max_range: float = DEFAULT_MAX_RANGE_M,
) -> ScanPoints:
    """The usable returns between two ranges in metres."""
    beams = np.flatnonzero(scan.returns(min_range, max_range)).astype(np.int64)
    ranges = scan.ranges[beams]
    angles = scan.angle_min + beams * scan.angle_increment
    seen = np.column_stack((ranges * np.cos(angles), ranges * np.sin(angles)))
    normals = np.zeros_like(seen)
    fit_normals(seen, beams, scan.angle_increment, normals)
    return ScanPoints(
        transform(scan.sensor_offset, seen),
        turn(float(scan.sensor_offset[2]), normals),
        beams,
    )


@compiled
def fit_normals(
    points: Matrix, beams: NDArray[np.int64], increment: float, normals: Matrix
) -> None:
    """Fit a line around each point: to both sides, or to one where that fits better (corners)."""
    count = points.shape[0]
    for middle in range(count):
        span = np.hypot(points[middle, 0], points[middle, 1]) * increment
        gap = max(MIN_GAP_M, GAP_IN_BEAM_SPACINGS * span)
        first = middle
        while first > 0 and middle - first < REACH and _joined(points, beams, first - 1, gap):
            first -= 1
        last = middle
        while last < count - 1 and last - middle < REACH and _joined(points, beams, last, gap):
            last += 1
        best = np.inf
        for side in range(3):
            start = middle if side == 1 else first
            stop = middle if side == 2 else last
            if stop - start < 2 and not (side == 0 and stop > start):
                continue
            spread, nx, ny = _line(points, start, stop)
            # One-sided fits have fewer points, so they must be clearly better to be believed.
            if side > 0:
                spread = spread * 2.0 + 1e-4
            if spread < best:
                best = spread
                normals[middle, 0], normals[middle, 1] = nx, ny
        if normals[middle, 0] * points[middle, 0] + normals[middle, 1] * points[middle, 1] > 0.0:
            normals[middle, 0], normals[middle, 1] = -normals[middle, 0], -normals[middle, 1]


@compiled
def _joined(points: Matrix, beams: NDArray[np.int64], first: int, gap: float) -> bool:
    """Whether a point and the next lie on one surface, going by their distance."""
    apart = np.hypot(
        points[first + 1, 0] - points[first, 0], points[first + 1, 1] - points[first, 1]
    )
    return bool(apart < gap and beams[first + 1] - beams[first] <= 2)


@compiled
def _line(points: Matrix, first: int, last: int) -> tuple[float, float, float]:
    """Mean squared distance (m^2) from the best line through points, and the line's normal."""
    count = last - first + 1
    mx, my = 0.0, 0.0
    for index in range(first, last + 1):
        mx += points[index, 0]
        my += points[index, 1]
    mx /= count
    my /= count
    xx, xy, yy = 0.0, 0.0, 0.0
    for index in range(first, last + 1):
        dx, dy = points[index, 0] - mx, points[index, 1] - my
        xx += dx * dx
        xy += dx * dy
        yy += dy * dy
    angle = 0.5 * np.arctan2(2.0 * xy, xx - yy)
    nx, ny = -np.sin(angle), np.cos(angle)
    spread = (nx * nx * xx + 2.0 * nx * ny * xy + ny * ny * yy) / max(count - 2, 1)
    return max(spread, 0.0), nx, ny
