"""The space of a floor around a point, in cells, and the ways through it."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from mend.maps.building.clearance import is_clear

Point = tuple[float, float]
Matrix = NDArray[np.float64]
Mask = NDArray[np.bool_]

CELL_M = 0.1
HALF_M = 12.0
"""A grid reaches so far from its middle."""
_SIDE = 2 * round(HALF_M / CELL_M) + 1
_STEPS = ((0, 1), (1, 0), (1, 1), (1, -1))


def sampled(way: Sequence[Point], every_m: float = CELL_M) -> Matrix:
    """Points (n, 2) of a way of straight legs, from its first to its last, about so far apart."""
    corners = np.asarray(way, np.float64).reshape(-1, 2)
    at_m = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(corners, axis=0).T))])
    along_m = np.linspace(0.0, at_m[-1], max(2, math.ceil(at_m[-1] / every_m) + 1))
    return np.column_stack([np.interp(along_m, at_m, each) for each in corners.T])


def straightened(
    start: Point, way: Sequence[Point], segments: Matrix, needs_m: float
) -> list[Point]:
    """The corners of a way through cells, up to its last: segments (n, 4) keep `needs_m` off."""
    corners, here = list[Point](), start
    for number, cell in enumerate(way):
        last = number + 1 == len(way)
        if last or not is_clear(here, way[number + 1], segments, needs_m):
            corners.append(cell)
            here = cell
    return corners


@dataclass(frozen=True, slots=True)
class Reach:
    """How far a robot has to drive to each cell (inf where it does not get), and how it gets there.

    `before` is the number of the cell before each on the shortest way.
    """

    metres: Matrix
    before: NDArray[np.int32]


class FloorGrid:
    """Square cells around `middle`, in metres of the floor's frame."""

    def __init__(self, middle: Point) -> None:
        self._corner = np.asarray(middle, np.float64) - HALF_M
        rows, columns = np.mgrid[0:_SIDE, 0:_SIDE]
        self._middles = self._corner + CELL_M * np.stack([columns, rows], axis=-1)

    def away_from(self, points: Matrix) -> Matrix:
        """How far (m) each cell is from the nearest of points (n, 2); inf where none is inside."""
        cells = np.round((points - self._corner) / CELL_M).astype(np.int64)
        cells = cells[((cells >= 0) & (cells < _SIDE)).all(axis=1)]
        free = np.ones((_SIDE, _SIDE), np.bool_)
        if not len(cells):
            return np.full((_SIDE, _SIDE), math.inf)
        free[cells[:, 1], cells[:, 0]] = False
        return np.asarray(distance_transform_edt(free)) * CELL_M

    def away_from_segments(self, segments: Matrix) -> Matrix:
        """How far (m) each cell is from the nearest of segments (n, 4)."""
        low = np.minimum(segments[:, :2], segments[:, 2:])
        high = np.maximum(segments[:, :2], segments[:, 2:])
        ends = self._corner, self._corner + 2.0 * HALF_M
        near = segments[((high >= ends[0]) & (low <= ends[1])).all(axis=1)]
        points = [sampled([(a, b), (c, d)], CELL_M / 2) for a, b, c, d in near.tolist()]
        return self.away_from(np.concatenate([np.zeros((0, 2)), *points]))

    def away_from_point(self, point: Point) -> Matrix:
        """How far (m) each cell is from a point."""
        return np.asarray(np.hypot(*np.moveaxis(self._middles - point, -1, 0)))

    def at(self, values: Matrix, point: Point) -> float:
        """What a cell's value is at a point; of the nearest cell for one outside."""
        return float(values[self.cell(point)])

    def is_inside(self, point: Point) -> bool:
        """Whether a point is in one of the cells."""
        off = np.abs(np.asarray(point) - self._corner - HALF_M)
        return bool((off <= HALF_M + CELL_M / 2).all())

    def reach(self, start: Point, free: Mask) -> Reach:
        """The shortest ways from a point through free cells, and from the cell that it is in."""
        free = free.copy()
        origin = self.cell(start)
        free[origin] = True
        numbers = np.arange(_SIDE * _SIDE).reshape(_SIDE, _SIDE)
        rows, columns, metres = [], [], []
        for down, right in _STEPS:
            here, there = _shifted(numbers, down, right)
            both = np.logical_and(*_shifted(free, down, right))
            rows.append(here[both])
            columns.append(there[both])
            metres.append(np.full(int(both.sum()), CELL_M * math.hypot(down, right)))
        graph = csr_matrix(
            (np.concatenate(metres), (np.concatenate(rows), np.concatenate(columns))),
            shape=(numbers.size, numbers.size),
        )
        number = int(numbers[origin])
        far_m, before = dijkstra(graph, directed=False, indices=number, return_predecessors=True)
        return Reach(far_m.reshape(_SIDE, _SIDE), before)

    def way(self, reach: Reach, cell: tuple[int, int]) -> list[Point]:
        """The middles of the cells that lead to one that is reached, without the first."""
        number, way = cell[0] * _SIDE + cell[1], list[Point]()
        while reach.before[number] >= 0:
            x, y = self._middles[number // _SIDE, number % _SIDE]
            way.append((float(x), float(y)))
            number = int(reach.before[number])
        return way[::-1]

    def cell(self, point: Point) -> tuple[int, int]:
        """The row and column of the cell that a point is in; the nearest one for one outside."""
        column, row = np.round((np.asarray(point) - self._corner) / CELL_M).astype(int)
        return int(np.clip(row, 0, _SIDE - 1)), int(np.clip(column, 0, _SIDE - 1))


def _shifted(cells: NDArray[np.generic], down: int, right: int) -> tuple[Matrix, Matrix]:
    """Each cell, and the one so far from it, where both are inside."""
    left, beyond = max(0, -right), max(0, right)
    here = cells[: _SIDE - down, left : _SIDE - beyond]
    there = cells[down:, left + right : _SIDE - beyond + right]
    return np.asarray(here), np.asarray(there)
