"""Furniture that is on no map: boxes beside the robot's way."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from mend.localization.pose import Poses

Matrix = NDArray[np.float64]

_HALF_DEPTH_M = (0.15, 0.45)
_HALF_WIDTH_M = (0.15, 0.8)
_SPREAD_M = 1.5
"""Standard deviation of a box's place around the way."""
_KEPT_CLEAR_M = 0.35
"""No box comes nearer to the way of the robot's middle than this."""
_TRIES_PER_BOX = 20
_OUTLINE_POINTS = 16


def boxes(way: Poses, count: int, generator: np.random.Generator) -> Matrix:
    """At most `count` boxes (n, 4, 4): the four sides of each as x0, y0, x1, y1."""
    tried = _TRIES_PER_BOX * count
    centers = way[generator.integers(len(way), size=tried), :2]
    centers = centers + generator.normal(0.0, _SPREAD_M, (tried, 2))
    halves = np.column_stack(
        (generator.uniform(*_HALF_WIDTH_M, tried), generator.uniform(*_HALF_DEPTH_M, tried))
    )
    corners = _corners(centers, halves, generator.uniform(0.0, np.pi, tried))
    sides = np.concatenate((corners, np.roll(corners, -1, axis=1)), axis=2)
    clear = _clearance(way, centers, sides) > _KEPT_CLEAR_M
    return np.ascontiguousarray(sides[clear][:count])


def _corners(centers: Matrix, halves: Matrix, angles: Matrix) -> Matrix:
    signs = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    local = signs[None] * halves[:, None]
    cosines, sines = np.cos(angles)[:, None], np.sin(angles)[:, None]
    x = cosines * local[..., 0] - sines * local[..., 1]
    y = sines * local[..., 0] + cosines * local[..., 1]
    return centers[:, None] + np.stack((x, y), axis=-1)


def _clearance(way: Poses, centers: Matrix, sides: Matrix) -> Matrix:
    """How near the way comes to each box; 0 where it may lead through."""
    tree = cKDTree(way[:, :2])
    shares = np.linspace(0.0, 1.0, _OUTLINE_POINTS // 4, endpoint=False)[:, None]
    outline = sides[:, :, None, :2] * (1.0 - shares) + sides[:, :, None, 2:] * shares
    outline = outline.reshape(len(sides), -1, 2)
    points = np.concatenate((outline, centers[:, None]), axis=1)
    nearest: Matrix = tree.query(points)[0].min(axis=1)
    return nearest
