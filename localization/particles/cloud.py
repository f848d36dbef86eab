"""What localizers with particles share: how the cloud begins, and when it is lost."""

import numpy as np
from numpy.typing import NDArray

from mend.localization.localizer import Estimate, PointClass
from mend.localization.particles.motion import scattered
from mend.localization.particles.parameters import ParticleParameters
from mend.localization.points import ScanPoints
from mend.localization.pose import Poses
from mend.localization.scan import ScanStream


class ParticleCloud:
    """The particles of one robot; the same seed and input give the same ones."""

    def __init__(self, parameters: ParticleParameters, seed: int) -> None:
        self._cloud_parameters = parameters
        self._generator = np.random.default_rng(seed)

    def reset(self, pose: Poses, covariance: NDArray[np.float64] | None = None) -> None:
        """Scatter the particles around a pose."""
        its = self._cloud_parameters
        deviations = (
            np.array([its.start_deviation_m, its.start_deviation_m, its.start_deviation_rad])
            if covariance is None
            else np.sqrt(np.diag(covariance))
        )
        self._particles = scattered(np.asarray(pose), deviations, its.particles, self._generator)
        self._stream = ScanStream()
        self._lost = 0.0

    def _estimated(
        self,
        pose: Poses,
        covariance: NDArray[np.float64],
        points: ScanPoints,
        away_m: NDArray[np.float64],
    ) -> Estimate:
        """The estimate at a pose from which each point is so far from where the map has a wall."""
        its = self._cloud_parameters
        explained = away_m < its.explained_within_m
        unexplained = 1.0 - float(explained.mean()) if len(points) else 1.0
        self._lost = its.lost_memory * self._lost + (1.0 - its.lost_memory) * unexplained
        classes = np.where(explained, PointClass.LTF, PointClass.DF).astype(np.int8)
        return Estimate(pose, covariance, points, classes, self._lost, self._lost > its.lost_above)
