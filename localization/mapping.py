"""Vector maps out of logs: by their reference poses, or by matching scan to scan."""

from collections.abc import Callable

import numpy as np

from mend.localization.logs.log import RecordedDrive
from mend.localization.points import scan_points
from mend.localization.pose import Poses, transform, turn
from mend.maps.building_vector_map import build_vector_map
from mend.maps.vector_map import VectorMap

MAX_RANGE_M = 15.0
"""Farther returns spread too far between beams to draw walls with."""
MAX_SCANS = 1500
"""More scans of one drive only repeat each other; some are left out evenly."""


def map_of(
    log: RecordedDrive, poses: Poses, on_scan: Callable[[], None] | None = None
) -> VectorMap:
    """The vector map that a log's scans give, seen from poses (n, 3) in the map's frame."""
    every = -(-len(log) // MAX_SCANS)
    points, normals = [np.empty((0, 2))], [np.empty((0, 2))]
    for number, (step, pose) in enumerate(zip(log.steps, poses, strict=True)):
        if on_scan is not None:
            on_scan()
        if number % every:
            continue
        seen = scan_points(step.scan, max_range=MAX_RANGE_M)
        points.append(transform(pose, seen.points))
        normals.append(turn(float(pose[2]), seen.normals))
    return build_vector_map(np.vstack(points), np.vstack(normals), log.name)
