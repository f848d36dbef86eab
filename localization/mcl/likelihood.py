"""How well each particle explains a scan."""

import numpy as np
from numpy.typing import NDArray

from mend.localization.distance_field import DistanceField, Grid, interpolated
from mend.localization.mcl.parameters import MclParameters
from mend.localization.pose import Poses
from mend.maps.compiled import compiled

Matrix = NDArray[np.float64]


class FieldLikelihood:
    """Log-likelihoods of points under a map: near a wall, or anywhere."""

    def __init__(self, field: DistanceField, parameters: MclParameters) -> None:
        deviation = parameters.hit_deviation_m
        near = np.exp(-0.5 * np.square(field.distances.astype(np.float64) / deviation))
        share = parameters.hit_share
        self._outside = float(np.log(1.0 - share))
        self._grid: Grid = np.log(share * near + (1.0 - share)).astype(np.float32)
        self._origin = field.origin
        self._cell_m = field.cell_m

    def __call__(self, particles: Poses, points: Matrix) -> Matrix:
        """One sum over `points` (robot's frame) per particle."""
        sums = np.empty(len(particles))
        _sum_up(self._grid, self._origin, self._cell_m, self._outside, particles, points, sums)
        return sums


@compiled
def _sum_up(
    grid: Grid,
    origin: Matrix,
    cell_m: float,
    outside: float,
    particles: Poses,
    points: Matrix,
    sums: Matrix,
) -> None:
    for number in range(particles.shape[0]):
        cosine = np.cos(particles[number, 2]) / cell_m
        sine = np.sin(particles[number, 2]) / cell_m
        left = (particles[number, 0] - origin[0]) / cell_m
        below = (particles[number, 1] - origin[1]) / cell_m
        total = 0.0
        for index in range(points.shape[0]):
            x, y = points[index, 0], points[index, 1]
            total += interpolated(
                grid, left + cosine * x - sine * y, below + sine * x + cosine * y, outside
            )
        sums[number] = total
