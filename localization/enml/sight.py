"""Whether the laser shows the place at all, and for how long it has not."""

from math import exp2

from mend.localization.enml.parameters import EnmlParameters
from mend.localization.points import DEFAULT_MAX_RANGE_M, ScanPoints, scan_points
from mend.localization.scan import Scan

_FEW_RETURNS = 10
"""Fewer show nothing, unless the laser has hardly more beams."""


class Sight:
    """Takes scans in, and counts the way driven since one of them showed something."""

    def __init__(self, parameters: EnmlParameters) -> None:
        self._parameters = parameters
        self._blind_m: float | None = None

    def take(self, scan: Scan, moved_m: float) -> ScanPoints:
        """What a scan shows after a motion: nothing, where something is right over the laser."""
        covered = scan.is_covered(self._parameters.covered_within_m)
        points = scan_points(scan, max_range=0.0 if covered else DEFAULT_MAX_RANGE_M)
        if len(points) >= min(_FEW_RETURNS, len(scan.ranges) // 2):
            self._blind_m = None
        else:
            self._blind_m = 0.0 if self._blind_m is None else self._blind_m + moved_m
        return points

    @property
    def is_gone(self) -> bool:
        """Whether the robot has been blind for too long to know where it is."""
        return self._blind_m is not None and self._blind_m >= self._parameters.blind_for_m

    def doubted(self, lost: float) -> float:
        """A lost measure (0 to 1) with what a blind robot cannot know about its place."""
        if self._blind_m is None:
            return lost
        known = exp2(-1.0 - self._blind_m / self._parameters.blind_for_m)
        return 1.0 - (1.0 - lost) * known
