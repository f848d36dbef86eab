"""Weights of particles: from log-likelihoods, resampling, and the pose that they stand for."""

from math import radians

import numpy as np
from numpy.typing import NDArray

from mend.localization.pose import Poses, compose, relative, wrap

Matrix = NDArray[np.float64]

_NEAR_M = 0.75
_NEAR_RAD = radians(25.0)
"""Particles within both of the best one speak for the same place."""


def normalized(log_weights: Matrix) -> Matrix:
    """Weights that add up to 1."""
    weights = np.exp(log_weights - log_weights.max())
    shares: Matrix = weights / weights.sum()
    return shares


def effective_count(weights: Matrix) -> float:
    """How many equally weighted particles would say as much."""
    return float(1.0 / np.square(weights).sum())


def resampled(weights: Matrix, count: int, generator: np.random.Generator) -> NDArray[np.int64]:
    """Indices of `count` particles drawn by weight, with the least variance (systematic)."""
    marks = (np.arange(count) + generator.random()) / count
    drawn = np.searchsorted(np.cumsum(weights), marks)
    return np.minimum(drawn, len(weights) - 1).astype(np.int64)


def mean_pose(particles: Poses, weights: Matrix) -> tuple[Poses, Matrix]:
    """Mean and covariance of the particles around the most likely place."""
    best = particles[_heaviest(particles, weights)]
    away = relative(best, particles)
    near = (np.hypot(away[:, 0], away[:, 1]) < _NEAR_M) & (np.abs(away[:, 2]) < _NEAR_RAD)
    share = weights[near] / weights[near].sum()
    mean = compose(best, share @ away[near])
    spread = particles[near] - mean
    spread[:, 2] = wrap(spread[:, 2])
    covariance: Matrix = (spread * share[:, None]).T @ spread
    return mean, covariance


def _heaviest(particles: Poses, weights: Matrix) -> int:
    """The heaviest particle of the heaviest cell of a coarse grid: one outlier wins nothing."""
    cells = np.floor(particles / (_NEAR_M, _NEAR_M, _NEAR_RAD)).astype(np.int64)
    _, cell_of = np.unique(cells, axis=0, return_inverse=True)
    cell_of = cell_of.ravel()
    inside = cell_of == np.bincount(cell_of, weights).argmax()
    return int(np.where(inside, weights, -1.0).argmax())
