"""The body of a base: what behaviors, monitors and looks may ask of what drives.

Poses are in the robot's base frame on the link: x forward, y left of where it stood at the start.
"""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from mend.robots.body import MovingBody


@dataclass(frozen=True, slots=True)
class BasePose:
    """Where a base is in the plane (metres), and where it faces (`yaw`, radians)."""

    x: float
    y: float
    yaw: float

    def distance_m(self, to: "BasePose") -> float:
        """How far another pose is, whichever way it faces."""
        return math.hypot(to.x - self.x, to.y - self.y)

    def turned_by_rad(self, to: "BasePose") -> float:
        """How far another pose is turned from this one, in [0, pi]."""
        return abs(math.remainder(to.yaw - self.yaw, math.tau))


@dataclass(frozen=True, slots=True, eq=False)
class RangeScan:
    """One scan of a laser in the middle of the base.

    `ranges_m` (n,): how far the next thing is along each beam, inf where nothing is within reach;
    `angles_rad` (n,): the beams' directions from straight ahead, left is positive.
    `time`: of the world's clock.
    """

    ranges_m: NDArray[np.float64]
    angles_rad: NDArray[np.float64]
    time: float


class BaseBody(MovingBody, Protocol):
    """A base that drives over a floor, with a laser."""

    @property
    def radius_m(self) -> float:
        """All of the base, with what it carries, is so near to its middle."""
        ...

    @property
    def scan_period_s(self) -> float:
        """How often the laser scans, in seconds of the world's clock."""
        ...

    def pose(self) -> BasePose:
        """Where it is, as it knows it itself (odometry, or a localizer)."""
        ...

    def scan(self) -> RangeScan:
        """The newest scan."""
        ...

    def drive(self, to: BasePose, speed: float) -> None:
        """Turn towards a pose, drive straight to it, and turn as it says.

        `speed` in (0, 1] scales it. It replaces what was under way, and drives whatever is in the
        way: who calls looks out.
        """
        ...
