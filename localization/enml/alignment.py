"""Pre-alignment: where a scan fits best around its prediction, before anything is associated.

A step of the wheels may be off by more than the gates of association forgive. So the newest scan is
first laid over a small grid of what is around, map and recent scans alike, at every place of a
lattice around the prediction.
"""

import numpy as np
from numpy.typing import NDArray

from mend.localization.distance_field import DistanceField
from mend.localization.enml.global_search import fits
from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.problem import Floats
from mend.localization.pose import Poses, turn, wrap_angle
from mend.maps.compiled import compiled

Grid = NDArray[np.float32]

_WIDTH_M = 0.15
"""Standard deviation of how well a point fits, in the grid."""
_MAX_REACH_M = 12.0
"""What is farther away turns out of the grid with the smallest error of the heading."""
_MAX_POINTS = 120
_DEVIATIONS = 3.0
"""The lattice reaches this many standard deviations of odometry to each side."""
_MIN_TURN_RAD = np.radians(8.0)
_MAX_TURN_RAD = np.radians(25.0)
_TURN_STEP_RAD = np.radians(2.0)
_MIN_SHIFT_M = 0.3
_MAX_SHIFT_M = 0.6


class Aligner:
    """Lays scans over a map, and over what was seen just before."""

    def __init__(self, field: DistanceField, parameters: EnmlParameters) -> None:
        # As much as a point on the map's lines counts in the solver, which is told in metres.
        self._weight = parameters.ltf_correlation * (_WIDTH_M / parameters.laser_std_m) ** 2
        self._origin = field.origin
        self._cell_m = field.cell_m
        self._fit = fits(field, _WIDTH_M)
        half = int(np.ceil(2.0 * _WIDTH_M / field.cell_m))
        away = np.hypot(*np.mgrid[-half : half + 1, -half : half + 1]) * field.cell_m
        self._stamp = np.exp(-0.5 * (away / _WIDTH_M) ** 2).astype(np.float32)

    def align(
        self,
        recent: Floats,
        points: Floats,
        predicted: Poses,
        deviations: Poses,
        *,
        on_map: bool = True,
    ) -> Poses:
        """The best place of a lattice around a prediction.

        `recent` are points (n, 2) of the last scans in the map's frame, `points` those of the
        newest in the robot's. `deviations` are those of odometry along x, y (metres) and heading
        (radians). Unless `on_map`, only recent points count.
        """
        near = points[np.hypot(*points.T) < _MAX_REACH_M]
        if not len(near):
            return predicted
        near = near[:: len(near) // _MAX_POINTS + 1]
        reach_m = float(np.percentile(np.hypot(*near.T), 80))
        shift_m = float(np.clip(_DEVIATIONS * deviations[:2].max(), _MIN_SHIFT_M, _MAX_SHIFT_M))
        turn_rad = float(np.clip(_DEVIATIONS * deviations[2], _MIN_TURN_RAD, _MAX_TURN_RAD))
        turns = _both_ways(turn_rad, min(self._cell_m / max(reach_m, 1.0), _TURN_STEP_RAD))
        shifts = _both_ways(shift_m, self._cell_m)
        grid, origin = self._surroundings(recent, predicted[:2], shift_m, on_map)
        turned = np.stack([turn(float(predicted[2] + each), near) for each in turns])
        scores = np.empty((len(turns), len(shifts), len(shifts)))
        center = (predicted[:2] - origin) / self._cell_m
        score_lattice(grid, center, turned / self._cell_m, len(shifts) // 2, scores)
        scores *= self._weight * len(points) / len(near)
        scores -= _doubt(turns, shifts, deviations)
        best = np.unravel_index(int(scores.argmax()), scores.shape)
        moved = np.array([shifts[best[1]], shifts[best[2]], turns[best[0]]])
        pose: Poses = predicted + moved
        pose[2] = wrap_angle(pose[2])
        return pose

    def _surroundings(
        self, recent: Floats, center: Floats, shift_m: float, on_map: bool
    ) -> tuple[Grid, Floats]:
        """How well a point fits at each cell of a square around a place, and its corner."""
        half = int(np.ceil((_MAX_REACH_M + shift_m) / self._cell_m)) + 1
        size = 2 * half + 1
        column, row = np.rint((center - self._origin) / self._cell_m).astype(np.int64) - half
        grid = np.zeros((size, size), dtype=np.float32)
        if on_map:
            height, width = self._fit.shape
            rows = slice(max(row, 0), min(row + size, height))
            columns = slice(max(column, 0), min(column + size, width))
            if rows.start < rows.stop and columns.start < columns.stop:
                grid[
                    rows.start - row : rows.stop - row,
                    columns.start - column : columns.stop - column,
                ] = self._fit[rows, columns]
        origin = self._origin + np.array([column, row]) * self._cell_m
        splat(recent, origin, self._cell_m, self._stamp, grid)
        return grid, origin


def _doubt(turns: Floats, shifts: Floats, deviations: Poses) -> Floats:
    """How unlikely odometry makes each place of the lattice (logarithm)."""
    squares = (turns[:, None, None] / deviations[2]) ** 2 + (
        shifts[None, :, None] ** 2 + shifts[None, None, :] ** 2
    ) / deviations[:2].max() ** 2
    return np.asarray(np.log1p(squares))


def _both_ways(reach: float, step: float) -> Floats:
    count = int(np.ceil(reach / step))
    return np.asarray(np.arange(-count, count + 1) * step, dtype=np.float64)


@compiled
def splat(points: Floats, origin: Floats, cell_m: float, stamp: Grid, grid: Grid) -> None:
    """Let a point fit onto each of some points (map's frame), as well as onto walls."""
    half = stamp.shape[0] // 2
    for index in range(points.shape[0]):
        column = int(np.floor((points[index, 0] - origin[0]) / cell_m + 0.5))
        row = int(np.floor((points[index, 1] - origin[1]) / cell_m + 0.5))
        if not (half <= row < grid.shape[0] - half and half <= column < grid.shape[1] - half):
            continue
        for r in range(-half, half + 1):
            for c in range(-half, half + 1):
                fit = stamp[r + half, c + half]
                if fit > grid[row + r, column + c]:
                    grid[row + r, column + c] = fit


@compiled
def score_lattice(grid: Grid, center: Floats, turned: Floats, reach: int, scores: Floats) -> None:
    """Sum of how well all points fit, per turn and shift by whole cells (x first)."""
    scores[:] = 0.0
    for heading in range(turned.shape[0]):
        for index in range(turned.shape[1]):
            column = int(np.floor(center[0] + turned[heading, index, 0] + 0.5))
            row = int(np.floor(center[1] + turned[heading, index, 1] + 0.5))
            for right in range(-reach, reach + 1):
                c = column + right
                if c < 0 or c >= grid.shape[1]:
                    continue
                for up in range(-reach, reach + 1):
                    r = row + up
                    if 0 <= r < grid.shape[0]:
                        scores[heading, right + reach, up + reach] += grid[r, c]
