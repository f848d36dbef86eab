"""A level rectangle, and the way between its own axes and those of the base frame."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_SIGNS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])


@dataclass(frozen=True, slots=True)
class Rectangle:
    """A horizontal rectangle in the base frame: `yaw` of its x axis, extents along x and y."""

    x: float
    y: float
    yaw: float
    extents: tuple[float, float]

    def corners(self) -> NDArray[np.float64]:
        """Its corners (4, 2), counter-clockwise."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        local = _SIGNS * (self.extents[0] / 2, self.extents[1] / 2)
        turned: NDArray[np.float64] = local @ np.array([[cos, sin], [-sin, cos]])
        at: NDArray[np.float64] = turned + np.array([self.x, self.y])
        return at

    def point(self, along: float, across: float) -> tuple[float, float]:
        """What is so far from its centre along its x and its y axis (metres)."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return self.x + cos * along - sin * across, self.y + sin * along + cos * across

    def local(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """How far points (n, 2) are from its centre along its x and its y axis (n, 2)."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        offset = points - (self.x, self.y)
        local: NDArray[np.float64] = offset @ np.array([[cos, -sin], [sin, cos]])
        return local

    def holds(self, points: NDArray[np.float64], margin_m: float) -> NDArray[np.bool_]:
        """Which of some points (n, 2) are in it, or no farther outside than `margin_m`."""
        along, across = np.abs(self.local(points)).T
        held: NDArray[np.bool_] = (along <= self.extents[0] / 2 + margin_m) & (
            across <= self.extents[1] / 2 + margin_m
        )
        return held
