"""The parameters that all localizers with particles have, each with unit and default."""

from dataclasses import dataclass, field
from math import radians

from mend.localization.particles.motion import MotionNoise


@dataclass(frozen=True, slots=True, kw_only=True)
class ParticleParameters:
    """What is used of a scan, where particles begin, how they move, when they are lost."""

    particles: int
    min_range_m: float = 0.05
    max_range_m: float = 30.0
    start_deviation_m: float = 0.1
    start_deviation_rad: float = radians(3.0)
    explained_within_m: float = 0.25
    """A point this near the wall that it may have been seen on is put down to the map."""
    lost_above: float = 0.8
    """Lost is said when more than this share of the points is unexplained, on average."""
    lost_memory: float = 0.7
    """How much of the lost measure is carried from one scan to the next."""
    motion: MotionNoise = field(default_factory=MotionNoise)
