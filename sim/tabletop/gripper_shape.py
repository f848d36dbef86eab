"""What the gripper of a tabletop world looks like: two fingers under a palm, made of boxes."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mend.sim.raster import Triangles, box_triangles

_FINGER_THICKNESS_M = 0.012

# Upright, around the tool point: x is the opening direction, z is up.
FINGER: Triangles = box_triangles((_FINGER_THICKNESS_M, 0.02, 0.07), (0.0, 0.0, 0.025))
PALM: Sequence[Triangles] = (
    box_triangles((0.13, 0.05, 0.04), (0.0, 0.0, 0.09)),
    box_triangles((0.05, 0.05, 0.30), (0.0, 0.0, 0.26)),
)


def finger_offset_m(opening_m: float) -> float:
    """How far the middle of each finger is from the tool point."""
    return (opening_m + _FINGER_THICKNESS_M) / 2


def finger_hulls(opening_m: float) -> Sequence[NDArray[np.float64]]:
    """All boxes, points (n, 3), in the tool frame (x down, y the opening direction)."""
    aside = np.array([finger_offset_m(opening_m), 0.0, 0.0])
    upright = [FINGER + aside, FINGER - aside, *PALM]
    points = [np.unique(each.reshape(-1, 3), axis=0) for each in upright]
    return [np.stack([-each[:, 2], each[:, 0], -each[:, 1]], axis=1) for each in points]
