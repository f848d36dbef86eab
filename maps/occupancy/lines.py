"""The walls of an occupancy grid as line segments.

Contours of what is occupied (Suzuki and Abe 1985) are split where they bend, by Douglas and Peucker
(1973); each part gets the line that fits its cells best (total least squares). A wall one or two
cells thick has a contour on either side: what lies on one line is merged by the lengths' weights
(as Tavares and Padilha 1995 merge edge segments). Faces farther apart stay two walls.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import radians

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.maps.occupancy.grid import OccupancyGrid
from mend.maps.vector_map import VectorMap

Matrix = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class LineSettings:
    """In cells, so that they hold at every resolution."""

    bend_cells: float = 1.5
    """A contour that stays this near a straight line is one: the picture's steps are no corners."""
    apart_cells: float = 1.5
    """The two sides of a wall are this near each other; a wall of three cells has two faces."""
    gap_cells: float = 2.5
    """A wall is one across a gap of up to two cells, which single beams leave."""
    shortest_cells: float = 3.0
    """What is shorter is a speck without a direction."""
    angle_rad: float = radians(8.0)


def lines_of(grid: OccupancyGrid, settings: LineSettings | None = None) -> VectorMap:
    """The vector map of a grid, in the map's frame."""
    its = settings or LineSettings()
    mask = grid.occupied.astype(np.uint8)
    contours, _ = cv2.findContours(mask, cv2.RETR_LIST, cv2.CHAIN_APPROX_NONE)
    walks = [np.asarray(each, dtype=np.int32).reshape(-1, 2) for each in contours]
    found = [part for walk in walks for part in _parts(walk, its)]
    rows = np.array([_fitted(part) for part in found]).reshape(-1, 4)
    merged = _merged(rows, its)
    long_enough = _lengths(merged) >= its.shortest_cells
    places = grid.places(merged[long_enough].reshape(-1, 2, 2))
    return VectorMap(places.reshape(-1, 4), grid.name)


def _parts(contour: NDArray[np.int32], its: LineSettings) -> Iterator[Matrix]:
    """The cells of a closed contour between its corners."""
    if len(contour) < its.shortest_cells:
        return
    bends = cv2.approxPolyDP(contour.reshape(-1, 1, 2), its.bend_cells, True)
    corners = _numbers(contour, np.asarray(bends, dtype=np.int32).reshape(-1, 2))
    for first, last in zip(corners, [*corners[1:], corners[0] + len(contour)], strict=True):
        if last - first >= its.shortest_cells:
            yield contour[np.arange(first, last + 1) % len(contour)].astype(np.float64)


def _numbers(contour: NDArray[np.int32], bends: NDArray[np.int32]) -> list[int]:
    """Where along a contour its corners are, in order; it may pass through a cell twice."""
    numbers: list[int] = []
    for bend in bends:
        at = np.flatnonzero((contour == bend).all(axis=1))
        later = at[at > numbers[-1]] if numbers else at
        numbers.append(int(later[0]) if len(later) else int(at[0]))
    return sorted(set(numbers))


def _fitted(cells: Matrix) -> Matrix:
    """The segment x0, y0, x1, y1 along cells, by total least squares."""
    middle = cells.mean(axis=0)
    away = cells - middle
    _, axes = np.linalg.eigh(away.T @ away)
    reach = away @ axes[:, 1]
    return np.concatenate((middle + reach.min() * axes[:, 1], middle + reach.max() * axes[:, 1]))


def _merged(rows: Matrix, its: LineSettings) -> Matrix:
    """Each wall once, from the longest segment on."""
    rows = rows[np.argsort(-_lengths(rows), kind="stable")]
    left = np.ones(len(rows), dtype=bool)
    kept: list[Matrix] = []
    for number in range(len(rows)):
        if left[number]:
            group = _on_line(rows, left, number, its)
            left[group] = False
            kept.append(_mean(rows[group]))
    return np.array(kept).reshape(-1, 4)


def _on_line(
    rows: Matrix, left: NDArray[np.bool_], number: int, its: LineSettings
) -> NDArray[np.int64]:
    """A segment and those left that lie on its line and, one after the other, touch it."""
    start = rows[number, :2]
    length = float(_lengths(rows[number : number + 1])[0])
    along = (rows[number, 2:] - start) / max(length, 1e-9)
    others = np.flatnonzero(left)
    ends = rows[others].reshape(-1, 2, 2) - start
    off = ends @ np.array([-along[1], along[0]])
    reach = np.sort(ends @ along, axis=1)
    slanted = np.abs(off[:, 0] - off[:, 1]) > np.sin(its.angle_rad) * _lengths(rows[others]) + 1e-6
    near = (np.abs(off) <= its.apart_cells).all(axis=1) & ~slanted
    others, reach = others[near], reach[near]
    first, last = 0.0, length
    taken = np.zeros(len(others), dtype=bool)
    while True:
        touching = (reach[:, 0] <= last + its.gap_cells) & (reach[:, 1] >= first - its.gap_cells)
        if not (touching & ~taken).any():
            break
        taken |= touching
        first = min(first, float(reach[taken, 0].min()))
        last = max(last, float(reach[taken, 1].max()))
    group: NDArray[np.int64] = others[taken]
    return group


def _mean(rows: Matrix) -> Matrix:
    """One segment for several on a line, each counting by its length."""
    lengths = _lengths(rows)
    spans = rows[:, 2:] - rows[:, :2]
    middles = (rows[:, :2] + rows[:, 2:]) / 2.0
    middle = np.average(middles, axis=0, weights=lengths)
    away = middles - middle
    scatter = (away * lengths[:, None]).T @ away + (spans * (lengths / 12.0)[:, None]).T @ spans
    _, axes = np.linalg.eigh(scatter)
    reach = (rows.reshape(-1, 2) - middle) @ axes[:, 1]
    return np.concatenate((middle + reach.min() * axes[:, 1], middle + reach.max() * axes[:, 1]))


def _lengths(rows: Matrix) -> Matrix:
    spans = rows[:, 2:] - rows[:, :2]
    lengths: Matrix = np.hypot(spans[:, 0], spans[:, 1])
    return lengths
