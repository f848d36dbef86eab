"""The ground that a part covers: a rectangle in the plane, and whether two of them overlap."""

import math
from dataclasses import dataclass
from typing import Self

TOUCH_M = 0.006
"""Footprints that overlap less than this only touch, as loosely fitting parts do."""


@dataclass(frozen=True, slots=True)
class Footprint:
    """A rectangle around (x, y): `length` along its own x axis, which `yaw` turns, and `width`."""

    x: float
    y: float
    yaw: float
    length: float
    width: float

    @property
    def radius_m(self) -> float:
        """Of the circle around it."""
        return math.hypot(self.length, self.width) / 2

    def overlaps(self, other: Self) -> bool:
        """Whether no edge direction of either separates the two."""
        dx, dy = other.x - self.x, other.y - self.y
        if math.hypot(dx, dy) > self.radius_m + other.radius_m:
            return False
        for yaw in (self.yaw, other.yaw):
            for axis in (yaw, yaw + math.pi / 2):
                distance_m = abs(dx * math.cos(axis) + dy * math.sin(axis))
                if distance_m > self._half_extent(axis) + other._half_extent(axis) - TOUCH_M:
                    return False
        return True

    def _half_extent(self, direction: float) -> float:
        along = direction - self.yaw
        return (abs(self.length * math.cos(along)) + abs(self.width * math.sin(along))) / 2
