"""The parameters of Monte Carlo localization, each with unit, default and why."""

from dataclasses import dataclass
from math import radians

from mend.localization.particles.parameters import ParticleParameters


@dataclass(frozen=True, slots=True, kw_only=True)
class MclParameters(ParticleParameters):
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
    min_move_m: float = 0.02
    min_turn_rad: float = radians(1.0)
    """Scans from one place are looked at once: again and again they would say nothing new."""
    resample_below: float = 0.5
    """Resample when fewer than this share of the particles count."""
