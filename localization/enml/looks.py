"""What some scans of an episode say about a place for its newest pose."""

from dataclasses import dataclass

import numpy as np

from mend.localization.distance_field import DistanceField
from mend.localization.enml.episode import Episode
from mend.localization.enml.lost import MapFit, evidence
from mend.localization.enml.pose_node import PoseNode
from mend.localization.enml.problem import Floats
from mend.localization.enml.visible import Visible
from mend.localization.pose import Poses, compose, relative, transform, turn

_MOST_BEAMS = 120
_ON_WALL_M = 0.15
_SHARP_M = 0.08
"""Right places explain what they explain to within the laser's and the map's errors."""
_IN_VIEW_M = 2.0
_ROUGHLY_M = 0.4
"""How far ranges are off at a place of the lattice next to the right one."""
_ROUGHLY_BEHIND_COUNTS = 2.0


@dataclass(frozen=True, slots=True, eq=False)
class ScanLook:
    """Some beams of one scan: sensor's pose, points and normals in the frame of the newest pose."""

    sensor: Poses
    points: Floats
    normals: Floats
    bearings: Floats
    ranges_m: Floats
    reach_m: float


@dataclass(frozen=True, slots=True)
class Weight:
    """What speaks for a place, and how sharply what is on the map fits it (returns)."""

    evidence: MapFit
    sharp: float


def looks_of(episode: Episode, scans: int, most_beams: int = _MOST_BEAMS) -> list[ScanLook]:
    """So many scans, spread over an episode, the newest among them; of each so many beams."""
    newest = episode.poses[-1]
    return [
        look_of(episode.nodes[index], relative(newest, episode.poses[index]), most_beams)
        for index in np.unique(np.linspace(len(episode) - 1, 0, scans).astype(int))[::-1]
    ]


def look_of(node: PoseNode, pose: Poses, most_beams: int = _MOST_BEAMS) -> ScanLook:
    """So many beams of a scan, from its pose in the frame of the newest pose."""
    some = slice(None, None, max(-(-len(node.bearings) // most_beams), 1))
    return ScanLook(
        compose(pose, node.sensor_offset),
        transform(pose, node.scan_points.points[some]),
        turn(float(pose[2]), node.scan_points.normals[some]),
        np.ascontiguousarray(node.bearings[some]),
        np.ascontiguousarray(node.ranges_m[some]),
        node.reach_m,
    )


def weigh(visible: Visible, field: DistanceField, looks: list[ScanLook], place: Poses) -> Weight:
    """What the looks say about the newest pose being at a place."""
    total, sharp = MapFit(), 0.0
    for look in looks:
        sensor = compose(place, look.sensor)
        expected_m = visible.cast(sensor, look.bearings, look.reach_m)
        away_m = field.at(transform(place, look.points))
        in_view = np.abs(look.ranges_m - expected_m) < _IN_VIEW_M
        on_map = (away_m < _ON_WALL_M) & in_view
        total = total.faded(1.0, evidence(look.ranges_m, expected_m, on_map))
        sharp += float(np.exp(-0.5 * (away_m[in_view] / _SHARP_M) ** 2).sum())
    return Weight(total, sharp)


def glance(visible: Visible, look: ScanLook, place: Poses) -> float:
    """At most 1: how well a look fits a place that may be off by some decimetres."""
    if not len(look.ranges_m):
        return 0.0
    sensor = compose(place, look.sensor)
    expected_m = visible.cast(sensor, look.bearings, look.reach_m)
    beyond_m = look.ranges_m - expected_m
    on_map = np.mean(np.abs(beyond_m) < _ROUGHLY_M)
    behind = np.mean(beyond_m > 2.0 * _ROUGHLY_M)
    return float(on_map - _ROUGHLY_BEHIND_COUNTS * behind)
