"""Furniture that is on no map: boxes beside the robot's way."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from robots.localization.pose import Poses

Matrix = NDArray[np.float64]

_HALF_SIZE_M = (0.15, 0.45)
_SPREAD_M = 1.8
"""Standard deviation of a box's place around the way."""
_KEPT_CLEAR_M = 0.5


def boxes(way: Poses, count: int, generator: np.random.Generator) -> Matrix:
    """Boxes (n, 4, 4): the four sides of each as x0, y0, x1, y1; none stands in the way."""
    tree = cKDTree(way[:, :2])
    found: list[Matrix] = []
    for _ in range(50 * count):
        if len(found) == count:
            break
        center = way[generator.integers(len(way)), :2] + generator.normal(0.0, _SPREAD_M, 2)
        half = generator.uniform(*_HALF_SIZE_M, 2)
        angle = generator.uniform(0.0, np.pi)
        if tree.query(center)[0] < _KEPT_CLEAR_M + half.max():
            continue
        found.append(_sides(center, half, angle))
    return np.array(found).reshape(-1, 4, 4)


def _sides(center: Matrix, half: Matrix, angle: float) -> Matrix:
    cosine, sine = np.cos(angle), np.sin(angle)
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * half
    corners = corners @ np.array([[cosine, sine], [-sine, cosine]]) + center
    return np.hstack((corners, np.roll(corners, -1, axis=0)))
