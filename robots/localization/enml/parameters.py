"""Every parameter of episodic non-Markov localization: its unit, its default and where that is from.

Sources: *published* is the configuration that the authors of the method ship for their indoor
robots; *ours* was chosen once, on simulated and recorded runs together, and holds for all maps.
"""

from dataclasses import dataclass, fields
from math import isfinite, pi, radians


@dataclass(frozen=True, slots=True)
class EnmlParameters:
    """All angles in radians, distances in metres. Raises `ValueError` for what makes no sense."""

    min_translation_m: float = 0.3
    """A pose stays in the episode once the robot has moved this far since the last (published)."""
    min_rotation_rad: float = radians(5.0)
    """... or has turned this far (published)."""

    odometry_radial_rate: float = 0.1
    """Standard deviation along the motion, per metre moved (published)."""
    odometry_tangential_rate: float = 0.1
    """Standard deviation across the motion, per metre moved (published)."""
    odometry_angular_rate: float = 0.15
    """Standard deviation of the heading, per radian turned (ours; published 0.1)."""
    odometry_drift_rad_per_m: float = radians(1.0)
    """Standard deviation of the heading, per metre moved (ours: wheels slip when going straight)."""
    odometry_min_std_m: float = 0.005
    """Never trust a translation more than this (ours; published 0.001)."""
    odometry_min_std_rad: float = radians(0.3)
    """Never trust a rotation more than this (ours; published 1 degree)."""

    laser_std_m: float = 0.05
    """Standard deviation of a point's distance from what it was measured on (published)."""
    robust_width_m: float = 0.1
    """Distance at which a point's pull is half of what plain least squares gives it (ours)."""

    ltf_gate_m: float = 0.25
    """A point farther from the map's line than this is no long-term feature (published)."""
    ltf_widest_gate_m: float = 1.0
    """Where the gate starts when the prediction is at its most uncertain (ours)."""
    ltf_max_angle_rad: float = radians(35.0)
    """Largest angle between a point's normal and its line's (published)."""
    ltf_correlation: float = 1.0 / 20.0
    """How much one of many correlated rays counts (ours; published 1/50 over 1,000 rays)."""

    stf_gate_m: float = 0.15
    """Two points farther apart than this are not the same thing (published)."""
    stf_max_angle_rad: float = radians(25.0)
    """Largest angle between the normals of two corresponding points (published)."""
    stf_correlation: float = 1.0 / 40.0
    """How much one of many correlated correspondences counts (published)."""
    stf_min_matches: int = 10
    """Two poses with no more correspondences than this are not tied to each other (published)."""
    stf_separations: tuple[int, ...] = (1, 2, 4, 8, 16)
    """How many poses back correspondences are looked for (ours; published: every fourth pose)."""

    min_episode_length: int = 10
    """Poses that are kept even if nothing ties the newest to them (published)."""
    max_episode_length: int = 25
    """Poses after which the oldest is let go whatever ties it (ours; published 80)."""
    association_rounds: int = 4
    """At most this many rounds of association and optimization per update (published)."""
    solver_iterations: int = 10
    """Most Levenberg-Marquardt steps per round (published 30, with a slower loss)."""
    settled_m: float = 0.01
    """A pose that moved less keeps its ray cast and its correspondences (ours)."""
    settled_rad: float = radians(0.25)
    """... and turned less (ours)."""

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, float) and not (isfinite(value) and value > 0.0):
                raise ValueError(f"{field.name} must be a positive number, not {value!r}")
        if not 2 <= self.min_episode_length <= self.max_episode_length:
            raise ValueError(
                "min_episode_length must be at least 2 and at most max_episode_length "
                f"({self.max_episode_length}), not {self.min_episode_length}"
            )
        if self.association_rounds < 1 or self.solver_iterations < 1:
            raise ValueError("association_rounds and solver_iterations must be at least 1")
        if not self.stf_separations or min(self.stf_separations) < 1:
            raise ValueError("stf_separations must name at least one pose back, counted from 1")
        if self.ltf_widest_gate_m < self.ltf_gate_m:
            raise ValueError("ltf_widest_gate_m must not be below ltf_gate_m")
        if max(self.ltf_max_angle_rad, self.stf_max_angle_rad) > pi / 2:
            raise ValueError("angles between normals must not be above a right angle")
