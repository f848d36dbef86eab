"""What is seen first on a map that does not change: rays that walk over a grid of its segments.

Amanatides and Woo (1987), "A fast voxel traversal algorithm for ray tracing". Once a map is laid
out, a ray costs what lies along it, whatever the size of the map; for segments that move, or are
looked at from one place only, the sweep of `ray_cast` is the cheaper one.
"""

from math import inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mend.maps.compiled import compiled
from mend.maps.ray_cast import NOTHING

Matrix = NDArray[np.float64]
Indices = NDArray[np.int64]
Numbers = NDArray[np.int32]

_CELL_M = 0.5
_MOST_CELLS = 1_000_000
"""Larger maps have larger cells."""
_SLACK_M = 1e-9
"""By how much a segment is widened, so that no ray slips through a shared corner."""
_MARGIN = 1e-6
"""In cells: a segment this near to a cell is looked at there, too."""
_EDGE_ON = 1e-12
"""Square metres (twice the triangle's area) below which a segment is seen edge on: invisible."""


class SegmentGrid(NamedTuple):
    """Segments (n, 4) by the cells that they touch; kernels take it as it is."""

    segments: Matrix
    origin: Matrix
    cell_m: float
    starts: Numbers
    """Rows by columns and one more: where each cell's numbers begin..."""
    numbers: Numbers
    """... and the numbers of the segments that touch it."""
    columns: int
    rows: int


def segment_grid(segments: Matrix) -> SegmentGrid:
    """Lay the segments of a map out."""
    segments = np.ascontiguousarray(segments, dtype=np.float64).reshape(-1, 4)
    if not len(segments):
        nothing = np.zeros(2, dtype=np.int32)
        return SegmentGrid(segments, np.zeros(2), _CELL_M, nothing, nothing[:0], 1, 1)
    ends = segments.reshape(-1, 2)
    low, span = ends.min(axis=0), np.ptp(ends, axis=0)
    cell_m = max(_CELL_M, float(np.sqrt(span.prod() / _MOST_CELLS)), float(span.max()) / 30_000)
    origin = low - cell_m
    columns, rows = (int(size) for size in np.ceil(span / cell_m) + 2)
    counts = np.zeros(rows * columns + 1, dtype=np.int32)
    nowhere = np.zeros(0, dtype=np.int32)
    lay_out(segments, origin, cell_m, columns, counts[1:], nowhere)
    starts = np.cumsum(counts, dtype=np.int32)
    numbers = np.zeros(starts[-1], dtype=np.int32)
    lay_out(segments, origin, cell_m, columns, starts[:-1].copy(), numbers)
    return SegmentGrid(segments, origin, cell_m, starts, numbers, columns, rows)


@compiled
def lay_out(
    segments: Matrix,
    origin: Matrix,
    cell_m: float,
    columns: int,
    next_of: Numbers,
    numbers: Numbers,
) -> None:
    """Write each segment's number to the cells that it touches, or count where there are none.

    `next_of` is where each cell's next number belongs, and counts on.
    """
    for number in range(segments.shape[0]):
        x0 = (segments[number, 0] - origin[0]) / cell_m
        y0 = (segments[number, 1] - origin[1]) / cell_m
        x1 = (segments[number, 2] - origin[0]) / cell_m
        y1 = (segments[number, 3] - origin[1]) / cell_m
        if y0 > y1:
            x0, y0, x1, y1 = x1, y1, x0, y0
        for row in range(int(y0 - _MARGIN), int(y1 + _MARGIN) + 1):
            low, high = 0.0, 1.0
            if y1 - y0 > _MARGIN:
                low = max((row - _MARGIN - y0) / (y1 - y0), 0.0)
                high = min((row + 1.0 + _MARGIN - y0) / (y1 - y0), 1.0)
            one, other = x0 + low * (x1 - x0), x0 + high * (x1 - x0)
            first, last = min(one, other) - _MARGIN, max(one, other) + _MARGIN
            for column in range(int(first), int(last) + 1):
                cell = row * columns + column
                if numbers.shape[0] > 0:
                    numbers[next_of[cell]] = number
                next_of[cell] += 1


@compiled
def cast_rays(
    grid: SegmentGrid,
    sensor: Matrix,
    bearings: Matrix,
    max_range_m: float,
    ranges_m: Matrix,
    seen: Indices,
) -> None:
    """Range and segment of the first thing along each bearing from a sensor's pose.

    Results go to the last two; where nothing is within reach, `max_range_m` and `NOTHING`.
    """
    for ray in range(bearings.shape[0]):
        angle = bearings[ray] + sensor[2]
        ranges_m[ray], seen[ray] = cast_ray(
            grid, sensor[0], sensor[1], np.cos(angle), np.sin(angle), max_range_m
        )


@compiled
def cast_ray(
    grid: SegmentGrid, x: float, y: float, c: float, s: float, max_range_m: float
) -> tuple[float, int]:
    """Range and segment of the first thing from (x, y) along (c, s)."""
    best, which = max_range_m, NOTHING
    # Where the ray enters the grid, in cells.
    px, py = (x - grid.origin[0]) / grid.cell_m, (y - grid.origin[1]) / grid.cell_m
    begin, end = _within(px, c, grid.columns, 0.0, max_range_m / grid.cell_m)
    begin, end = _within(py, s, grid.rows, begin, end)
    if begin > end:
        return best, which
    column = min(max(int(px + begin * c), 0), grid.columns - 1)
    row = min(max(int(py + begin * s), 0), grid.rows - 1)
    right, up = (1 if c > 0.0 else -1), (1 if s > 0.0 else -1)
    per_column = abs(1.0 / c) if c != 0.0 else np.inf
    per_row = abs(1.0 / s) if s != 0.0 else np.inf
    to_column = (column + (c > 0.0) - px) / c if c != 0.0 else np.inf
    to_row = (row + (s > 0.0) - py) / s if s != 0.0 else np.inf
    while True:
        cell = row * grid.columns + column
        for at in range(grid.starts[cell], grid.starts[cell + 1]):
            number = grid.numbers[at]
            distance = meet(grid.segments[number], x, y, c, s)
            if 0.0 < distance < best:
                best, which = distance, number
        leaves = min(to_column, to_row)
        if best <= leaves * grid.cell_m:
            return best, which
        if to_column < to_row:
            column += right
            to_column += per_column
        else:
            row += up
            to_row += per_row
        if column < 0 or column >= grid.columns or row < 0 or row >= grid.rows:
            return best, which


@compiled
def _within(start: float, step: float, size: int, begin: float, end: float) -> tuple[float, float]:
    """From where to where on the way from `begin` to `end` a ray is between 0 and a size."""
    if step == 0.0:
        return (begin, end) if 0.0 <= start <= size else (1.0, 0.0)
    enters, leaves = -start / step, (size - start) / step
    return max(begin, min(enters, leaves)), min(end, max(enters, leaves))


@compiled
def meet(segment: Matrix, x: float, y: float, c: float, s: float) -> float:
    """How far along (c, s) from (x, y) a segment is; infinite where they do not meet."""
    x0, y0, x1, y1 = segment[0] - x, segment[1] - y, segment[2] - x, segment[3] - y
    area = x0 * y1 - y0 * x1
    if area < 0.0:
        x0, y0, x1, y1, area = x1, y1, x0, y0, -area
    aside0, aside1 = c * y0 - s * x0, c * y1 - s * x1
    across = aside1 - aside0
    if area < _EDGE_ON or aside0 > _SLACK_M or aside1 < -_SLACK_M or across <= 0.0:
        return inf
    return float(area / across)
