"""Cost, gradient and Gauss-Newton matrix of a problem, in one fused pass of compiled code.

The loss of a point at distance r is Cauchy's: w^2/2 log(1 + (r/w)^2), which pulls like least
squares nearby and lets go of what is far; that of a motion is the same in standard deviations. The
prior is plain least squares.
"""

import math

import numpy as np

from mend.localization.enml.problem import Floats, Indices, PoseGraph
from mend.maps.compiled import compiled


def linearize(problem: PoseGraph, poses: Floats) -> tuple[float, Floats, Floats]:
    """The cost at some poses (n, 3), its gradient (3n) and its Gauss-Newton matrix (3n, 3n)."""
    size = 3 * len(poses)
    gradient = np.zeros(size)
    matrix = np.zeros((size, size))
    cost = _add_prior(poses, problem.prior, problem.prior_whitening, gradient, matrix)
    cost += _add_odometry(
        poses,
        problem.odometry,
        problem.odometry_whitening,
        problem.odometry_width,
        gradient,
        matrix,
    )
    ltf, stf = problem.ltf, problem.stf
    cost += _add_ltf(
        poses,
        ltf.start,
        ltf.points,
        ltf.normals,
        ltf.offsets,
        ltf.widths_m,
        problem.ltf_weight,
        gradient,
        matrix,
    )
    cost += _add_stf(
        poses,
        stf.pairs,
        stf.start,
        stf.points_a,
        stf.normals_a,
        stf.points_b,
        stf.normals_b,
        stf.width_m,
        problem.stf_weight,
        gradient,
        matrix,
    )
    return float(cost), gradient, matrix


@compiled
def _wrapped(angle: float) -> float:
    return angle - 2.0 * math.pi * math.floor((angle + math.pi) / (2.0 * math.pi))


@compiled
def _add_prior(
    poses: Floats, prior: Floats, whitening: Floats, gradient: Floats, matrix: Floats
) -> float:
    error = np.empty(3)
    error[0] = poses[0, 0] - prior[0]
    error[1] = poses[0, 1] - prior[1]
    error[2] = _wrapped(poses[0, 2] - prior[2])
    cost = 0.0
    for row in range(3):
        residual = 0.0
        for k in range(3):
            residual += whitening[row, k] * error[k]
        cost += 0.5 * residual * residual
        for a in range(3):
            gradient[a] += whitening[row, a] * residual
            for b in range(3):
                matrix[a, b] += whitening[row, a] * whitening[row, b]
    return cost


@compiled
def _add_odometry(
    poses: Floats,
    odometry: Floats,
    whitening: Floats,
    width: float,
    gradient: Floats,
    matrix: Floats,
) -> float:
    cost = 0.0
    error = np.empty(3)
    residual = np.empty(3)
    plain = np.zeros((3, 6))
    jacobian = np.empty((3, 6))
    for i in range(odometry.shape[0]):
        c, s = math.cos(poses[i, 2]), math.sin(poses[i, 2])
        dx, dy = poses[i + 1, 0] - poses[i, 0], poses[i + 1, 1] - poses[i, 1]
        forward, left = c * dx + s * dy, -s * dx + c * dy
        error[0] = forward - odometry[i, 0]
        error[1] = left - odometry[i, 1]
        error[2] = _wrapped(poses[i + 1, 2] - poses[i, 2] - odometry[i, 2])
        plain[0, 0], plain[0, 1], plain[0, 2], plain[0, 3], plain[0, 4] = -c, -s, left, c, s
        plain[1, 0], plain[1, 1], plain[1, 2], plain[1, 3], plain[1, 4] = s, -c, -forward, -s, c
        plain[2, 2], plain[2, 5] = -1.0, 1.0
        square = 0.0
        for row in range(3):
            residual[row] = 0.0
            for k in range(3):
                residual[row] += whitening[i, row, k] * error[k]
            square += residual[row] * residual[row]
            for a in range(6):
                jacobian[row, a] = 0.0
                for k in range(3):
                    jacobian[row, a] += whitening[i, row, k] * plain[k, a]
        excess = square / (width * width)
        weight = 1.0 / (1.0 + excess)
        cost += 0.5 * width * width * math.log1p(excess)
        first = 3 * i
        for row in range(3):
            for a in range(6):
                pull = weight * jacobian[row, a]
                gradient[first + a] += pull * residual[row]
                for b in range(6):
                    matrix[first + a, first + b] += pull * jacobian[row, b]
    return cost


