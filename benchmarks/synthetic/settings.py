"""The dials of a made-up drive, each with its unit."""

from dataclasses import dataclass, field
from math import pi

from synthetic.rough_laser import RoughLaser


@dataclass(frozen=True, slots=True)
class LaserSettings:
    """A planar laser in the middle of the robot."""

    beams: int = 271
    field_of_view_rad: float = 1.5 * pi
    max_range_m: float = 8.0
    noise_m: float = 0.02
    """Standard deviation of a range."""


@dataclass(frozen=True, slots=True)
class OdometrySettings:
    """Random walk: the standard deviation grows with the square root of the way."""

    along_m_per_sqrt_m: float = 0.05
    across_m_per_sqrt_m: float = 0.05
    turn_rad_per_sqrt_m: float = 0.05
    turn_share: float = 0.05
    """Standard deviation of a turn in place, per square root of radian turned."""


@dataclass(frozen=True, slots=True)
class SceneSettings:
    """One drive. Defaults: a static, fully mapped floor."""

    length_m: float = 100.0
    step_m: float = 0.1
    explained: float = 1.0
    """The share of the returns that the map explains; furniture is added until it is reached."""
    removed: float = 0.0
    """The share of the map's segments that are on the map but no longer there."""
    people: float = 0.0
    """How many people walk within the laser's range, on average."""
    clearance_m: float = 0.4
    speed_m_per_s: float = 0.5
    laser: LaserSettings = field(default_factory=LaserSettings)
    rough: RoughLaser | None = None
    """How the laser errs; None: as `laser` says."""
    odometry: OdometrySettings = field(default_factory=OdometrySettings)

    def __post_init__(self) -> None:
        """Raises `ValueError` where a dial is off its scale."""
        for name in ("explained", "removed"):
            if not 0.0 <= getattr(self, name) <= 1.0:
                raise ValueError(f"{name} has to be between 0 and 1, not {getattr(self, name):g}")
        for name in ("length_m", "step_m", "clearance_m", "speed_m_per_s"):
            if not getattr(self, name) > 0.0:
                raise ValueError(f"{name} has to be above 0, not {getattr(self, name):g}")
        if self.people < 0.0:
            raise ValueError(f"people has to be at least 0, not {self.people:g}")
