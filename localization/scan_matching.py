"""Poses of a log that nobody corrected: each scan matched to what was seen before it."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from mend.localization.logs.log import RecordedDrive
from mend.localization.particles.motion import MotionNoise
from mend.localization.points import scan_points
from mend.localization.pose import Poses, compose, relative, transform, turn, wrap_angle

Matrix = NDArray[np.float64]

_KEY_STEP_M = 0.15
_KEY_TURN_RAD = 0.05
"""A scan is kept when the robot has moved or turned by this since the last that was."""
_MAX_RANGE_M = 15.0
_GATES_M = (1.0, 0.8, 0.6, 0.4, 0.4, 0.3, 0.3, 0.2, 0.2, 0.2, 0.2)
"""How far a point may be from what it is matched to, from round to round."""
_LEAST_COSINE = 0.8
"""Between the normals of two points that are matched."""
_POINT_DEVIATION_M = 0.05
_SAME_SURFACE_M = 0.2
"""A point this near a known one that faces the same way is on the same surface."""
_LEAST_MATCHES = 20
_TRUST = 0.3
"""Weight of a matched point, since neighbouring points err together."""


def matched_poses(log: RecordedDrive, on_scan: Callable[[], None] | None = None) -> Poses:
    """The poses (n, 3) of a log's scans in the frame of the first; drift is not closed in loops."""
    matching = _Matching()
    poses: list[Poses] = []
    key = np.zeros(3)
    moved = np.zeros(3)
    for number, step in enumerate(log.steps):
        if on_scan is not None:
            on_scan()
        moved = compose(moved, step.odometry)
        guess = compose(key, moved)
        far = np.hypot(moved[0], moved[1]) >= _KEY_STEP_M or abs(moved[2]) >= _KEY_TURN_RAD
        if number == 0 or far:
            seen = scan_points(step.scan, max_range=_MAX_RANGE_M)
            surfaces = (seen.normals != 0.0).any(axis=1)
            points, normals = seen.points[surfaces], seen.normals[surfaces]
            guess = matching.matched(guess, moved, points, normals)
            matching.add(transform(guess, points), turn(float(guess[2]), normals))
            key, moved = guess, np.zeros(3)
        poses.append(guess)
    return np.array(poses)


class _Matching:
    """Surfaces seen so far, and scans matched to them."""

    def __init__(self) -> None:
        self._points = np.empty((0, 2))
        self._normals = np.empty((0, 2))
        self._noise = MotionNoise()

    def add(self, points: Matrix, normals: Matrix) -> None:
        """Remember points of the map's frame on surfaces that were not seen before.

        A known surface seen again says where the robot is, not where the surface is: if it were
        remembered anew, each small error would move the map along with it.
        """
        fresh = np.ones(len(points), dtype=bool)
        if len(self._points):
            tree = cKDTree(self._points)
            known = tree.query_ball_point(points, _SAME_SURFACE_M)
            for number, near in enumerate(known):
                if near:
                    alike = np.abs(self._normals[near] @ normals[number])
                    fresh[number] = alike.max() < _LEAST_COSINE
        self._points = np.vstack((self._points, points[fresh]))
        self._normals = np.vstack((self._normals, normals[fresh]))

    def matched(self, guess: Poses, moved: Poses, points: Matrix, normals: Matrix) -> Poses:
        """The pose near a guess from which points fit best to what was seen before."""
        near = np.hypot(*(self._points - guess[:2]).T) < _MAX_RANGE_M + _GATES_M[0]
        if near.sum() < _LEAST_MATCHES or not len(points):
            return guess
        known, facing = self._points[near], self._normals[near]
        tree = cKDTree(known)
        information = np.diag(1.0 / np.square(self._noise.deviations(moved)))
        pose = guess
        for gate_m in _GATES_M:
            seen = transform(pose, points)
            away, nearest = tree.query(seen, distance_upper_bound=gate_m)
            found = np.isfinite(away)
            turned = turn(float(pose[2]), normals[found])
            hits = nearest[found]
            alike = (turned * facing[hits]).sum(axis=1) > _LEAST_COSINE
            if alike.sum() < _LEAST_MATCHES:
                return guess
            pose = _step(
                pose,
                guess,
                information,
                seen[found][alike],
                known[hits[alike]],
                facing[hits[alike]],
            )
        return pose


def _step(
    pose: Poses, guess: Poses, information: Matrix, seen: Matrix, known: Matrix, facing: Matrix
) -> Poses:
    """One Gauss-Newton step on the distances along the normals, with odometry as a prior."""
    arms = seen - pose[:2]
    residuals = ((seen - known) * facing).sum(axis=1) / _POINT_DEVIATION_M
    slopes = np.column_stack((facing, arms[:, 0] * facing[:, 1] - arms[:, 1] * facing[:, 0]))
    slopes = slopes / _POINT_DEVIATION_M
    weights = _TRUST / np.maximum(1.0, np.abs(residuals))
    # The prior is told in the robot's frame, where wheels err.
    off = relative(guess, pose)
    cosine, sine = np.cos(guess[2]), np.sin(guess[2])
    rotation = np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    curvature = (slopes * weights[:, None]).T @ slopes + rotation.T @ information @ rotation
    gradient = (slopes * weights[:, None]).T @ residuals + rotation.T @ information @ off
    stepped: Poses = pose - np.linalg.solve(curvature, gradient)
    stepped[2] = wrap_angle(float(stepped[2]))
    return stepped
