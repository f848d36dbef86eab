"""What a robot's laser sees on its floor: walls, shut doors, and whatever is round."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mend.maps.ray_cast import cast

Matrix = NDArray[np.float64]

REACH_M = 10.0
BEAMS = 361
ANGLES_RAD = np.linspace(-math.pi, math.pi, BEAMS)
"""From straight ahead."""
PERIOD_S = 0.1


def ranges_m(
    segments: Matrix, circles: Sequence[tuple[float, float, float]], x: float, y: float, yaw: float
) -> Matrix:
    """How far the next thing is along each beam from a pose (metres, radians).

    `segments` are rows x0, y0, x1, y1, `circles` are x, y and radius, all in one frame. Inf where
    nothing is within reach.
    """
    angles = ANGLES_RAD + yaw
    ranges, _ = cast(segments, x, y, angles, REACH_M)
    along = np.stack([np.cos(angles), np.sin(angles)])
    for at_x, at_y, radius in circles:
        ranges = np.minimum(ranges, _to_circle(np.array([at_x - x, at_y - y]), radius, along))
    return np.where(ranges < REACH_M, ranges, np.inf)


def _to_circle(offset: Matrix, radius: float, along: Matrix) -> Matrix:
    middle = offset @ along
    within = radius**2 - (offset @ offset - middle**2)
    near = middle - np.sqrt(np.maximum(within, 0.0))
    return np.where((within > 0.0) & (near > 0.0), near, np.inf)
