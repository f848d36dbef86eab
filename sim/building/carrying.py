"""Somebody who now and then carries a robot elsewhere: its wheels do not measure that."""

import math

import numpy as np

from mend.maps.building.building import Floor
from mend.sim.building.floor_pose import FloorPose


class Carrying:
    """When somebody carries a robot next, and to where; drawn by the world's generator."""

    def __init__(self, every_s: float, rng: np.random.Generator) -> None:
        """About every so many seconds; never if 0."""
        self._every_s = every_s
        self._rng = rng
        self.due_s: float | None = every_s or None

    def is_due(self, time_s: float) -> bool:
        """Whether somebody carries a robot now; if so, it is some time until the next one."""
        if self.due_s is None or time_s < self.due_s:
            return False
        self.due_s += self._every_s * float(self._rng.uniform(0.5, 1.5))
        return True

    def choose(self, count: int) -> int:
        """One of so many robots."""
        return int(self._rng.integers(count))

    def draw(self, name: str, floor: Floor) -> FloorPose:
        """At some place of a floor, turned somehow."""
        places = list(floor.places.values())
        place = places[int(self._rng.integers(len(places)))]
        yaw = float(self._rng.uniform(-math.pi, math.pi))
        return FloorPose(name, place.x, place.y, yaw)
