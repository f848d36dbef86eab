"""What people call where somebody is on a floor: by the next place that has a name."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.crossing import crossed_by

_AT_M = 3.0
"""Who sees a place that is no farther away is there; all others are near the nearest."""


class PlaceNames:
    """Names points of one floor's map: `at F1-101`, or `near F1-101` where walls are between."""

    def __init__(
        self, places: Mapping[str, tuple[float, float]], segments: NDArray[np.float64]
    ) -> None:
        """`segments` (n, 4): the walls, and the doors as if they were shut."""
        self._places = places
        self._segments = segments

    def name_of(self, x: float, y: float) -> str | None:
        """What a point is called; None where no place has a name."""
        nearest = sorted(
            (math.hypot(at[0] - x, at[1] - y), name) for name, at in self._places.items()
        )
        for away_m, name in nearest:
            if away_m <= _AT_M and self._is_open(x, y, *self._places[name]):
                return f"at {name}"
        return f"near {nearest[0][1]}" if nearest else None

    def _is_open(self, x0: float, y0: float, x1: float, y1: float) -> bool:
        return not len(crossed_by(np.array([x0, y0, x1, y1]), self._segments))
