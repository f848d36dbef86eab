"""Where on a floor there is room to leave its lanes: past walls and past cabins."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mend.maps.building.cabin import CABIN_M
from mend.maps.building.clearance import clearance_m, is_clear
from mend.maps.building.floor_grid import Matrix, Point

_ROUNDING_M = 1e-6


@dataclass(frozen=True, slots=True)
class FloorRoom:
    """The walls (n, 4) of a floor and the middles of its cabins, in its frame.

    `needs_m`: so far from a robot's middle a wall has to be.
    """

    walls: Matrix
    cabins: Sequence[Point]
    needs_m: float

    def is_wide(self, a: Point, b: Point) -> bool:
        """Whether the straight way is wide enough to leave the lanes for.

        It may begin or end in a cabin, or beside one, and leads nearer to none than that.
        """
        if not is_clear(a, b, self.walls, self.needs_m):
            return False
        around_m = CABIN_M + self.needs_m
        return all(
            (away_m := min(math.dist(a, cabin), math.dist(b, cabin))) < CABIN_M
            or clearance_m(a, b, np.array([[*cabin, *cabin]]))
            >= min(around_m, away_m) - _ROUNDING_M
            for cabin in self.cabins
        )

    def cabins_of_others(self, *ends: Point) -> Sequence[Point]:
        """The cabins that none of some points is in."""
        return [
            cabin for cabin in self.cabins if min(math.dist(cabin, end) for end in ends) >= CABIN_M
        ]
