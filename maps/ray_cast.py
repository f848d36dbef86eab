"""Analytic ray cast: what is seen first along each ray from a point, with no grid between."""

import numpy as np
from numpy.typing import NDArray

from mend.maps.compiled import compiled

Matrix = NDArray[np.float64]
Indices = NDArray[np.int64]

NOTHING = -1
"""The segment index of a ray that meets nothing within its range."""
_SPAN_SLACK = 1e-12
"""Radians by which a segment is widened, so that no ray slips through a shared corner."""
_EDGE_ON = 1e-12
"""Square metres (twice the triangle's area) below which a segment is seen edge on: invisible."""


def cast(
    segments: Matrix, x: float, y: float, angles: Matrix, max_range: float
) -> tuple[Matrix, Indices]:
    """Range and segment index of the first thing along each ray from (x, y).

    `angles` are radians in the map's frame, in any order. Where nothing is hit within
    `max_range` metres, the range is `max_range` and the index is `NOTHING`.
    """
    order, turned = _ascending(angles)
    ranges = np.empty(len(turned))
    indices = np.empty(len(turned), dtype=np.int64)
    cast_sorted(segments, x, y, turned, max_range, ranges, indices)
    found_ranges, found_indices = np.empty_like(ranges), np.empty_like(indices)
    found_ranges[order], found_indices[order] = ranges, indices
    return found_ranges, found_indices


def cast_from_each(segments: Matrix, points: Matrix, angles: Matrix, max_range: float) -> Matrix:
    """The ranges (n, m) of `cast` from each of points (n, 2) along `angles` (m,)."""
    order, turned = _ascending(angles)
    ranges = np.empty((len(points), len(turned)))
    _cast_each_sorted(segments, points, turned, max_range, ranges)
    found = np.empty_like(ranges)
    found[:, order] = ranges
    return found


def _ascending(angles: Matrix) -> tuple[Indices, Matrix]:
    """In which order they ascend within [0, 2 pi), and they in that order."""
    wrapped = np.mod(angles, 2.0 * np.pi)
    order = np.argsort(wrapped, kind="stable")
    return order, np.ascontiguousarray(wrapped[order])


@compiled
def cast_sorted(
    segments: Matrix,
    x: float,
    y: float,
    angles: Matrix,
    max_range: float,
    ranges: Matrix,
    indices: Indices,
) -> None:
    """The kernel of `cast`: `angles` ascending within [0, 2 pi); results go to the last two."""
    count = angles.shape[0]
    cosines, sines = np.cos(angles), np.sin(angles)
    for ray in range(count):
        ranges[ray] = max_range
        indices[ray] = NOTHING
    if count == 0:
        return
    full = 2.0 * np.pi
    for number in range(segments.shape[0]):
        x0, y0 = segments[number, 0] - x, segments[number, 1] - y
        x1, y1 = segments[number, 2] - x, segments[number, 3] - y
        if (
            (x0 > max_range and x1 > max_range)
            or (x0 < -max_range and x1 < -max_range)
            or (y0 > max_range and y1 > max_range)
            or (y0 < -max_range and y1 < -max_range)
        ):
            continue
        area = x0 * y1 - y0 * x1
        if area < 0.0:
            x0, y0, x1, y1, area = x1, y1, x0, y0, -area
        if area < _EDGE_ON:
            continue
        start = np.arctan2(y0, x0) - _SPAN_SLACK
        span = np.arctan2(area, x0 * x1 + y0 * y1) + 2.0 * _SPAN_SLACK
        if start < 0.0:
            start += full
        ex, ey = x1 - x0, y1 - y0
        # The first ray at or after the start of the span.
        low, high = 0, count
        while low < high:
            middle = (low + high) // 2
            if angles[middle] < start:
                low = middle + 1
            else:
                high = middle
        turn = 0.0
        for _ in range(count):
            if low == count:
                low = 0
                turn = full
            if angles[low] + turn > start + span:
                break
            across = cosines[low] * ey - sines[low] * ex
            if across > 0.0:
                distance = area / across
                if distance < ranges[low]:
                    ranges[low] = distance
                    indices[low] = number
            low += 1


@compiled
def _cast_each_sorted(
    segments: Matrix, points: Matrix, angles: Matrix, max_range: float, ranges: Matrix
) -> None:
    """The kernel of `cast_from_each`; results go to the last."""
    indices = np.empty(angles.shape[0], np.int64)
    for number in range(points.shape[0]):
        x, y = points[number, 0], points[number, 1]
        cast_sorted(segments, x, y, angles, max_range, ranges[number], indices)
