"""Occupancy grids: which cells of a floor are occupied, free, or unknown."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float64]
Cells = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class OccupancyGrid:
    """Cells in rows from the top of the picture down; what is neither is unknown.

    `origin` is the pose (x, y, yaw in metres and radians) of the lower left cell's lower left
    corner in the map's frame.
    """

    occupied: Cells
    free: Cells
    resolution_m: float
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    name: str = ""

    def places(self, cells: Matrix) -> Matrix:
        """The middles of cells (..., 2), as column and row, in the map's frame; fractions too."""
        height = self.occupied.shape[0]
        right = (cells[..., 0] + 0.5) * self.resolution_m
        up = (height - 0.5 - cells[..., 1]) * self.resolution_m
        x, y, yaw = self.origin
        cosine, sine = np.cos(yaw), np.sin(yaw)
        return np.stack((x + cosine * right - sine * up, y + sine * right + cosine * up), axis=-1)
