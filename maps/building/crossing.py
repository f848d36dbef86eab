"""Which segments a straight way crosses."""

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float64]


def crossed_by(way: Matrix, segments: Matrix) -> NDArray[np.intp]:
    """The numbers of those segments (n, 4) that a way (x0, y0, x1, y1) goes through.

    One that it only touches with an end is not crossed.
    """
    if not len(segments):
        return np.empty(0, np.intp)
    start, end = way[:2], way[2:]
    a, b = segments[:, :2], segments[:, 2:]
    beside_a, beside_b = _side(start, end, a), _side(start, end, b)
    before, after = _side(a, b, start), _side(a, b, end)
    return np.flatnonzero((beside_a * beside_b < 0.0) & (before * after < 0.0))


def _side(start: Matrix, end: Matrix, point: Matrix) -> Matrix:
    """On which side of the line from start to end a point is: the sign of the area between."""
    along, to = end - start, point - start
    return np.asarray(along[..., 0] * to[..., 1] - along[..., 1] * to[..., 0])
