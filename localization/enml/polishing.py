"""From a place that is about right to where what lies on the map's lines fits them best."""

from math import cos

import numpy as np

from mend.localization.enml.classification import cast_around, match_lines
from mend.localization.enml.looks import ScanLook
from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.problem import Floats
from mend.localization.enml.visible import Visible
from mend.localization.pose import Poses, wrap_angle
from mend.maps.compiled import compiled

GATES_M = (0.6, 0.6, 0.4, 0.25, 0.15, 0.15)
_WIDTH_PER_GATE = 1.0 / 3.0
_NEIGHBORS = 4
_STIFFNESS = 1.0
"""As if one point in each direction held the place."""


def polish(
    visible: Visible,
    looks: list[ScanLook],
    place: Poses,
    parameters: EnmlParameters,
    gates_m: tuple[float, ...] = GATES_M,
) -> Poses:
    """Gauss-Newton on points and the visible lines near them, through ever narrower gates."""
    pose = np.array(place, dtype=np.float64)
    cos_max_angle = cos(parameters.ltf_max_angle_rad)
    for gate_m in gates_m:
        matrix, slope = _STIFFNESS * np.eye(3), np.zeros(3)
        for look in looks:
            gather(
                visible.segments_around(pose, look.reach_m),
                pose,
                look.sensor,
                look.points,
                look.normals,
                look.bearings,
                visible.reach_m(look.reach_m),
                gate_m,
                gate_m * _WIDTH_PER_GATE,
                cos_max_angle,
                matrix,
                slope,
            )
        pose -= np.clip(np.linalg.solve(matrix, slope), -gate_m, gate_m)
    pose[2] = wrap_angle(pose[2])
    return pose


@compiled
def gather(
    segments: Floats,
    pose: Floats,
    sensor: Floats,
    points: Floats,
    normals: Floats,
    bearings: Floats,
    reach_m: float,
    gate_m: float,
    width_m: float,
    cos_max_angle: float,
    matrix: Floats,
    slope: Floats,
) -> None:
    """Add what a look says about how a pose has to move: normal equations (3, 3) and (3,)."""
    count = points.shape[0]
    c, s = np.cos(pose[2]), np.sin(pose[2])
    from_here = np.empty(3)
    from_here[0] = pose[0] + c * sensor[0] - s * sensor[1]
    from_here[1] = pose[1] + s * sensor[0] + c * sensor[1]
    from_here[2] = pose[2] + sensor[2]
    placed, facing = np.empty((count, 2)), np.empty((count, 2))
    for row in range(count):
        placed[row, 0] = pose[0] + c * points[row, 0] - s * points[row, 1]
        placed[row, 1] = pose[1] + s * points[row, 0] + c * points[row, 1]
        facing[row, 0] = c * normals[row, 0] - s * normals[row, 1]
        facing[row, 1] = s * normals[row, 0] + c * normals[row, 1]
    ranges_m, seen = np.empty(count), np.empty(count, dtype=np.int64)
    cast_around(segments, from_here, bearings, reach_m, ranges_m, seen)
    found, lines = np.empty(count, dtype=np.int64), np.empty((count, 3))
    match_lines(segments, placed, facing, seen, _NEIGHBORS, gate_m, cos_max_angle, found, lines)
    change = np.empty(3)
    for row in range(count):
        if found[row] < 0:
            continue
        change[0], change[1] = lines[row, 0], lines[row, 1]
        change[2] = lines[row, 1] * (placed[row, 0] - pose[0]) - lines[row, 0] * (
            placed[row, 1] - pose[1]
        )
        off_m = lines[row, 0] * placed[row, 0] + lines[row, 1] * placed[row, 1] + lines[row, 2]
        weight = 1.0 / (1.0 + (off_m / width_m) ** 2)
        for i in range(3):
            slope[i] += weight * off_m * change[i]
            for j in range(3):
                matrix[i, j] += weight * change[i] * change[j]
