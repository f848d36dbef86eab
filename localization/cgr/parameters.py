"""The parameters of corrective gradient refinement, each with unit, default and source.

"Published" is the configuration that its authors drove with.
"""

from dataclasses import dataclass
from math import radians

from mend.localization.particles.parameters import ParticleParameters


@dataclass(frozen=True, slots=True, kw_only=True)
class CgrParameters(ParticleParameters):
    """The same everywhere."""

    particles: int = 20
    """Published."""
    refinements: int = 3
    """Steps per scan; published."""
    attracted_within_m: float = 0.5
    """How far from its line a point still pulls; published."""
    attracted_within_rad: float = radians(30.0)
    """Between the normals of point and line; published."""
    margin_m: float = 0.1
    """How far beyond the end of a segment a point still belongs to it; published."""
    place_share: float = 0.4
    """How much of the mean pull one step follows; published."""
    turn_share: float = 0.2
    """The same for the heading; published."""
    step_m: float = 0.1
    """The longest step; published."""
    step_rad: float = radians(10.0)
    """The largest turn of a step; published."""
    least_explained: float = 0.15
    """With a smaller share of the points to go by, a particle is not refined."""
    deviation_m: float = 0.1
    """Of a point from its line: laser noise and the map's error together."""
    surprise_m: float = 0.5
    """A point farther off than this counts as one that is so far off."""
    trust: float = 0.02
    """Exponent of a scan's likelihood, since its returns err together."""
    jitter_m: float = 0.05
    """Spread of particles drawn more than once; published."""
    jitter_rad: float = radians(5.0)
    """The same for the heading; published."""
