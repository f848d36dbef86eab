"""How far from the nearest wall every place of a map is, on a grid."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from mend.errors import WrongInputError
from mend.maps.compiled import compiled
from mend.maps.vector_map import VectorMap

Matrix = NDArray[np.float64]
Grid = NDArray[np.float32]

MAX_CELLS = 100_000_000
"""A larger field would not fit into memory beside everything else."""


@dataclass(frozen=True, slots=True, eq=False)
class DistanceField:
    """Metres to the nearest segment, at most `reach_m`, at the cells' corners from `origin` on."""

    distances: Grid
    origin: Matrix
    cell_m: float
    reach_m: float

    def at(self, points: Matrix) -> Matrix:
        """The distance at each point (m, 2), in the map's frame; interpolated."""
        found = np.empty(len(points))
        look_up(self.distances, self.origin, self.cell_m, self.reach_m, points, found)
        return found


def distance_field(vector_map: VectorMap, cell_m: float, reach_m: float) -> DistanceField:
    """The field of a map. Raises `WrongInputError` where it would be too large."""
    x_min, y_min, x_max, y_max = vector_map.bounds
    origin = np.array([x_min, y_min]) - reach_m
    width, height = (
        int(np.ceil((span + 2.0 * reach_m) / cell_m)) + 2 for span in (x_max - x_min, y_max - y_min)
    )
    if width * height > MAX_CELLS:
        raise WrongInputError(
            f"a map of {x_max - x_min:.0f} by {y_max - y_min:.0f} m is too large "
            f"for a likelihood field with cells of {cell_m:g} m: are its coordinates metres?"
        )
    distances = np.full((height, width), reach_m, dtype=np.float32)
    if not len(vector_map):
        return DistanceField(distances, origin, cell_m, reach_m)
    nearest = np.full((height, width), -1, dtype=np.int32)
    _mark(vector_map.segments, origin, cell_m, nearest)
    rows, columns = distance_transform_edt(nearest < 0, return_distances=False, return_indices=True)
    _measure(vector_map.segments, nearest[rows, columns], origin, cell_m, distances)
    return DistanceField(distances, origin, cell_m, reach_m)


@compiled
def _mark(segments: Matrix, origin: Matrix, cell_m: float, nearest: NDArray[np.int32]) -> None:
    """Write each segment's number on the corners along it."""
    for number in range(segments.shape[0]):
        x0, y0, x1, y1 = segments[number]
        steps = int(np.hypot(x1 - x0, y1 - y0) / cell_m * 2.0) + 1
        for step in range(steps + 1):
            column = int(np.rint((x0 + (x1 - x0) * step / steps - origin[0]) / cell_m))
            row = int(np.rint((y0 + (y1 - y0) * step / steps - origin[1]) / cell_m))
            nearest[row, column] = number


@compiled
def _measure(
    segments: Matrix,
    nearest: NDArray[np.int32],
    origin: Matrix,
    cell_m: float,
    distances: Grid,
) -> None:
    """Replace the grid's rounding by the exact distance to the segment that it found."""
    for row in range(distances.shape[0]):
        y = origin[1] + row * cell_m
        for column in range(distances.shape[1]):
            x = origin[0] + column * cell_m
            x0, y0, x1, y1 = segments[nearest[row, column]]
            ex, ey = x1 - x0, y1 - y0
            square = ex * ex + ey * ey
            along = 0.0
            if square > 0.0:
                along = min(max(((x - x0) * ex + (y - y0) * ey) / square, 0.0), 1.0)
            away = np.hypot(x0 + along * ex - x, y0 + along * ey - y)
            distances[row, column] = min(distances[row, column], away)


@compiled
def look_up(
    distances: Grid,
    origin: Matrix,
    cell_m: float,
    outside: float,
    points: Matrix,
    found: Matrix,
) -> None:
    """Interpolated values at points; `outside` beyond the grid."""
    for index in range(points.shape[0]):
        found[index] = interpolated(
            distances,
            (points[index, 0] - origin[0]) / cell_m,
            (points[index, 1] - origin[1]) / cell_m,
            outside,
        )


@compiled
def interpolated(grid: Grid, column: float, row: float, outside: float) -> float:
    """The value between four corners, at fractional indices; `outside` beyond the grid."""
    if not (0.0 <= column < grid.shape[1] - 1 and 0.0 <= row < grid.shape[0] - 1):
        return outside
    left, below = int(column), int(row)
    right, above = column - left, row - below
    low = grid[below, left] * (1.0 - right) + grid[below, left + 1] * right
    high = grid[below + 1, left] * (1.0 - right) + grid[below + 1, left + 1] * right
    return float(low * (1.0 - above) + high * above)
