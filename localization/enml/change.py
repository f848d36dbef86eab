"""What changed between two scans: what stood there is gone, or something stands where was none."""

import numpy as np
from numpy.typing import NDArray

from mend.localization.enml.pose_node import PoseNode
from mend.localization.enml.problem import Floats
from mend.localization.pose import Poses, compose, relative, transform

_THROUGH_M = 0.3
_BEAMS_ASIDE = 2
"""A point is seen through only if its neighbouring beams go past it too: edges move a little."""
_GAP_IN_BEAMS = 2.5
_LEAST_COMPARED = 20


def changed(earlier: PoseNode, earlier_pose: Poses, later: PoseNode, pose: Poses) -> float:
    """What vanished and what appeared between two scans, in shares of what both looked at (0 to 2).

    In a world that stands still neither happens, however far the robot moves: no beam goes
    through what another scan saw.
    """
    return seen_through(later, pose, earlier, earlier_pose) + seen_through(
        earlier, earlier_pose, later, pose
    )


def seen_through(seer: PoseNode, seer_pose: Poses, seen: PoseNode, seen_pose: Poses) -> float:
    """The share of what one scan saw, within another's view, that the other's beams go through."""
    if len(seer.bearings) < 2 * _BEAMS_ASIDE or not len(seen.scan_points):
        return 0.0
    sensor = compose(seer_pose, seer.sensor_offset)
    points = transform(relative(sensor, seen_pose), seen.scan_points.points)
    free_m, looked = _free_at(seer, np.arctan2(points[:, 1], points[:, 0]))
    if looked.sum() < _LEAST_COMPARED:
        return 0.0
    through = free_m[looked] > np.hypot(*points[looked].T) + _THROUGH_M
    return float(np.mean(through))


def _free_at(node: PoseNode, bearings: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """How far the beams around some bearings went, and whether any looked there."""
    count = len(node.bearings)
    around = node.bearings[0] + np.mod(bearings - node.bearings[0], 2.0 * np.pi)
    after = np.searchsorted(node.bearings, around)
    inside = np.clip(after, 1, count - 1)
    gaps = node.bearings[inside] - node.bearings[inside - 1]
    looked = (after > 0) & (after < count) & (gaps < _GAP_IN_BEAMS * node.beam_spacing_rad)
    aside = after[:, None] + np.arange(-_BEAMS_ASIDE, _BEAMS_ASIDE)
    return node.ranges_m[np.clip(aside, 0, count - 1)].min(axis=1), looked
