"""One thing that stands on the table or on another part, as the head camera measures it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.robots.vision.level_rectangle import Rectangle
from mend.tasks.part_boxes import Size


@dataclass(frozen=True, slots=True)
class SeenBox:
    """An upright box in the base frame, metres and radians.

    (x, y) is its centre, `yaw` the direction of its own x axis, `size` its length along that,
    its width and its height above `bottom_z`. `name` is the catalogue's part that it was taken
    for, None for something unknown; a plate with a knob is two boxes of one name. `complete` is
    False where part of its top is not seen, `toppled` tells of a part that it lies on a side.
    """

    x: float
    y: float
    yaw: float
    size: Size
    bottom_z: float
    name: str | None
    complete: bool
    toppled: bool = False

    @property
    def top_z(self) -> float:
        return self.bottom_z + self.size[2]

    @property
    def outline(self) -> Rectangle:
        """From above."""
        return Rectangle(self.x, self.y, self.yaw, self.size[:2])

    def corners(self) -> NDArray[np.float64]:
        """The corners (4, 2) of its outline from above, counter-clockwise."""
        return self.outline.corners()

    def holds(self, points: NDArray[np.float64], margin_m: float = 0.006) -> NDArray[np.bool_]:
        """Which of some points (n, 3) are in it, or no farther outside than `margin_m`."""
        held: NDArray[np.bool_] = (
            self.outline.holds(points[:, :2], margin_m)
            & (points[:, 2] >= self.bottom_z - margin_m)
            & (points[:, 2] <= self.top_z + margin_m)
        )
        return held
