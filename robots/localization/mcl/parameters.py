"""The parameters of Monte Carlo localization, each with unit, default and why."""

from dataclasses import dataclass, field
from math import radians

from robots.localization.particles.motion import MotionNoise


@dataclass(frozen=True, slots=True)
class MclParameters:
    """Defaults found on static made-up drives and the public logs; the same everywhere."""

    particles: int = 1000
    cell_m: float = 0.05
    """Of the likelihood field; the usual size, read with interpolation."""
    beams: int = 60
    """Returns used of a scan, evenly spread: neighbours say nearly the same."""
    hit_deviation_m: float = 0.1
    """Laser noise and the map's own error together."""
    hit_share: float = 0.9
    """The rest of the returns may come from anywhere."""
    field_reach_m: float = 1.0
    """Farther from any wall, it no longer matters how far."""
    trust: float = 0.35
    """Exponent of a scan's likelihood, since its returns err together."""
    min_range_m: float = 0.05
    max_range_m: float = 30.0
    min_move_m: float = 0.02
    min_turn_rad: float = radians(1.0)
    """Scans from one place are looked at once: again and again they would say nothing new."""
    resample_below: float = 0.5
    """Resample when fewer than this share of the particles count."""
    start_deviation_m: float = 0.1
    start_deviation_rad: float = radians(3.0)
    explained_within_m: float = 0.25
    """A point this near a wall of the map is put down to it."""
    lost_above: float = 0.8
    """Lost is said when more than this share of the points is unexplained, on average."""
    lost_memory: float = 0.7
    """How much of the lost measure is carried from one scan to the next."""
    motion: MotionNoise = field(default_factory=MotionNoise)
