"""From a place that is about right to where what lies on the map's lines fits them best."""

from math import cos

import numpy as np

from robots.localization.enml.classification import lines_of
from robots.localization.enml.looks import Look
from robots.localization.enml.parameters import EnmlParameters
from robots.localization.enml.problem import Floats
from robots.localization.enml.visible import Visible
from robots.localization.pose import Poses, compose, transform, turn

_GATES_M = (0.6, 0.6, 0.4, 0.25, 0.15, 0.15)
_WIDTH_PER_GATE = 1.0 / 3.0
_STIFFNESS = 1.0
"""As if one point in each direction held the place."""


def polish(visible: Visible, looks: list[Look], place: Poses, parameters: EnmlParameters) -> Poses:
    """Gauss-Newton on points and the visible lines near them, through ever narrower gates."""
    pose = np.array(place, dtype=np.float64)
    for gate_m in _GATES_M:
        matrix, slope = _STIFFNESS * np.eye(3), np.zeros(3)
        for look in looks:
            slopes, off_m = _residuals(visible, look, pose, gate_m, parameters)
            weights = 1.0 / (1.0 + (off_m / (_WIDTH_PER_GATE * gate_m)) ** 2)
            matrix += (slopes * weights[:, None]).T @ slopes
            slope += slopes.T @ (weights * off_m)
        pose -= np.clip(np.linalg.solve(matrix, slope), -gate_m, gate_m)
    return pose


def _residuals(
    visible: Visible, look: Look, pose: Poses, gate_m: float, parameters: EnmlParameters
) -> tuple[Floats, Floats]:
    """Distances of points from their lines (metres), and how these change with the pose."""
    points = transform(pose, look.points)
    _, seen, segments = visible.cast(compose(pose, look.sensor), look.bearings, look.reach_m)
    rows, lines = lines_of(
        segments,
        points,
        turn(float(pose[2]), look.normals),
        seen,
        gate_m,
        cos(parameters.ltf_max_angle_rad),
    )
    arms = points[rows] - pose[:2]
    turning = lines[:, 1] * arms[:, 0] - lines[:, 0] * arms[:, 1]
    off_m = np.sum(lines[:, :2] * points[rows], axis=1) + lines[:, 2]
    return np.column_stack([lines[:, :2], turning]), off_m
