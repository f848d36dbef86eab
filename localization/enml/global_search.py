"""Where on a map, or on a part of it, some points fit: the best places of a coarse lattice."""

from dataclasses import dataclass
from math import radians

import numpy as np
from numpy.typing import NDArray

from mend.localization.distance_field import DistanceField
from mend.localization.enml.problem import Floats, Indices
from mend.localization.enml.work import Work, pieces
from mend.localization.pose import Poses, wrap
from mend.maps.compiled import compiled

Bytes = NDArray[np.uint8]
Counts = NDArray[np.uint16]

_COARSE_M = 0.4
_COARSE_WIDTH_M = 0.3
_HEADINGS = 72
_SQUARE = 3
"""Places of the lattice along the side of a square, of which only the best counts."""
_COARSE_POINTS = 100
_SUMS_PER_PIECE = 50_000_000
"""Two or three milliseconds..."""
_SUMS_PER_PLACE = 50
"""... of which finding the best of a square takes as long as so many at each of its places."""
_FULL_FIT = 255.0
"""Coarse fits are bytes, and all points of a place fit into two: the search is then fastest."""
_APART_M = 0.7
_APART_RAD = radians(15.0)


@dataclass(frozen=True, slots=True)
class Region:
    """A rectangle of the map (metres): where to look."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float

    @classmethod
    def around(cls, pose: Poses, reach_m: float) -> "Region":
        """The square around a pose."""
        x, y = float(pose[0]), float(pose[1])
        return cls(x - reach_m, y - reach_m, x + reach_m, y + reach_m)


class GlobalSearch:
    """Lays points over a map at every place of a lattice.

    The coarse table of Olson (2009), "Real-time correlative scan matching".
    """

    def __init__(self, field: DistanceField) -> None:
        self._origin, self._cell_m = field.origin, field.cell_m
        self._step = max(round(_COARSE_M / field.cell_m), 1)
        coarse = np.rint(_FULL_FIT * fits(field, _COARSE_WIDTH_M)).astype(np.uint8)
        self._coarse = _phases(coarse, self._step)

    def candidates(self, points: Floats, region: Region, count: int) -> Work[Floats]:
        """At most so many places (n, 3) of a region's lattice where points (robot's frame) fit."""
        if not len(points):
            return np.zeros((0, 3))
        lattice_m = self._step * self._cell_m
        corner = np.array([region.x_min, region.y_min])
        first = np.floor((corner - self._origin) / self._cell_m).astype(np.int64)
        size = np.array([region.x_max, region.y_max]) - corner
        columns, rows = (int(each) for each in np.ceil(size / lattice_m) + 1)
        headings = np.linspace(0.0, 2.0 * np.pi, _HEADINGS, endpoint=False)
        some = points[_spread(len(points), _COARSE_POINTS)]
        squares = np.zeros((len(headings), -(-rows // _SQUARE), -(-columns // _SQUARE)), np.uint16)
        best = np.zeros(squares.shape, dtype=np.uint8)
        sums = rows * columns * (len(some) + _SUMS_PER_PLACE)
        for piece in pieces(len(headings), _SUMS_PER_PIECE // sums):
            for number in range(piece.start, piece.stop):
                scores = np.zeros((rows, columns), dtype=np.uint16)
                score_places(self._coarse, first, self._cell_m, some, headings[number], scores)
                best_of_squares(scores, squares[number], best[number])
            yield
        heading, row, column = _peaks(squares, best, count // 2)
        at = np.column_stack((column, row)) * lattice_m + self._origin + first * self._cell_m
        return np.column_stack((at, headings[heading]))


def _spread(count: int, wanted: int) -> NDArray[np.int64]:
    return np.unique(np.linspace(0, count - 1, min(count, wanted)).astype(np.int64))


def fits(field: DistanceField, width_m: float) -> NDArray[np.float32]:
    """How well a point fits at each corner of the field: 1 on a wall, nearly 0 far from it."""
    fit = np.exp(-0.5 * (field.distances / width_m) ** 2).astype(np.float32)
    fit[field.distances >= field.reach_m] = 0.0
    return np.asarray(fit)


def _peaks(squares: Counts, best: Bytes, count: int) -> tuple[Indices, Indices, Indices]:
    """Heading, row and column of the places with the highest scores, of each square only the best.

    Once for the best heading of each square, and once for the best of the other half of the circle:
    corridors look much the same both ways, and from one end to the other, so that the best of all
    neighbours would leave most of a corridor out.
    """
    best_heading, other_heading = best_headings(squares)
    found = []
    for chosen in (best_heading, other_heading):
        values = np.take_along_axis(squares, chosen[None], axis=0)[0]
        order = np.argsort(-values.astype(np.int64), axis=None, kind="stable")[:count]
        row, column = np.unravel_index(order, values.shape)
        heading = chosen[row, column]
        inside = best[heading, row, column].astype(np.int64)
        row, column = _SQUARE * row + inside // _SQUARE, _SQUARE * column + inside % _SQUARE
        found.append(np.stack((heading, row, column)))
    heading, row, column = np.concatenate(found, axis=1)
    return heading, row, column


@compiled
def best_headings(squares: Counts) -> tuple[Indices, Indices]:
    """The best heading of each square, and the best of those that face the other way."""
    headings, rows, columns = squares.shape
    best = np.zeros((rows, columns), dtype=np.int64)
    other = np.zeros((rows, columns), dtype=np.int64)
    most = np.zeros((rows, columns), dtype=np.uint16)
    for heading in range(headings):
        for row in range(rows):
            for column in range(columns):
                if squares[heading, row, column] > most[row, column]:
                    most[row, column] = squares[heading, row, column]
                    best[row, column] = heading
    most[:] = 0
    aside = headings // 4
    for heading in range(headings):
        for row in range(rows):
            for column in range(columns):
                turned = heading - best[row, column]
                if turned < 0:
                    turned += headings
                if (
                    aside <= turned < headings - aside
                    and squares[heading, row, column] > most[row, column]
                ):
                    most[row, column] = squares[heading, row, column]
                    other[row, column] = heading
    return best, other


def distinct(places: Floats) -> list[int]:
    """The rows (of n, 3) that are not the same place as one before them."""
    kept = np.empty(len(places), dtype=np.int64)
    return [int(row) for row in kept[: keep_distinct(places, kept)]]


@compiled
def keep_distinct(places: Floats, kept: Indices) -> int:
    """The kernel of `distinct`: how many are kept."""
    count = 0
    for row in range(places.shape[0]):
        new = True
        for before in range(count):
            other = places[kept[before]]
            away_m = np.hypot(other[0] - places[row, 0], other[1] - places[row, 1])
            turned_rad = (other[2] - places[row, 2] + np.pi) % (2.0 * np.pi) - np.pi
            if away_m < _APART_M and abs(turned_rad) < _APART_RAD:
                new = False
                break
        if new:
            kept[count] = row
            count += 1
    return count


def same_place(a: Poses, b: Poses) -> bool:
    """Whether two poses are too near to each other to be different answers."""
    return bool(
        np.hypot(a[0] - b[0], a[1] - b[1]) < _APART_M and abs(wrap(a[2] - b[2])) < _APART_RAD
    )


def _phases(fit: Bytes, step: int) -> Bytes:
    """Every `step`-th row and column of a grid, for each of the first ones to start from.

    What a coarse lattice reads for one point then lies side by side in memory.
    """
    height, width = (-(-size // step) for size in fit.shape)
    padded = np.zeros((height * step, width * step), dtype=np.uint8)
    padded[: fit.shape[0], : fit.shape[1]] = fit
    split = padded.reshape(height, step, width, step).transpose(1, 3, 0, 2)
    return np.ascontiguousarray(split)


@compiled
def score_places(
    phases: Bytes, first: Indices, cell_m: float, points: Floats, heading: float, scores: Counts
) -> None:
    """Add up how well all points fit at a heading, for each row and column of the lattice.

    `first` is the lattice's first column and row in cells of the field.
    """
    step, height, width = phases.shape[0], phases.shape[2], phases.shape[3]
    rows, columns = scores.shape
    c, s = np.cos(heading), np.sin(heading)
    for index in range(points.shape[0]):
        px = (c * points[index, 0] - s * points[index, 1]) / cell_m
        py = (s * points[index, 0] + c * points[index, 1]) / cell_m
        column = first[0] + int(np.floor(px + 0.5))
        row = first[1] + int(np.floor(py + 0.5))
        left, below = column // step, row // step
        plane = phases[row - below * step, column - left * step]
        begin, end = max(0, -left), min(columns, width - left)
        if begin >= end:
            continue
        for y in range(max(0, -below), min(rows, height - below)):
            add_row(scores[y, begin:end], plane[below + y, left + begin : left + end])


@compiled
def best_of_squares(scores: Counts, squares: Counts, best: Bytes) -> None:
    """The highest score of each square of places, and which of its places has it, row by row."""
    for row in range(scores.shape[0]):
        for column in range(scores.shape[1]):
            y, x = row // _SQUARE, column // _SQUARE
            if scores[row, column] > squares[y, x]:
                squares[y, x] = scores[row, column]
                best[y, x] = (row % _SQUARE) * _SQUARE + column % _SQUARE


@compiled
def add_row(sums: Counts, row: Bytes) -> None:
    """Add to sums in place. On its own, over whole slices, this loop becomes vector code."""
    for x in range(sums.shape[0]):
        sums[x] += np.uint16(row[x])
