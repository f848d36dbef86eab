"""Whether a laser sees through a door: then that is not shut, whatever stands in it."""

import numpy as np
from numpy.typing import NDArray

from mend.robots.base.body import BasePose, RangeScan

Posts = tuple[tuple[float, float], tuple[float, float]]
Matrix = NDArray[np.float64]

_BEYOND_M = 0.3
"""A beam that ends so far beyond the plane of a door leads through it, also where the map is a
little off: along the beam that may be much where it meets the door aslant."""
_SHARE = 0.1
"""Of the beams between its posts so many do; there is a gap beneath and beside any door."""


def sees_through(scan: RangeScan, here: BasePose, posts: Posts) -> bool:
    """`here`: of the laser, in the frame of the posts. Beams that do not come back tell nothing."""
    angles = scan.angles_rad + here.yaw
    rays = np.column_stack([np.cos(angles), np.sin(angles)])
    away = np.array(posts[0]) - (here.x, here.y)
    along = np.array(posts[1]) - np.array(posts[0])
    across = _cross(rays, along)
    with np.errstate(all="ignore"):
        reached_m = _cross(away, along) / across
        share = _cross(away, rays) / across
        beyond_m = (scan.ranges_m - reached_m) * np.abs(across) / np.hypot(*along)
    between = (reached_m > 0.0) & (share > 0.0) & (share < 1.0) & np.isfinite(scan.ranges_m)
    through = between & (beyond_m > _BEYOND_M)
    return bool(through.sum() > _SHARE * between.sum())


def _cross(a: Matrix, b: Matrix) -> Matrix:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
