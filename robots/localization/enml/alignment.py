"""Pre-alignment: where a scan fits best around its prediction, before anything is associated.

A step of the wheels may be off by more than the gates of association forgive. So the newest scan is
first laid over a small grid of what is around, map and recent scans alike, at every place of a
lattice around the prediction.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from maps.compiled import compiled
from robots.localization.enml.parameters import EnmlParameters
from robots.localization.enml.problem import Floats
from robots.localization.mcl.likelihood_field import DistanceField
from robots.localization.pose import Poses, turn, wrap_angle

Grid = NDArray[np.float32]

_CELL_M = 0.1
_WIDTH_M = 0.2
"""Standard deviation of how well a point fits, in the grid."""
_SPLAT_CELLS = 4
_MAX_REACH_M = 12.0
"""What is farther away turns out of the grid with the smallest error of the heading."""
_MAX_POINTS = 120
_DEVIATIONS = 3.0
"""The lattice reaches this many standard deviations of odometry to each side."""
_MIN_TURN_RAD = np.radians(8.0)
_MAX_TURN_RAD = np.radians(25.0)
_MIN_SHIFT_M = 0.1
_MAX_SHIFT_M = 0.6


@dataclass(frozen=True, slots=True)
class Aligned:
    """The best place of the lattice, and by how much it beats the prediction (log-likelihood)."""

    pose: Poses
    gain: float


def align(
    field: DistanceField | None,
    recent: Floats,
    points: Floats,
    predicted: Poses,
    deviations: Poses,
    parameters: EnmlParameters,
) -> Aligned:
    """Search around a prediction.

    `recent` are points (n, 2) of the last scans in the map's frame, `points` those of the newest in
    the robot's. Without a field of the map, only recent points count. `deviations` are those of
    odometry along x, y (metres) and heading (radians).
    """
    near = points[np.hypot(*points.T) < _MAX_REACH_M]
    if not len(near):
        return Aligned(predicted, 0.0)
    near = near[:: len(near) // _MAX_POINTS + 1]
    reach_m = float(np.percentile(np.hypot(*near.T), 80))
    shift_m = float(np.clip(_DEVIATIONS * deviations[:2].max(), _MIN_SHIFT_M, _MAX_SHIFT_M))
    turn_rad = float(np.clip(_DEVIATIONS * deviations[2], _MIN_TURN_RAD, _MAX_TURN_RAD))
    turn_step = min(_CELL_M / max(reach_m, 1.0), np.radians(2.0))
    turns = _both_ways(turn_rad, turn_step)
    shifts = _both_ways(shift_m, _CELL_M)
    half_m = _MAX_REACH_M + shift_m + _CELL_M
    grid, origin = _surroundings(field, recent, predicted[:2], half_m)
    scores = np.empty((len(turns), len(shifts), len(shifts)))
    turned = np.stack([turn(float(predicted[2] + each), near) for each in turns])
    score_lattice(
        grid, (predicted[:2] - origin) / _CELL_M, turned / _CELL_M, len(shifts) // 2, scores
    )
    scores *= parameters.alignment_weight * len(points) / len(near)
    doubt = (turns[:, None, None] / deviations[2]) ** 2 + (
        shifts[None, :, None] ** 2 + shifts[None, None, :] ** 2
    ) / deviations[:2].max() ** 2
    scores -= np.log1p(doubt)
    best = np.unravel_index(int(scores.argmax()), scores.shape)
    middle = tuple(size // 2 for size in scores.shape)
    pose = np.array(
        [
            predicted[0] + shifts[best[1]],
            predicted[1] + shifts[best[2]],
            wrap_angle(predicted[2] + turns[best[0]]),
        ]
    )
    return Aligned(pose, float(scores[best] - scores[middle]))


def _both_ways(reach: float, step: float) -> Floats:
    count = int(np.ceil(reach / step))
    return np.asarray(np.arange(-count, count + 1) * step, dtype=np.float64)


def _surroundings(
    field: DistanceField | None, recent: Floats, center: Floats, half_m: float
) -> tuple[Grid, Floats]:
    """How well a point fits at each cell of a square around a place, and the square's corner."""
    cells = int(np.ceil(2.0 * half_m / _CELL_M)) + 1
    grid = np.zeros((cells, cells), dtype=np.float32)
    origin = center - half_m
    if field is not None:
        fill_from_field(
            field.distances, field.origin, field.cell_m, origin, _CELL_M, _WIDTH_M, grid
        )
    splat(recent, origin, _CELL_M, _WIDTH_M, _SPLAT_CELLS, grid)
    return grid, origin


@compiled
def fill_from_field(
    distances: Grid,
    field_origin: Floats,
    field_cell_m: float,
    origin: Floats,
    cell_m: float,
    width_m: float,
    grid: Grid,
) -> None:
    """Write how well a point fits onto the nearest wall, for every cell of a grid."""
    reach = 3.0 * width_m
    for row in range(grid.shape[0]):
        y = int((origin[1] + row * cell_m - field_origin[1]) / field_cell_m + 0.5)
        if y < 0 or y >= distances.shape[0]:
            continue
        for column in range(grid.shape[1]):
            x = int((origin[0] + column * cell_m - field_origin[0]) / field_cell_m + 0.5)
            if x < 0 or x >= distances.shape[1]:
                continue
            gap = distances[y, x]
            if gap < reach:
                grid[row, column] = np.exp(-0.5 * (gap / width_m) ** 2)


@compiled
def splat(
    points: Floats, origin: Floats, cell_m: float, width_m: float, cells: int, grid: Grid
) -> None:
    """Let a point fit onto each of some points (map's frame), as well as onto walls."""
    for index in range(points.shape[0]):
        x, y = (points[index, 0] - origin[0]) / cell_m, (points[index, 1] - origin[1]) / cell_m
        column, row = int(np.floor(x + 0.5)), int(np.floor(y + 0.5))
        for r in range(max(row - cells, 0), min(row + cells + 1, grid.shape[0])):
            for c in range(max(column - cells, 0), min(column + cells + 1, grid.shape[1])):
                away = ((r - y) ** 2 + (c - x) ** 2) * (cell_m / width_m) ** 2
                grid[r, c] = max(grid[r, c], np.exp(-0.5 * away))


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
