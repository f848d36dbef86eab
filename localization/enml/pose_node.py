"""A pose of the episode: what was seen from it, how the robot came there, what it was taken for."""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from mend.localization.enml.motion_model import Travel
from mend.localization.enml.point_buckets import PointBuckets
from mend.localization.enml.problem import Floats, Indices
from mend.localization.points import DEFAULT_MAX_RANGE_M, ScanPoints
from mend.localization.scan import Scan


@dataclass(frozen=True, slots=True, eq=False)
class LtfMatches:
    """Points (robot's frame) that lie on lines of the map, their rows, and those lines.

    A line is normal . point + offset = 0 in the map's frame.
    """

    rows: Indices
    points: Floats
    normals: Floats
    offsets: Floats

    @classmethod
    def none(cls) -> "LtfMatches":
        """Nothing lies on the map."""
        nothing = np.zeros((0, 2))
        return cls(np.zeros(0, dtype=np.int64), nothing, nothing, np.zeros(0))


@dataclass(slots=True, eq=False)
class PoseNode:
    """Scan points in the robot's frame, with bearings from the sensor, and their classification.

    `travel` leads here from the pose before. `cast_pose` is where `seen` (the segment of the map
    along each bearing) and `ltf` were found; None as long as nothing was. `gate_m` is the widest
    distance from a line at which a point of this pose still counts as on it. `buckets` find the
    points near a place.
    """

    identity: int
    scan_points: ScanPoints
    beam_spacing_rad: float
    bearings: Floats
    ranges_m: Floats
    sensor_offset: Floats
    travel: Travel
    gate_m: float
    buckets: PointBuckets
    cast_pose: Floats | None = None
    cast_gate_m: float = 0.0
    expected_m: Floats = field(default_factory=lambda: np.zeros(0))
    ltf: LtfMatches = field(default_factory=LtfMatches.none)
    is_ltf: NDArray[np.bool_] = field(init=False)
    is_stf: NDArray[np.bool_] = field(init=False)

    def __post_init__(self) -> None:
        points = self.scan_points
        self.is_ltf = np.zeros(len(points), dtype=np.bool_)
        self.is_stf = np.zeros(len(points), dtype=np.bool_)

    @classmethod
    def of(
        cls,
        identity: int,
        scan: Scan,
        scan_points: ScanPoints,
        travel: Travel,
        gate_m: float,
    ) -> "PoseNode":
        """What one scan contributes to the episode.

        Points of two scans within `gate_m` of each other may be the same thing.
        """
        return cls(
            identity,
            scan_points,
            scan.angle_increment,
            scan.angles[scan_points.beams],
            scan.ranges[scan_points.beams],
            scan.sensor_offset,
            travel,
            gate_m,
            PointBuckets.of(scan_points, gate_m),
        )

    @property
    def reach_m(self) -> float:
        """How far the map has to be known to say something about what was seen from here."""
        farthest_m = float(self.ranges_m.max()) if len(self.ranges_m) else 0.0
        return min(farthest_m + 1.0, DEFAULT_MAX_RANGE_M)

    def off_map(self) -> "PoseNode":
        """The same, with nothing of it on a map."""
        return replace(self, cast_pose=None, expected_m=np.zeros(0), ltf=LtfMatches.none())
