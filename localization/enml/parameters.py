"""Every parameter of episodic non-Markov localization: unit, default and where that is from.

Sources: *published* is the configuration that the authors of the method ship for their indoor
robots; *ours* was chosen once, on simulated and recorded runs together, and holds for all maps.
"""

from dataclasses import dataclass, fields
from math import isfinite, pi, radians


@dataclass(frozen=True, slots=True)
class EnmlParameters:
    """All angles in radians, distances in metres. Raises `ValueError` for what makes no sense."""

    min_translation_m: float = 0.3
    """A pose stays in the episode once the robot has moved this far since the last (published).
    Scans that are closer together say much the same: as evidence of having been carried they count
    for less, and a lost robot searches again only after so much."""
    min_rotation_rad: float = radians(5.0)
    """... or has turned this far (published)."""

    odometry_rate: float = 0.1
    """Standard deviation along the motion and across, per metre moved (published)."""
    odometry_angular_rate: float = 0.15
    """Standard deviation of the heading, per radian turned (ours; published 0.1)."""
    odometry_drift_rad_per_m: float = radians(1.0)
    """Standard deviation of the heading, per metre moved (ours: wheels slip)."""
    odometry_min_std_m: float = 0.02
    """Never trust a translation more than this (ours; published 0.001)."""
    odometry_min_std_rad: float = radians(1.0)
    """Never trust a rotation more than this (published)."""

    odometry_scale_std: float = 0.1
    """Standard deviation of how much too long or too short wheels tell all ways, and turns, before
    that is learned (ours)."""

    odometry_robust_width: float = 2.0
    """Standard deviations at which odometry's pull is half of what plain least squares gives it
    (ours: wheels that slip are wrong by more than noise)."""

    laser_std_m: float = 0.05
    """Standard deviation of a point's distance from what it was measured on (published), and where
    its pull is half of what plain least squares gives it (ours)."""

    gate_m: float = 0.15
    """A point farther from the map's line than this is no long-term feature, and two points farther
    apart are not the same thing (published for the latter, for lines 0.25: among furniture, too
    much of what stands near walls is then taken for them)."""
    ltf_max_angle_rad: float = radians(35.0)
    """Largest angle between a point's normal and its line's (published)."""
    ltf_correlation: float = 1.0 / 20.0
    """How much one of many correlated rays counts (ours; published 1/50 over 1,000 rays)."""

    stf_max_angle_rad: float = radians(25.0)
    """Largest angle between the normals of two corresponding points (published)."""
    stf_correlation: float = 1.0 / 10.0
    """How much one of many correlated correspondences counts (ours; published 1/40: what one robot
    saw from two places is more surely one thing than what it sees near a line of the map)."""
    stf_min_matches: int = 10
    """Two poses with no more correspondences than this are not tied to each other (published)."""
    stf_separations: tuple[int, ...] = (1, 2, 4, 8, 16)
    """How many poses back correspondences are looked for (ours; published: every fourth pose)."""

    covered_within_m: float = 0.4
    """A scan in which hardly anything is farther away than this shows what covers the laser,
    and is not used (ours)."""
    blind_for_m: float = 4.0
    """A robot that has driven this far without seeing anything is lost (ours)."""

    min_episode_length: int = 10
    """Poses that are kept even if nothing ties the newest to them (published), and so many of the
    newest that the pre-alignment lays a scan over (ours)."""
    max_episode_length: int = 25
    """Poses after which the oldest is let go whatever ties it (ours; published 80), and about so
    many tell how much usually changes around the robot."""
    alignment_weight: float = 0.25
    """How much one of many correlated rays counts in the pre-alignment (ours)."""

    carried_per_m: float = 1e-3
    """How often a robot is carried away, or loses its way, per metre driven: the prior."""
    tells_at_most: float = 5.0
    """No scan changes the logarithm of the odds by more than this (ours: one alone is not
    enough)."""
    recognized_share: float = 0.6
    """So much of what is on no map, less what changed, is recognized from a scan just before, at
    first (ours: 0.2 to 0.7 in made-up drives and logs, the latter where much is on no map)..."""
    recognized_spread: float = 0.2
    """... with this standard deviation (ours: 0.1 to 0.25); later as it was of late."""
    map_counts: float = 0.1
    """How much a scan's likelihood on the map counts..."""
    map_misleads: float = 20.0
    """... beyond so much that it is likelier anywhere than where the robot is (ours: where a map is
    out of date, it is so for many metres; less than 30 in all but a hundredth of such drives)."""
    fitting_tells_at_most: float = 1.0
    """... and what fits the map speaks for being here by no more than this, as other places of a
    building look the same (ours)."""
    off_map_for_m: float = 40.0
    """A robot that has driven this far where the map shows nothing is lost (ours: what it sees
    twice leads it a metre astray in some 100 m)."""
    found_above: float = 10.0
    """How much likelier what is seen has to be at the place where a lost robot is found than
    anywhere (ours; logarithm per scan)."""
    known_within_m: float = 2.5
    """A robot that is put down with a wider standard deviation may be anywhere (published as the
    reach of its search)."""
    recovery_lead: float = 5.0
    """How much likelier the place has to be than all others, at first (ours; logarithm per
    scan)..."""
    recovery_patience_m: float = 8.0
    """... which becomes less until, after half of this way, half of it will do (ours)."""
    drifted_counts: float = 10.0
    """How much likelier it is, where nothing strange was seen, that a lost robot has drifted off to
    near by than that it is somewhere else (ours; logarithm per scan)."""
    found_is_wrong: float = 0.1
    """How probable it is at first that a place which was found is not the right one (ours)..."""
    probation_m: float = 5.0
    """... and it is held against the others that were open for this far (ours)."""

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
        if not self.stf_separations or min(self.stf_separations) < 1:
            raise ValueError("stf_separations must name at least one pose back, counted from 1")
        for name in ("ltf_max_angle_rad", "stf_max_angle_rad"):
            if getattr(self, name) > pi / 2:
                raise ValueError(f"{name} must not be above a right angle")
