"""Laser scans, and what makes one unusable."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from mend.errors import WrongInputError
from mend.localization.pose import Poses


class InvalidScanError(WrongInputError, ValueError):
    """A scan or a motion that no localizer can use; the message is one sentence."""


def _no_offset() -> Poses:
    return np.zeros(3)


@dataclass(frozen=True, slots=True, eq=False)
class Scan:
    """The ranges of one sweep in metres, counter-clockwise; angles are in the sensor's frame.

    A range that is not finite, not positive, or at least `max_range` is no return.
    `sensor_offset` is the sensor's pose in the robot's frame. Raises `InvalidScanError`.
    """

    ranges: NDArray[np.float64]
    angle_min: float
    angle_increment: float
    max_range: float
    time_s: float = 0.0
    sensor_offset: Poses = field(default_factory=_no_offset)

    def __post_init__(self) -> None:
        ranges = np.asarray(self.ranges, dtype=np.float64)
        if ranges.ndim != 1 or not 2 <= len(ranges) <= MAX_BEAMS:
            raise InvalidScanError(
                f"a scan needs 2 to {MAX_BEAMS} ranges in a row, not shape {ranges.shape}"
            )
        offset = np.asarray(self.sensor_offset, dtype=np.float64)
        if offset.shape != (3,) or not np.isfinite(offset).all():
            raise InvalidScanError("the sensor's offset needs 3 finite numbers (x, y, theta)")
        if not np.isfinite([self.angle_min, self.angle_increment, self.time_s]).all():
            raise InvalidScanError("the angles and the time of a scan have to be finite")
        if self.angle_increment <= 0.0 or not self.max_range > 0.0:
            raise InvalidScanError(
                f"angle_increment and max_range have to be above 0, "
                f"not {self.angle_increment:g} and {self.max_range:g}"
            )
        object.__setattr__(self, "ranges", ranges)
        object.__setattr__(self, "sensor_offset", offset)

    @property
    def angles(self) -> NDArray[np.float64]:
        """The angle of each beam in radians, in the sensor's frame."""
        beams = np.arange(len(self.ranges), dtype=np.float64)
        return self.angle_min + beams * self.angle_increment

    def returns(self, min_range: float, max_range: float) -> NDArray[np.bool_]:
        """Which beams came back from between two ranges (metres), and from within the sensor's."""
        with np.errstate(invalid="ignore"):
            usable: NDArray[np.bool_] = (
                np.isfinite(self.ranges)
                & (self.ranges > max(min_range, 0.0))
                & (self.ranges < min(max_range, self.max_range))
            )
        return usable

    def is_covered(self, within_m: float) -> bool:
        """Whether the laser sees hardly anything but what is nearer than that, all around."""
        near = int(self.returns(0.0, within_m).sum())
        beyond = int(self.returns(within_m, self.max_range).sum())
        return 2 * near > len(self.ranges) and beyond < _LEAST_BEYOND_COVER * (near + beyond)


MAX_BEAMS = 100_000
"""No planar laser has more beams; more is a mistake, not a scan."""
_LEAST_BEYOND_COVER = 0.1
"""A laser with a smaller share of its returns from farther away than its cover sees no place."""


class ScanStream:
    """Refuses what cannot follow the scans before it."""

    def __init__(self) -> None:
        self._beams: int | None = None
        self._time_s = -np.inf

    def accept(self, odometry: Poses, scan: Scan) -> Poses:
        """The checked motion. Raises `InvalidScanError`, and then remembers nothing of it."""
        motion = np.asarray(odometry, dtype=np.float64)
        if motion.shape != (3,) or not np.isfinite(motion).all():
            raise InvalidScanError("odometry needs 3 finite numbers (x, y, theta)")
        if self._beams is not None and len(scan.ranges) != self._beams:
            raise InvalidScanError(
                f"expected {self._beams} ranges as in the scans before, found {len(scan.ranges)}"
            )
        if scan.time_s < self._time_s:
            raise InvalidScanError(
                f"the scan's time, {scan.time_s:g} s, is before the last one's, {self._time_s:g} s"
            )
        self._beams = len(scan.ranges)
        self._time_s = scan.time_s
        return motion
