"""The same cost, gradient and Gauss-Newton matrix in plain numpy: slower, and easy to check."""

import numpy as np

from mend.localization.enml.problem import Floats, PoseGraph


def linearize(problem: PoseGraph, poses: Floats) -> tuple[float, Floats, Floats]:
    """The cost at some poses (n, 3), its gradient (3n) and its Gauss-Newton matrix (3n, 3n)."""
    size = 3 * len(poses)
    gradient = np.zeros(size)
    matrix = np.zeros((size, size))
    cost = 0.0
    for residuals, jacobian, columns, weights, loss in (
        _prior(problem, poses),
        *_odometry(problem, poses),
        *_ltf(problem, poses),
        *_stf(problem, poses),
    ):
        cost += loss
        gradient[columns] += jacobian.T @ (weights * residuals)
        matrix[np.ix_(columns, columns)] += jacobian.T @ (weights[:, None] * jacobian)
    return cost, gradient, matrix


_Term = tuple[Floats, Floats, list[int], Floats, float]


def _prior(problem: PoseGraph, poses: Floats) -> _Term:
    error = poses[0] - problem.prior
    error[2] = _wrapped(error[2])
    residuals = problem.prior_whitening @ error
    return residuals, problem.prior_whitening, [0, 1, 2], np.ones(3), _half_square(residuals)


def _odometry(problem: PoseGraph, poses: Floats) -> list[_Term]:
    terms = []
    for i, (measured, whitening) in enumerate(
        zip(problem.odometry, problem.odometry_whitening, strict=True)
    ):
        back = _rotation(poses[i, 2]).T
        moved = back @ (poses[i + 1, :2] - poses[i, :2])
        turned = poses[i + 1, 2] - poses[i, 2]
        error = np.array([*(moved - measured[:2]), _wrapped(turned - measured[2])])
        jacobian = np.zeros((3, 6))
        jacobian[:2, :2], jacobian[:2, 3:5] = -back, back
        jacobian[:2, 2] = moved[1], -moved[0]
        jacobian[2, 2], jacobian[2, 5] = -1.0, 1.0
        residuals = whitening @ error
        columns = list(range(3 * i, 3 * i + 6))
        width = problem.odometry_width
        excess = residuals @ residuals / width**2
        weights = np.full(3, 1.0 / (1.0 + excess))
        loss = float(0.5 * width**2 * np.log1p(excess))
        terms.append((residuals, whitening @ jacobian, columns, weights, loss))
    return terms


def _ltf(problem: PoseGraph, poses: Floats) -> list[_Term]:
    ltf = problem.ltf
    terms = []
    for i, pose in enumerate(poses):
        rows = slice(ltf.start[i], ltf.start[i + 1])
        seen = ltf.points[rows] @ _rotation(pose[2]).T
        normals = ltf.normals[rows]
        residuals = np.sum(normals * (seen + pose[:2]), axis=1) + ltf.offsets[rows]
        jacobian = np.column_stack([normals, _cross(seen, normals)])
        weights, loss = _robust(residuals, ltf.widths_m[i], problem.ltf_weight)
        terms.append((residuals, jacobian, [3 * i, 3 * i + 1, 3 * i + 2], weights, loss))
    return terms


def _stf(problem: PoseGraph, poses: Floats) -> list[_Term]:
    stf = problem.stf
    terms = []
    for pair, (a, b) in enumerate(stf.pairs):
        rows = slice(stf.start[pair], stf.start[pair + 1])
        turn_a, turn_b = _rotation(poses[a, 2]).T, _rotation(poses[b, 2]).T
        seen_a, seen_b = stf.points_a[rows] @ turn_a, stf.points_b[rows] @ turn_b
        gap = seen_b + poses[b, :2] - seen_a - poses[a, :2]
        columns = [*range(3 * a, 3 * a + 3), *range(3 * b, 3 * b + 3)]
        for normals, own in (
            (stf.normals_a[rows] @ turn_a, 2),
            (stf.normals_b[rows] @ turn_b, 5),
        ):
            residuals = np.sum(normals * gap, axis=1)
            jacobian = np.column_stack(
                [-normals, -_cross(seen_a, normals), normals, _cross(seen_b, normals)]
            )
            jacobian[:, own] += _cross(normals, gap)
            weights, loss = _robust(residuals, stf.width_m, problem.stf_weight)
            terms.append((residuals, jacobian, columns, weights, loss))
    return terms


def _robust(residuals: Floats, width_m: float, information: float) -> tuple[Floats, float]:
    excess = (residuals / width_m) ** 2
    loss = 0.5 * information * width_m**2 * np.log1p(excess).sum()
    return information / (1.0 + excess), float(loss)


def _half_square(residuals: Floats) -> float:
    return float(0.5 * residuals @ residuals)


def _rotation(angle: float) -> Floats:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])


def _cross(a: Floats, b: Floats) -> Floats:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def _wrapped(angle: float) -> float:
    return float((angle + np.pi) % (2.0 * np.pi) - np.pi)
