"""From where a camera looks, and what its picture holds."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.robots.body import Matrix4
from mend.robots.vision.projection import Points, project


@dataclass(frozen=True, slots=True, eq=False)
class Viewpoint:
    """A pinhole camera: pose of its optical frame (base frame), picture size (width, height)."""

    pose: Matrix4
    size: tuple[int, int]
    focal_px: float
    center_px: tuple[float, float]

    @property
    def eye(self) -> NDArray[np.float64]:
        """Where it is (3, base frame)."""
        return self.pose[:3, 3]

    def shows(self, points: Points, margin_px: float = 0.0) -> bool:
        """Whether all points (n, 3, base frame) are in its picture, so far from its rim."""
        if ((points - self.eye) @ self.pose[:3, 2]).min() <= 0.0:
            return False
        pixels = project(self, points)
        last = np.array(self.size) - 1.0
        return bool(((pixels >= margin_px) & (pixels <= last - margin_px)).all())