@compiled
def _add_ltf(
    poses: Floats,
    start: Indices,
    points: Floats,
    normals: Floats,
    offsets: Floats,
    widths_m: Floats,
    information: float,
    gradient: Floats,
    matrix: Floats,
) -> float:
    cost = 0.0
    for i in range(poses.shape[0]):
        c, s = math.cos(poses[i, 2]), math.sin(poses[i, 2])
        width_squared = widths_m[i] * widths_m[i]
        h00 = h01 = h02 = h11 = h12 = h22 = 0.0
        g0 = g1 = g2 = 0.0
        for k in range(start[i], start[i + 1]):
            rx = c * points[k, 0] - s * points[k, 1]
            ry = s * points[k, 0] + c * points[k, 1]
            nx, ny = normals[k, 0], normals[k, 1]
            residual = (poses[i, 0] + rx) * nx + (poses[i, 1] + ry) * ny + offsets[k]
            turning = rx * ny - ry * nx
            excess = residual * residual / width_squared
            weight = information / (1.0 + excess)
            cost += 0.5 * information * width_squared * math.log1p(excess)
            h00 += weight * nx * nx
            h01 += weight * nx * ny
            h02 += weight * nx * turning
            h11 += weight * ny * ny
            h12 += weight * ny * turning
            h22 += weight * turning * turning
            g0 += weight * nx * residual
            g1 += weight * ny * residual
            g2 += weight * turning * residual
        x, y, t = 3 * i, 3 * i + 1, 3 * i + 2
        gradient[x] += g0
        gradient[y] += g1
        gradient[t] += g2
        matrix[x, x] += h00
        matrix[x, y] += h01
        matrix[y, x] += h01
        matrix[x, t] += h02
        matrix[t, x] += h02
        matrix[y, y] += h11
        matrix[y, t] += h12
        matrix[t, y] += h12
        matrix[t, t] += h22
    return cost


@compiled
def _add_stf(
    poses: Floats,
    pairs: Indices,
    start: Indices,
    points_a: Floats,
    normals_a: Floats,
    points_b: Floats,
    normals_b: Floats,
    width_m: float,
    information: float,
    gradient: Floats,
    matrix: Floats,
) -> float:
    cost = 0.0
    width_squared = width_m * width_m
    jacobian = np.empty(6)
    block = np.empty((6, 6))
    slope = np.empty(6)
    for pair in range(pairs.shape[0]):
        a, b = pairs[pair, 0], pairs[pair, 1]
        ca, sa = math.cos(poses[a, 2]), math.sin(poses[a, 2])
        cb, sb = math.cos(poses[b, 2]), math.sin(poses[b, 2])
        block[:] = 0.0
        slope[:] = 0.0
        for k in range(start[pair], start[pair + 1]):
            ax = ca * points_a[k, 0] - sa * points_a[k, 1]
            ay = sa * points_a[k, 0] + ca * points_a[k, 1]
            bx = cb * points_b[k, 0] - sb * points_b[k, 1]
            by = sb * points_b[k, 0] + cb * points_b[k, 1]
            dx = poses[b, 0] + bx - poses[a, 0] - ax
            dy = poses[b, 1] + by - poses[a, 1] - ay
            for side in range(2):
                # The normal turns with the pose that saw it, and so does its derivative.
                if side == 0:
                    nx = ca * normals_a[k, 0] - sa * normals_a[k, 1]
                    ny = sa * normals_a[k, 0] + ca * normals_a[k, 1]
                else:
                    nx = cb * normals_b[k, 0] - sb * normals_b[k, 1]
                    ny = sb * normals_b[k, 0] + cb * normals_b[k, 1]
                residual = nx * dx + ny * dy
                swing = nx * dy - ny * dx
                jacobian[0], jacobian[1] = -nx, -ny
                jacobian[2] = -(ax * ny - ay * nx)
                jacobian[3], jacobian[4] = nx, ny
                jacobian[5] = bx * ny - by * nx
                jacobian[2 if side == 0 else 5] += swing
                excess = residual * residual / width_squared
                weight = information / (1.0 + excess)
                cost += 0.5 * information * width_squared * math.log1p(excess)
                for p in range(6):
                    pull = weight * jacobian[p]
                    slope[p] += pull * residual
                    for q in range(p + 1):
                        block[p, q] += pull * jacobian[q]
        for p in range(6):
            row = 3 * a + p if p < 3 else 3 * b + p - 3
            gradient[row] += slope[p]
            for q in range(6):
                column = 3 * a + q if q < 3 else 3 * b + q - 3
                matrix[row, column] += block[p, q] if q <= p else block[q, p]
    return cost
