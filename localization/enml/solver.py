"""Levenberg-Marquardt over all poses of an episode, and the covariance of the newest."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from mend.localization.enml.normal_equations import linearize
from mend.localization.enml.problem import Floats, PoseGraph

Linearize = Callable[[PoseGraph, Floats], tuple[float, Floats, Floats]]

_FIRST_DAMPING = 1e-4
_LEAST_DAMPING = 1e-9
_MOST_DAMPING = 1e8
_ENOUGH_COST = 1e-4
"""A step that lowers the cost by less than this share of it ends the search."""
_ENOUGH_STEP = 1e-5
"""As does one that moves no pose by more than this (metres, radians)."""


@dataclass(frozen=True, slots=True)
class Solution:
    """Where the cost is lowest, and the Gauss-Newton matrix there (the inverse covariance)."""

    poses: Floats
    cost: float
    information: Floats
    iterations: int

    def covariance_of(self, *poses: int) -> Floats:
        """The joint covariance (3n, 3n) of some of the poses; metres and radians, map's frame."""
        every = np.arange(len(self.information))
        rows = every.reshape(-1, 3)[list(poses)].ravel()
        columns = np.eye(len(every))[:, rows]
        try:
            solved = cho_solve(cho_factor(self.information), columns)
        except LinAlgError:
            solved = np.linalg.pinv(self.information) @ columns
        block = solved[rows]
        return np.asarray((block + block.T) / 2.0)


def solve(
    problem: PoseGraph,
    poses: Floats,
    iterations: int,
    linearize: Linearize = linearize,
) -> Solution:
    """Lower the cost from some poses (n, 3) on, in at most so many steps."""
    cost, gradient, matrix = linearize(problem, poses)
    damping = _FIRST_DAMPING
    taken = 0
    while taken < iterations and damping < _MOST_DAMPING:
        taken += 1
        step = _damped_step(matrix, gradient, damping)
        if step is None:
            damping *= 10.0
            continue
        moved = poses + step.reshape(-1, 3)
        new_cost, new_gradient, new_matrix = linearize(problem, moved)
        if not new_cost <= cost:
            damping *= 10.0
            continue
        settled = cost - new_cost <= _ENOUGH_COST * cost or np.abs(step).max() < _ENOUGH_STEP
        poses, cost, gradient, matrix = moved, new_cost, new_gradient, new_matrix
        damping = max(damping * 0.2, _LEAST_DAMPING)
        if settled:
            break
    return Solution(poses, cost, matrix, taken)


def _damped_step(matrix: Floats, gradient: Floats, damping: float) -> Floats | None:
    damped = matrix.copy()
    diagonal = np.einsum("ii->i", damped)
    diagonal *= 1.0 + damping
    try:
        factor = cho_factor(damped, lower=True, overwrite_a=True, check_finite=False)
    except LinAlgError:
        return None
    return np.asarray(-cho_solve(factor, gradient, check_finite=False))
