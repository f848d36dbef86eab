"""What some scans of an episode say about a place for its newest pose."""

from dataclasses import dataclass

import numpy as np

from mend.localization.beam_model import BeamModelParameters, log_densities
from mend.localization.enml.episode import Episode
from mend.localization.enml.pose_node import PoseNode
from mend.localization.enml.problem import Floats
from mend.localization.enml.visible import Visible
from mend.localization.pose import Poses, compose, relative, transform, turn

_MOST_BEAMS = 120
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


def looks_of(
    episode: Episode, scans: int, most_beams: int = _MOST_BEAMS, newest: int | None = None
) -> list[ScanLook]:
    """So many scans, spread over an episode, the newest among them; of each so many beams.

    Only of the `newest` poses, unless that is None.
    """
    last = len(episode) - 1
    first = 0 if newest is None else max(len(episode) - newest, 0)
    return [
        look_of(episode.nodes[index], relative(episode.poses[-1], episode.poses[index]), most_beams)
        for index in np.unique(np.linspace(last, first, scans).astype(int))[::-1]
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


def log_likelihood(
    visible: Visible, looks: list[ScanLook], place: Poses, model: BeamModelParameters
) -> float:
    """Of the newest pose being at a place, per scan."""
    total = 0.0
    for look in looks:
        expected_m = visible.cast(compose(place, look.sensor), look.bearings, look.reach_m)
        if len(expected_m):
            total += float(log_densities(look.ranges_m, expected_m, model).mean())
    return model.trust * model.beams * total / len(looks)


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
