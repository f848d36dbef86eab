"""Other robots in a depth picture: they say where they are, so nothing is measured there."""

import cv2
import numpy as np
from numpy.typing import NDArray

_AROUND_PX = 9
"""So wide around each pixel of another robot its depth is not believed."""


def around(there: NDArray[np.bool_]) -> NDArray[np.bool_] | None:
    """The pixels on and around those that show other robots; None where none shows any."""
    if not there.any():
        return None
    kernel = np.ones((_AROUND_PX, _AROUND_PX), np.uint8)
    return np.asarray(cv2.dilate(there.astype(np.uint8), kernel) > 0)


def blank(depth_m: NDArray[np.float32], others: NDArray[np.bool_] | None) -> NDArray[np.float32]:
    """Depth with nothing measured where other robots are."""
    return depth_m if others is None else np.where(others, np.float32(np.nan), depth_m)
