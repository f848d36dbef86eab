"""How well a pose explains a scan: the beam model of range finders.

Thrun, Burgard and Fox, Probabilistic Robotics (2005), section 6.3: a range is a hit on the map's
first wall, something unmapped before it, or random. What did not return says nothing here.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mend.localization.pose import Poses, compose
from mend.localization.scan import Scan
from mend.maps.compiled import compiled
from mend.maps.segment_grid import cast_rays, segment_grid
from mend.maps.vector_map import VectorMap

Matrix = NDArray[np.float64]


class BeamModelParameters(NamedTuple):
    """Weights as for a floor on which half of what is seen is on no map."""

    hit_share: float = 0.6
    short_share: float = 0.25
    random_share: float = 0.15
    hit_deviation_m: float = 0.2
    """Laser noise, the map's error, and a track that is right to some ten centimetres."""
    short_decay_per_m: float = 0.5
    """Of the exponential density of what stands before a wall."""
    max_range_m: float = 30.0
    beams: int = 60
    """Returns used of a scan, evenly spread: neighbours say nearly the same."""
    trust: float = 0.35
    """Exponent of a scan's likelihood, since its returns err together; both as Mend's MCL has."""
    matched_within_m: float = 0.3
    """A return this near the expected range is put down to the map."""


@dataclass(frozen=True, slots=True, eq=False)
class Beams:
    """What is kept of a scan to weigh poses with: ranges (metres) and bearings (radians)."""

    ranges: Matrix
    bearings: Matrix
    """In the robot's frame."""
    mount: Poses


def log_densities(ranges: Matrix, expected: Matrix, parameters: BeamModelParameters) -> Matrix:
    """Of ranges, where the map's first wall is expected at others (metres, alike in shape)."""
    ranges, expected = np.broadcast_arrays(ranges, expected)
    found = np.empty(ranges.shape)
    weigh_ranges(
        np.ascontiguousarray(ranges).reshape(-1),
        np.ascontiguousarray(expected).reshape(-1),
        parameters,
        found.reshape(-1),
    )
    return found


@compiled
def weigh_ranges(
    ranges: Matrix, expected: Matrix, parameters: BeamModelParameters, found: Matrix
) -> None:
    """The kernel of `log_densities`."""
    for index in range(ranges.shape[0]):
        found[index] = log_density(ranges[index], expected[index], parameters)


@compiled
def log_density(range_m: float, expected_m: float, parameters: BeamModelParameters) -> float:
    """Of one range, where the map's first wall is expected at another."""
    its = parameters
    deviation = (range_m - expected_m) / its.hit_deviation_m
    hit = np.exp(-0.5 * deviation**2) / (its.hit_deviation_m * np.sqrt(2.0 * np.pi))
    density = its.hit_share * hit + its.random_share / its.max_range_m
    if range_m < expected_m:
        decay = its.short_decay_per_m
        short = decay * np.exp(-decay * range_m) / max(1.0 - np.exp(-decay * expected_m), 1e-6)
        density += its.short_share * short
    return float(np.log(density))


def spread(count: int, most: int) -> NDArray[np.int64]:
    """At most so many of `count` beams, evenly spread: neighbours say nearly the same."""
    return np.linspace(0, count - 1, min(most, count)).round().astype(np.int64)


class BeamModel:
    """Log-likelihoods of scans at poses on one map."""

    def __init__(
        self, vector_map: VectorMap, parameters: BeamModelParameters | None = None
    ) -> None:
        self._grid = segment_grid(vector_map.segments)
        self._parameters = parameters or BeamModelParameters()

    def beams_of(self, scan: Scan) -> Beams:
        """The returns that are used of a scan."""
        its = self._parameters
        returned = np.flatnonzero(scan.returns(0.0, its.max_range_m))
        used = returned[spread(len(returned), its.beams)]
        bearings = scan.angles[used] + scan.sensor_offset[2]
        return Beams(scan.ranges[used], bearings, scan.sensor_offset)

    def log_likelihood(self, pose: Poses, beams: Beams) -> float:
        """Of a scan at one pose, tempered by the trust in a scan."""
        expected = self._expected(pose, beams)
        return self._parameters.trust * float(
            log_densities(beams.ranges, expected, self._parameters).sum()
        )

    def matched_share(self, pose: Poses, beams: Beams) -> float:
        """The share of the returns that the map foretells from a pose; 0 where there is none."""
        if not len(beams.ranges):
            return 0.0
        away = np.abs(beams.ranges - self._expected(pose, beams))
        return float((away < self._parameters.matched_within_m).mean())

    def _expected(self, pose: Poses, beams: Beams) -> Matrix:
        sensor = compose(pose, beams.mount)
        sensor[2] = pose[2]
        ranges = np.empty(len(beams.bearings))
        seen = np.empty(len(beams.bearings), dtype=np.int64)
        cast_rays(self._grid, sensor, beams.bearings, self._parameters.max_range_m, ranges, seen)
        return ranges
