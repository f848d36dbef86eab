"""One thing that stands on the table or on another part, as the head camera measures it."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tasks.part_boxes import Size


@dataclass(frozen=True, slots=True)
class SeenBox:
    """An upright box in the base frame, metres and radians.

    (x, y) is its centre, `yaw` the direction of its own x axis, `size` its length along that,
    its width and its height above `bottom_z`. `name` is the catalogue's part that it was taken
    for, None for something unknown; a plate with a knob is two boxes of one name. `complete` is
    False where part of its top is not seen.
    """

    x: float
    y: float
    yaw: float
    size: Size
    bottom_z: float
    name: str | None
    complete: bool

    @property
    def top_z(self) -> float:
        return self.bottom_z + self.size[2]

    def corners(self) -> NDArray[np.float64]:
        """The corners (4, 2) of its outline from above, counter-clockwise."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        signs = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
        local = signs * (self.size[0] / 2, self.size[1] / 2)
        turned: NDArray[np.float64] = local @ np.array([[cos, sin], [-sin, cos]])
        at: NDArray[np.float64] = turned + np.array([self.x, self.y])
        return at

    def holds(self, points: NDArray[np.float64], margin_m: float = 0.006) -> NDArray[np.bool_]:
        """Which of some points (n, 3) are in it, or no farther outside than `margin_m`."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        dx, dy = points[:, 0] - self.x, points[:, 1] - self.y
        held: NDArray[np.bool_] = (
            (np.abs(cos * dx + sin * dy) <= self.size[0] / 2 + margin_m)
            & (np.abs(cos * dy - sin * dx) <= self.size[1] / 2 + margin_m)
            & (points[:, 2] >= self.bottom_z - margin_m)
            & (points[:, 2] <= self.top_z + margin_m)
        )
        return held
