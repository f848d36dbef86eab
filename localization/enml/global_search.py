"""Where on a map, or on a part of it, some points fit: the best places of a coarse lattice."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.localization.distance_field import DistanceField
from mend.localization.enml.problem import Floats, Indices
from mend.localization.pose import Poses, wrap
from mend.maps.compiled import compiled

Grid = NDArray[np.float32]
Bytes = NDArray[np.uint8]
Counts = NDArray[np.uint16]

_COARSE_M = 0.4
_COARSE_WIDTH_M = 0.3
_HEADINGS = 72
_SQUARE = 3
"""Places of the lattice along the side of a square, of which only the best counts."""
_COARSE_POINTS = 150
_FULL_FIT = 255.0
"""Coarse fits are bytes, and all points of a place fit into two: the search is then fastest."""
_FINE_POINTS = 150
_FINE_WIDTH_M = 0.15
_FINE_STEPS = ((0.2, np.radians(3.0)), (0.1, np.radians(1.5)))
_APART_M = 0.7
_APART_RAD = np.radians(15.0)


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
    """Lays points over a map at every place of a lattice, and climbs from the best."""

    def __init__(self, field: DistanceField) -> None:
        self._origin, self._cell_m = field.origin, field.cell_m
        self._step = max(round(_COARSE_M / field.cell_m), 1)
        coarse = np.rint(_FULL_FIT * fits(field, _COARSE_WIDTH_M)).astype(np.uint8)
        self._coarse = _phases(coarse, self._step)
        self._fine = fits(field, _FINE_WIDTH_M)

    def climb(self, points: Floats, place: Poses) -> Poses:
        """The pose near a place of the lattice at which points (robot's frame) fit best."""
        some = points[_spread(len(points), _FINE_POINTS)]
        pose = np.array(place, dtype=np.float64)
        for step_m, step_rad in _FINE_STEPS:
            refine(self._fine, self._origin, self._cell_m, some, pose, step_m, step_rad)
        return pose

    def candidates(self, points: Floats, region: Region, count: int) -> list[Poses]:
        """At most so many places of a region's lattice where points (robot's frame) fit best."""
        if not len(points):
            return []
        lattice_m = self._step * self._cell_m
        first = np.floor((np.array([region.x_min, region.y_min]) - self._origin) / self._cell_m)
        size = np.array([region.x_max - region.x_min, region.y_max - region.y_min])
        columns, rows = np.ceil(size / lattice_m).astype(np.int64) + 1
        headings = np.linspace(0.0, 2.0 * np.pi, _HEADINGS, endpoint=False)
        scores = np.zeros((len(headings), rows, columns), dtype=np.uint16)
        score_places(
            self._coarse,
            first.astype(np.int64),
            self._cell_m,
            points[_spread(len(points), _COARSE_POINTS)],
            headings,
            scores,
        )
        corner = self._origin + first * self._cell_m
        xs = corner[0] + np.arange(columns) * lattice_m
        ys = corner[1] + np.arange(rows) * lattice_m
        return _peaks(scores, headings, xs, ys, count // 2)


def _spread(count: int, wanted: int) -> NDArray[np.int64]:
    return np.unique(np.linspace(0, count - 1, min(count, wanted)).astype(np.int64))


def fits(field: DistanceField, width_m: float) -> Grid:
    """How well a point fits at each corner of the field: 1 on a wall, nearly 0 far from it."""
    fit = np.exp(-0.5 * (field.distances / width_m) ** 2).astype(np.float32)
    fit[field.distances >= field.reach_m] = 0.0
    return np.asarray(fit)


def _peaks(scores: Counts, headings: Floats, xs: Floats, ys: Floats, count: int) -> list[Poses]:
    """The places with the highest scores, of each small square only the best.

    Once for the best heading of each place, and once for the best of the other half of the circle:
    corridors look much the same both ways, and from one end to the other, so that the best of all
    neighbours would leave most of a corridor out.
    """
    best_heading = scores.argmax(axis=0)
    rows, columns = np.indices(best_heading.shape)
    quarter = len(headings) // 4
    behind = [(best_heading + quarter + turned) % len(headings) for turned in range(2 * quarter)]
    other = np.stack([scores[each, rows, columns] for each in behind])
    other_heading = np.stack(behind)[other.argmax(axis=0), rows, columns]
    found: list[Poses] = []
    for values, chosen in (
        (scores.max(axis=0), best_heading),
        (other.max(axis=0), other_heading),
    ):
        peak = values == _best_around(values)
        order = np.argsort(-np.where(peak, values.astype(np.int64), -1), axis=None, kind="stable")[
            :count
        ]
        for at in order:
            row, column = divmod(int(at), values.shape[1])
            found.append(np.array([xs[column], ys[row], headings[chosen[row, column]]]))
    return found


def _best_around(values: Counts) -> Counts:
    """The highest value of the square that each place is in."""
    height, width = values.shape
    padded = np.pad(values, ((0, -height % _SQUARE), (0, -width % _SQUARE)))
    blocks = padded.reshape(len(padded) // _SQUARE, _SQUARE, -1, _SQUARE).max(axis=(1, 3))
    spread = blocks.repeat(_SQUARE, axis=0).repeat(_SQUARE, axis=1)
    return np.asarray(spread[:height, :width])


def distinct(places: Poses) -> list[int]:
    """The rows of those that are not the same place as one before them."""
    kept: list[int] = []
    for row, place in enumerate(places.reshape(-1, 3)):
        before = places.reshape(-1, 3)[kept]
        near = np.hypot(before[:, 0] - place[0], before[:, 1] - place[1]) < _APART_M
        if not np.any(near & (np.abs(wrap(before[:, 2] - place[2])) < _APART_RAD)):
            kept.append(row)
    return kept


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
    phases: Bytes,
    first: Indices,
    cell_m: float,
    points: Floats,
    headings: Floats,
    scores: Counts,
) -> None:
    """Sum of how well all points fit, for each heading, row and column of the lattice.

    `first` is the lattice's first column and row in cells of the field.
    """
    step, height, width = phases.shape[0], phases.shape[2], phases.shape[3]
    rows, columns = scores.shape[1], scores.shape[2]
    for heading in range(headings.shape[0]):
        c, s = np.cos(headings[heading]), np.sin(headings[heading])
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
                add_row(scores[heading, y, begin:end], plane[below + y, left + begin : left + end])


@compiled
def add_row(sums: Counts, row: Bytes) -> None:
    """Add to sums in place. On its own, over whole slices, this loop becomes vector code."""
    for x in range(sums.shape[0]):
        sums[x] += np.uint16(row[x])


@compiled
def refine(
    fit: Grid,
    origin: Floats,
    cell_m: float,
    points: Floats,
    pose: Floats,
    step_m: float,
    step_rad: float,
) -> float:
    """Climb from a pose, in place, as long as a step to any side fits better; the score there."""
    best = -1.0
    for _ in range(4):
        bx, by, bt = pose[0], pose[1], pose[2]
        moved = False
        for turn in range(-1, 2):
            angle = bt + turn * step_rad
            c, s = np.cos(angle), np.sin(angle)
            for right in range(-1, 2):
                for up in range(-1, 2):
                    x, y = bx + right * step_m, by + up * step_m
                    total = 0.0
                    for index in range(points.shape[0]):
                        px = x + c * points[index, 0] - s * points[index, 1] - origin[0]
                        py = y + s * points[index, 0] + c * points[index, 1] - origin[1]
                        column = int(np.floor(px / cell_m + 0.5))
                        row = int(np.floor(py / cell_m + 0.5))
                        if 0 <= row < fit.shape[0] and 0 <= column < fit.shape[1]:
                            total += fit[row, column]
                    if total > best + 1e-9:
                        best = total
                        pose[0], pose[1], pose[2] = x, y, angle
                        moved = turn != 0 or right != 0 or up != 0
        if not moved:
            break
    return best
