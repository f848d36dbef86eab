"""A base that drives: sending it on its way, in routines that take many control cycles."""

import math

import numpy as np

from mend.robots.base.body import BaseBody, BasePose
from mend.robots.execution.effector import Effector

SPARE_M = 0.15
"""It stops so far before what stands in its way."""
_BESIDE_M = 0.05
"""What it passes beside is so far away at least."""


class Base(Effector[BaseBody]):
    """A base; it is at rest wherever it stands."""

    def __init__(self, body: BaseBody) -> None:
        super().__init__(body)
        self.at_rest = True

    def start(self, to: BasePose, speed: float) -> None:
        """Start driving straight to a pose."""
        self.at_rest = False
        self.body.drive(to, self._at_speed(speed))

    def stop(self) -> None:
        """Stop within one control cycle."""
        super().stop()
        self.at_rest = True

    def in_the_way_m(self, to: BasePose) -> float | None:
        """How far what stands in the straight way to a pose is from its rim; None if it is free."""
        body, here = self.body, self.body.pose()
        scan, length_m = body.scan(), here.distance_m(to)
        if length_m < 1e-6:
            return None
        bearing = math.atan2(to.y - here.y, to.x - here.x) - here.yaw
        seen = np.isfinite(scan.ranges_m)
        ranges_m, angles_rad = scan.ranges_m[seen], scan.angles_rad[seen] - bearing
        along, across = ranges_m * np.cos(angles_rad), np.abs(ranges_m * np.sin(angles_rad))
        met = (across < body.radius_m + _BESIDE_M) & (along > 0.0)
        met &= along < length_m + body.radius_m + _BESIDE_M
        return float(along[met].min()) - body.radius_m if met.any() else None
