"""When a pose has moved so far that what was found from it has to be found again."""

from math import radians

import numpy as np
from numpy.typing import NDArray

from mend.localization.pose import Poses, wrap

_SETTLED_M, _SETTLED_RAD = 0.01, radians(0.25)
"""Moving less shifts what is a few metres away by a fifth of the laser's noise."""


def has_moved(change: Poses) -> NDArray[np.bool_]:
    """Which of some changes of poses (..., 3) are not small, in metres and radians."""
    moved_m = np.hypot(change[..., 0], change[..., 1])
    return np.asarray((moved_m >= _SETTLED_M) | (np.abs(wrap(change[..., 2])) >= _SETTLED_RAD))
