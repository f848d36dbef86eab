"""What the poses that leave an episode still say about its new first pose."""

import numpy as np
from scipy.linalg import LinAlgError, cholesky

from mend.localization.enml.normal_equations import linearize
from mend.localization.enml.problem import Floats, PoseGraph


def prior_on_last(problem: PoseGraph, poses: Floats) -> tuple[Floats, Floats]:
    """Mean (3,) and whitening (3, 3) that the problem leaves on its last pose.

    The other poses are marginalized at `poses`, where the whole episode was optimal.
    """
    _, gradient, matrix = linearize(problem, poses)
    inner, last = slice(0, len(matrix) - 3), slice(len(matrix) - 3, len(matrix))
    gain = np.linalg.lstsq(matrix[inner, inner], matrix[inner, last], rcond=None)[0]
    information = matrix[last, last] - matrix[last, inner] @ gain
    slope = gradient[last] - gain.T @ gradient[inner]
    information = (information + information.T) / 2.0
    try:
        whitening = np.asarray(cholesky(information))
    except LinAlgError:
        # Nothing was known of some direction: keep what is known of the others.
        values, vectors = np.linalg.eigh(information)
        whitening = np.sqrt(np.maximum(values, 0.0))[:, None] * vectors.T
    mean = poses[-1] - np.linalg.lstsq(information, slope, rcond=None)[0]
    return np.asarray(mean), np.asarray(whitening)


def whitening_of(covariance: Floats) -> Floats:
    """The matrix that turns errors of some covariance into unit variances."""
    return np.asarray(cholesky(np.linalg.inv(covariance)))
