"""Whether a robot was carried between two scans: what it sees stands behind what stood there."""

import numpy as np

from robots.localization.enml.pose_node import PoseNode
from robots.localization.enml.problem import Floats
from robots.localization.pose import Poses, compose, relative, transform

_THROUGH_M = 0.4


def seen_through(earlier: PoseNode, earlier_pose: Poses, later: PoseNode, pose: Poses) -> float:
    """The share of a later pose's points from behind what the earlier pose saw.

    Who stands in front of a robot hides much from it, but nobody lets it see through walls.
    """
    if not len(earlier.ranges_m) or not len(later.scan_points):
        return 0.0
    sensor = compose(earlier_pose, earlier.sensor_offset)
    points = transform(relative(sensor, pose), later.scan_points.points)
    before_m = _ranges_at(earlier, np.arctan2(points[:, 1], points[:, 0]))
    return float(np.mean(np.hypot(*points.T) > before_m + _THROUGH_M))


def _ranges_at(node: PoseNode, bearings: Floats) -> Floats:
    """What a pose saw along some bearings; infinite where it did not look."""
    after_first = np.mod(bearings - node.bearings[0], 2.0 * np.pi)
    looked = node.bearings - node.bearings[0]
    found = np.interp(after_first, looked, node.ranges_m)
    return np.where(after_first <= looked[-1], found, np.inf)
