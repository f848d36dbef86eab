"""Other robots in a depth picture: they say where they are, so nothing is measured there."""

import cv2
import numpy as np
from numpy.typing import NDArray

_AROUND_PX = 9
"""So wide around each pixel of another robot its depth is not believed."""


def blank_around(depth_m: NDArray[np.float32], there: NDArray[np.bool_]) -> NDArray[np.float32]:
    """Depth with nothing measured on and around the pixels that show other robots."""
    around = cv2.dilate(there.astype(np.uint8), np.ones((_AROUND_PX, _AROUND_PX), np.uint8))
    return np.where(around > 0, np.float32(np.nan), depth_m)
