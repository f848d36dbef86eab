"""Every parameter of episodic non-Markov localization: unit, default and where that is from.

Sources: *published* is the configuration that the authors of the method ship for their indoor
robots; *ours* was chosen once, on simulated and recorded runs together, and holds for all maps.
"""

from dataclasses import dataclass, fields
from math import isfinite, pi, radians

_GATE_DEVIATIONS = 3.0


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
    """Standard deviation along the motion and across, per metre moved (published), and of how much
    too long or too short all ways are told, before that is learned."""
    odometry_angular_rate: float = 0.15
    """Standard deviation of the heading, per radian turned (ours; published 0.1), and of how much
    too far or too little all turns are told."""
    odometry_drift_rad_per_m: float = radians(1.0)
    """Standard deviation of the heading, per metre moved (ours: wheels slip)."""

    odometry_robust_width: float = 2.0
    """Standard deviations at which odometry's pull is half of what plain least squares gives it
    (ours: wheels that slip are wrong by more than noise)."""

    laser_std_m: float = 0.05
    """Standard deviation of a point's distance from what it was measured on (published), and where
    its pull is half of what plain least squares gives it (ours)."""

    max_angle_rad: float = radians(30.0)
    """Largest angle between a point's normal and its line's (published 35 degrees), and between
    those of two points that are the same thing (published 25)."""
    ltf_correlation: float = 1.0 / 20.0
    """How much one of many correlated rays counts (ours; published 1/50 over 1,000 rays)."""

    stf_correlation: float = 1.0 / 10.0
    """How much one of many correlated correspondences counts (ours; published 1/40: what one robot
    saw from two places is more surely one thing than what it sees near a line of the map)."""
    stf_min_matches: int = 10
    """Two poses with no more correspondences than this are not tied to each other (published)."""

    covered_within_m: float = 0.4
    """A scan in which hardly anything is farther away than this shows what covers the laser,
    and is not used (ours)."""
    blind_for_m: float = 4.0
    """A robot that has driven this far is among other things (ours): without seeing anything it is
    lost by then, half the lead will do for a place of what it saw since it was lost, and so long a
    place that was found is held against the others that were open."""

    min_episode_length: int = 10
    """Poses that are kept even if nothing ties the newest to them (published), and so many of the
    newest that the pre-alignment lays a scan over (ours)."""
    max_episode_length: int = 25
    """Poses after which the oldest is let go whatever ties it (ours; published 80), and about so
    many tell how much usually changes around the robot."""

    carried_per_m: float = 1e-3
    """How often a robot is carried away, or loses its way, per metre driven: the prior."""
    tells_at_most: float = 5.0
    """No scan changes the logarithm of the odds by more than this (ours: one alone is not
    enough); a place is clear at once that leads all others by as much, per scan."""
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
    anywhere (ours; logarithm per scan), and so much likelier it is near by where nothing strange
    was seen, as it has then drifted off."""
    known_within_m: float = 2.5
    """A robot that is put down with a wider standard deviation may be anywhere (published as the
    reach of its search)."""

    @property
    def gate_m(self) -> float:
        """A point farther from the map's line than this is no long-term feature, and two points
        farther apart are not the same thing.

        As published for the latter; for lines 0.25: among furniture, too much of what stands near
        walls is then taken for them.
        """
        return _GATE_DEVIATIONS * self.laser_std_m

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
        if self.max_angle_rad > pi / 2:
            raise ValueError("max_angle_rad must not be above a right angle")
