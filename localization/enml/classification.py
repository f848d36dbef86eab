"""Which points of a scan are long-term features: those on the line that the map shows there."""

from math import cos

import numpy as np

from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.pose_node import LtfMatches, PoseNode
from mend.localization.enml.problem import Floats, Indices
from mend.localization.enml.settling import has_moved
from mend.localization.pose import Poses, compose, transform, turn
from mend.maps.compiled import compiled
from mend.maps.segment_grid import SegmentGrid, cast_rays

_NEIGHBORS = 8
"""A point may lie on a line that the map shows up to so many points beside it: where walls end, a
small error of the heading changes what is seen."""


class LongTermFeatures:
    """Finds the long-term features of poses, again only once a pose has really moved."""

    def __init__(self, grid: SegmentGrid, parameters: EnmlParameters) -> None:
        self._grid = grid
        self._parameters = parameters
        self._cos_max_angle = cos(parameters.max_angle_rad)

    def classify(self, node: PoseNode, pose: Poses) -> bool:
        """Bring the node's long-term features up to a pose; whether that changed which they are."""
        if self._settled(node, pose):
            return False
        sensor = compose(pose, node.sensor_offset)
        expected_m, seen = look_at(self._grid, sensor, node.bearings, node.reach_m)
        points = transform(pose, node.scan_points.points)
        normals = turn(float(pose[2]), node.scan_points.normals)
        rows, lines = lines_of(
            self._grid.segments, points, normals, seen, node.gate_m, self._cos_max_angle
        )
        is_ltf = np.zeros(len(points), dtype=np.bool_)
        is_ltf[rows] = True
        changed = not np.array_equal(is_ltf, node.is_ltf)
        node.is_ltf = is_ltf
        node.ltf = LtfMatches(rows, node.scan_points.points[rows], lines[:, :2], lines[:, 2])
        node.cast_pose, node.cast_gate_m, node.expected_m = pose.copy(), node.gate_m, expected_m
        return changed

    def _settled(self, node: PoseNode, pose: Poses) -> bool:
        before = node.cast_pose
        if before is None or node.gate_m != node.cast_gate_m:
            return False
        return not has_moved(pose - before)


def look_at(
    grid: SegmentGrid, sensor: Poses, bearings: Floats, max_range_m: float
) -> tuple[Floats, Indices]:
    """Expected range and segment along bearings from a sensor's pose."""
    ranges_m, seen = np.empty(len(bearings)), np.empty(len(bearings), dtype=np.int64)
    cast_rays(grid, sensor, bearings, max_range_m, ranges_m, seen)
    return ranges_m, seen


def lines_of(
    segments: Floats,
    points: Floats,
    normals: Floats,
    seen: Indices,
    gate_m: float,
    cos_max_angle: float,
) -> tuple[Indices, Floats]:
    """Which points (map's frame) lie on a line that the map shows there, and those lines.

    `seen` is the segment along each point's bearing; a line is its normal (2) and offset.
    """
    found = np.empty(len(points), dtype=np.int64)
    lines = np.empty((len(points), 3))
    match_lines(segments, points, normals, seen, _NEIGHBORS, gate_m, cos_max_angle, found, lines)
    rows = np.flatnonzero(found >= 0)
    return rows, lines[rows]


@compiled
def match_lines(
    segments: Floats,
    points: Floats,
    normals: Floats,
    seen: Indices,
    neighbors: int,
    gate_m: float,
    cos_max_angle: float,
    found: Indices,
    lines: Floats,
) -> None:
    """For each point (map's frame) the nearest visible segment within the gate, or -1.

    `seen` is the segment that the map shows along each point's bearing; `lines` receives normal and
    offset of the found segment's line.
    """
    count = points.shape[0]
    for row in range(count):
        found[row] = -1
        px, py = points[row, 0], points[row, 1]
        nx, ny = normals[row, 0], normals[row, 1]
        best = gate_m
        last = -1
        for other in range(max(0, row - neighbors), min(count, row + neighbors + 1)):
            candidate = seen[other]
            if candidate < 0 or candidate == last:
                continue
            last = candidate
            x0, y0 = segments[candidate, 0], segments[candidate, 1]
            dx, dy = segments[candidate, 2] - x0, segments[candidate, 3] - y0
            length = np.hypot(dx, dy)
            if length <= 0.0:
                continue
            lx, ly = -dy / length, dx / length
            if abs(lx * nx + ly * ny) < cos_max_angle:
                continue
            along = min(max(((px - x0) * dx + (py - y0) * dy) / length, 0.0), length)
            gap = np.hypot(px - x0 - along * dx / length, py - y0 - along * dy / length)
            if gap < best:
                best = gap
                found[row] = candidate
                lines[row, 0], lines[row, 1] = lx, ly
                lines[row, 2] = -(lx * x0 + ly * y0)
