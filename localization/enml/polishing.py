"""From places that are about right to where what lies on the map's lines fits them best."""

import numpy as np

from mend.localization.enml.classification import match_lines
from mend.localization.enml.looks import Looks, placed
from mend.localization.enml.problem import Floats
from mend.maps.compiled import compiled
from mend.maps.segment_grid import SegmentGrid, cast_rays

GATES_M = np.array([0.6, 0.6, 0.4, 0.25, 0.15, 0.15])
_WIDTH_PER_GATE = 1.0 / 3.0
_NEIGHBORS = 4
_STIFFNESS = 1.0
"""As if one point in each direction held the place."""


@compiled
def polish(
    grid: SegmentGrid, looks: Looks, gates_m: Floats, cos_max_angle: float, places: Floats
) -> None:
    """Gauss-Newton on points and the visible lines near them, through ever narrower gates.

    Moves the places (n, 3).
    """
    for row in range(places.shape[0]):
        pose = places[row]
        for gate_m in gates_m:
            matrix, slope = _STIFFNESS * np.eye(3), np.zeros(3)
            for scan in range(looks.sensors.shape[0]):
                gather(grid, looks, scan, gate_m, cos_max_angle, pose, matrix, slope)
            step = np.linalg.solve(matrix, slope)
            for i in range(3):
                pose[i] -= min(max(step[i], -gate_m), gate_m)
        pose[2] = (pose[2] + np.pi) % (2.0 * np.pi) - np.pi


@compiled
def gather(
    grid: SegmentGrid,
    looks: Looks,
    scan: int,
    gate_m: float,
    cos_max_angle: float,
    pose: Floats,
    matrix: Floats,
    slope: Floats,
) -> None:
    """Add what one scan says about how a pose has to move: normal equations (3, 3) and (3,)."""
    first, last = looks.starts[scan], looks.starts[scan + 1]
    count = last - first
    c, s = np.cos(pose[2]), np.sin(pose[2])
    on_map, facing = np.empty((count, 2)), np.empty((count, 2))
    for row in range(count):
        px, py = looks.points[first + row, 0], looks.points[first + row, 1]
        nx, ny = looks.normals[first + row, 0], looks.normals[first + row, 1]
        on_map[row, 0], on_map[row, 1] = pose[0] + c * px - s * py, pose[1] + s * px + c * py
        facing[row, 0], facing[row, 1] = c * nx - s * ny, s * nx + c * ny
    sensor = np.array(placed(pose, looks.sensors[scan]))
    ranges_m, seen = np.empty(count), np.empty(count, dtype=np.int64)
    cast_rays(grid, sensor, looks.bearings[first:last], looks.reaches_m[scan], ranges_m, seen)
    found, lines = np.empty(count, dtype=np.int64), np.empty((count, 3))
    match_lines(
        grid.segments, on_map, facing, seen, _NEIGHBORS, gate_m, cos_max_angle, found, lines
    )
    change = np.empty(3)
    for row in range(count):
        if found[row] < 0:
            continue
        x, y = on_map[row, 0], on_map[row, 1]
        change[0], change[1] = lines[row, 0], lines[row, 1]
        change[2] = lines[row, 1] * (x - pose[0]) - lines[row, 0] * (y - pose[1])
        off_m = lines[row, 0] * x + lines[row, 1] * y + lines[row, 2]
        weight = 1.0 / (1.0 + (off_m / (_WIDTH_PER_GATE * gate_m)) ** 2)
        for i in range(3):
            slope[i] += weight * off_m * change[i]
            for j in range(3):
                matrix[i, j] += weight * change[i] * change[j]
