"""`sensor_msgs/LaserScan` as scans, and how the laser sits."""

from math import cos, radians
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mend.localization.bags.rigid import Rigid, planar, upwards
from mend.localization.pose import Poses
from mend.localization.scan import InvalidScanError, Scan

STEEPEST_RAD = radians(10.0)
"""A laser tilted by more sees floor and ceiling, not walls."""


def mounts_of(transforms: Rigid) -> tuple[Poses, NDArray[np.bool_]]:
    """Where a laser sits in the robot's plane (n, 3), and whether it hangs upside down."""
    mounts = planar(transforms)
    return mounts, upwards(transforms) < 0.0


def is_level(transforms: Rigid) -> bool:
    """Whether a laser looks along the floor, as far as known."""
    known = transforms[np.isfinite(transforms).all(axis=1)]
    return bool((np.abs(upwards(known)) >= cos(STEEPEST_RAD)).all())


def scan_of(message: Any, time_s: float, mount: Poses, *, upside_down: bool) -> Scan:
    """The scan of a message, counter-clockwise as seen from above. Raises `InvalidScanError`.

    What is nearer than `range_min` is no return, as what is not finite or beyond `range_max`.
    """
    ranges = np.asarray(message.ranges, dtype=np.float64)
    # Written as "not nearer", so that NaN stays as it is without a warning.
    ranges = np.where(ranges < float(message.range_min), np.inf, ranges)
    first, step = float(message.angle_min), float(message.angle_increment)
    if step == 0.0 and len(ranges) > 1:
        step = (float(message.angle_max) - first) / (len(ranges) - 1)
    last = first + (len(ranges) - 1) * step
    if upside_down:
        first, last, step = -first, -last, -step
    if step < 0.0:
        ranges, first, step = ranges[::-1], last, -step
    farthest = float(message.range_max)
    if not farthest > 0.0:
        raise InvalidScanError("range_max has to be above 0")
    return Scan(ranges, first, step, farthest, time_s, mount)
