"""How far the beams of a scan see that are next to a point."""

import math
from typing import Any

import numpy as np

from mend.maps.compiled import compiled


@compiled
def measure_beside(
    points: Any, pose: Any, angles: Any, ranges_m: Any, far_m: float, away_m: Any, sees_m: Any
) -> None:
    """Write how far points (n, 2) are from a laser, and how far the beams next to them see.

    `pose` is the laser's x, y and yaw in the points' frame, `angles` (m,) ascend from it. `sees_m`
    (n,) is the less of both beams; nan where none is, and of points that are `far_m` away or more.
    """
    count = angles.shape[0]
    # A full circle ends where it begins.
    closed = angles[-1] - angles[0] > math.tau - 2.0 * math.tau / count
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    for number in range(points.shape[0]):
        x, y = points[number, 0] - pose[0], points[number, 1] - pose[1]
        ahead, left = cos * x + sin * y, cos * y - sin * x
        away_m[number], sees_m[number] = math.hypot(ahead, left), math.nan
        if away_m[number] >= far_m:
            continue
        bearing = angles[0] + (math.atan2(left, ahead) - angles[0]) % math.tau
        after = np.searchsorted(angles, bearing)
        if after < count or closed:
            sees_m[number] = min(ranges_m[after - 1], ranges_m[after % count])
