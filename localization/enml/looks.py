"""What some scans of an episode say about places for its newest pose."""

from typing import NamedTuple

import numpy as np

from mend.localization.beam_model import BeamModelParameters, log_density
from mend.localization.enml.episode import Episode
from mend.localization.enml.problem import Floats, Indices
from mend.localization.pose import compose, relative, transform, turn
from mend.maps.compiled import compiled
from mend.maps.segment_grid import SegmentGrid, cast_ray

_MOST_BEAMS = 120
_ROUGHLY_M = 0.4
"""How far ranges are off at a place of the lattice next to the right one."""
_ROUGHLY_BEHIND_COUNTS = 2.0


class Looks(NamedTuple):
    """Some beams of some scans, in the frame of the newest pose; kernels take it as it is."""

    sensors: Floats
    """The sensor's pose at each scan (n, 3)."""
    starts: Indices
    """Where each scan's beams begin, and one more."""
    points: Floats
    normals: Floats
    bearings: Floats
    """In the sensor's frame."""
    ranges_m: Floats
    reaches_m: Floats
    """How far the map has to be known for each scan."""


def looks_of(
    episode: Episode, scans: int, most_beams: int = _MOST_BEAMS, newest: int | None = None
) -> Looks:
    """So many scans, spread over an episode, the newest among them; of each so many beams.

    Only of the `newest` poses, unless that is None.
    """
    last = len(episode) - 1
    first = 0 if newest is None else max(len(episode) - newest, 0)
    rows = np.unique(np.linspace(last, first, scans).astype(int))[::-1]
    nodes = [episode.nodes[row] for row in rows]
    poses = [relative(episode.poses[-1], episode.poses[row]) for row in rows]
    used = [slice(None, None, max(-(-len(each.bearings) // most_beams), 1)) for each in nodes]
    seen = list(zip(nodes, poses, used, strict=True))
    bearings = [node.bearings[some] for node, _, some in seen]
    return Looks(
        np.array([compose(pose, node.sensor_offset) for node, pose, _ in seen]),
        np.cumsum([0, *(len(each) for each in bearings)]),
        np.concatenate(
            [transform(pose, node.scan_points.points[some]) for node, pose, some in seen]
        ),
        np.concatenate(
            [turn(float(pose[2]), node.scan_points.normals[some]) for node, pose, some in seen]
        ),
        np.concatenate(bearings),
        np.concatenate([node.ranges_m[some] for node, _, some in seen]),
        np.array([node.reach_m for node in nodes]),
    )


@compiled
def log_likelihoods(
    grid: SegmentGrid, looks: Looks, places: Floats, model: BeamModelParameters, found: Floats
) -> None:
    """Of the newest pose being at each place (n, 3), per scan."""
    scans = looks.sensors.shape[0]
    for row in range(places.shape[0]):
        total = 0.0
        for scan in range(scans):
            first, last = looks.starts[scan], looks.starts[scan + 1]
            x, y, heading = placed(places[row], looks.sensors[scan])
            logs = 0.0
            for beam in range(first, last):
                angle = heading + looks.bearings[beam]
                expected_m, _ = cast_ray(
                    grid, x, y, np.cos(angle), np.sin(angle), looks.reaches_m[scan]
                )
                logs += log_density(looks.ranges_m[beam], expected_m, model)
            total += logs / max(last - first, 1)
        found[row] = model.trust * model.beams * total / scans


@compiled
def glances(grid: SegmentGrid, looks: Looks, places: Floats, found: Floats) -> None:
    """At most 1 each: how well the first look fits places that may be off by some decimetres."""
    count = looks.starts[1]
    for row in range(places.shape[0]):
        x, y, heading = placed(places[row], looks.sensors[0])
        merit = 0.0
        for beam in range(count):
            angle = heading + looks.bearings[beam]
            expected_m, _ = cast_ray(grid, x, y, np.cos(angle), np.sin(angle), looks.reaches_m[0])
            beyond_m = looks.ranges_m[beam] - expected_m
            if abs(beyond_m) < _ROUGHLY_M:
                merit += 1.0
            elif beyond_m > 2.0 * _ROUGHLY_M:
                merit -= _ROUGHLY_BEHIND_COUNTS
        found[row] = merit / max(count, 1)


@compiled
def placed(place: Floats, sensor: Floats) -> tuple[float, float, float]:
    """A sensor's pose on the map, where the newest pose is at a place."""
    c, s = np.cos(place[2]), np.sin(place[2])
    x = place[0] + c * sensor[0] - s * sensor[1]
    y = place[1] + s * sensor[0] + c * sensor[1]
    return x, y, place[2] + sensor[2]
