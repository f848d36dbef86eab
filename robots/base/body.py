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
    """Where a base is (metres), and where it faces (`yaw`, radians); `z` is its floor's height."""

    x: float
    y: float
    yaw: float
    z: float = 0.0

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


@dataclass(frozen=True, slots=True)
class Velocity:
    """How a base moves, in its own frame: forward, to the left, and turning to the left."""

    forward_m_s: float = 0.0
    left_m_s: float = 0.0
    turn_rad_s: float = 0.0

    @property
    def speed_m_s(self) -> float:
        """How fast its middle goes, in whichever direction."""
        return math.hypot(self.forward_m_s, self.left_m_s)


STANDING = Velocity()


@dataclass(frozen=True, slots=True)
class DriveLimits:
    """How fast a base goes and turns at most, and how soon it goes faster or slower.

    `sideways`: it goes in every direction; any other goes forward only, and turns on the spot.
    """

    speed_m_s: float
    acceleration_m_s2: float
    turn_rad_s: float
    turn_acceleration_rad_s2: float
    sideways: bool

    def __post_init__(self) -> None:
        for name in ("speed_m_s", "acceleration_m_s2", "turn_rad_s", "turn_acceleration_rad_s2"):
            value = getattr(self, name)
            if not 0.0 < value < math.inf:
                raise ValueError(f"limits of a base: {name} is {value}; it must be above 0")


class BaseBody(MovingBody, Protocol):
    """A base that drives over a floor, with a laser. `stop` has it brake, as hard as it can."""

    @property
    def radius_m(self) -> float:
        """All of the base, with what it carries, is so near to its middle."""
        ...

    @property
    def limits(self) -> DriveLimits:
        """What it can do, at any time."""
        ...

    @property
    def scan_period_s(self) -> float:
        """How often the laser scans, in seconds of the world's clock."""
        ...

    def pose(self) -> BasePose:
        """Where it is, as it knows it itself (odometry, or a localizer)."""
        ...

    def odometry(self) -> BasePose:
        """Where it has come to since some start, as its wheels say: it drifts, and never jumps."""
        ...

    def velocity(self) -> Velocity:
        """How it moves now, as its odometry says."""
        ...

    def scan(self) -> RangeScan:
        """The newest scan."""
        ...

    def move(self, velocity: Velocity) -> None:
        """Move so, as soon as its limits allow, until told otherwise.

        It drives whatever is in the way: who calls looks out.
        """
        ...
