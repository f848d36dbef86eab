"""Corrective gradient refinement: predict, refine, weigh, resample."""

import numpy as np
from numpy.typing import NDArray

from mend.localization.cgr.parameters import CgrParameters
from mend.localization.cgr.refinement import Refinement
from mend.localization.localizer import Estimate
from mend.localization.particles.cloud import ParticleCloud
from mend.localization.particles.motion import moved
from mend.localization.particles.weights import mean_pose, normalized, resampled
from mend.localization.points import ScanPoints, scan_points
from mend.localization.pose import Poses, wrap
from mend.localization.scan import Scan
from mend.maps.vector_map import VectorMap


class CgrLocalizer(ParticleCloud):
    """Follows one robot; the same seed and input give the same estimates."""

    def __init__(
        self,
        vector_map: VectorMap,
        *,
        parameters: CgrParameters | None = None,
        seed: int = 1,
    ) -> None:
        """Stands at the origin until `reset`."""
        self.parameters = parameters or CgrParameters()
        super().__init__(self.parameters, seed)
        self._refine = Refinement(np.array(vector_map.segments), self.parameters)
        self.reset(np.zeros(3))

    def update(self, odometry: Poses, scan: Scan) -> Estimate:
        """Raises `InvalidScanError`, and is then as it was before."""
        its = self.parameters
        motion = self._stream.accept(odometry, scan)
        points = scan_points(scan, its.min_range_m, its.max_range_m)
        if motion.any():
            self._particles = moved(self._particles, motion, its.motion, self._generator)
        reach_m = min(its.max_range_m, scan.max_range) + its.attracted_within_m
        if not len(points):
            even = np.full(its.particles, 1.0 / its.particles)
            mean, covariance = mean_pose(self._particles, even)
        else:
            mean, covariance = self._correct(points, scan.sensor_offset, reach_m)
        return self._estimate(mean, covariance, points, scan.sensor_offset, reach_m)

    def _correct(
        self, points: ScanPoints, sensor: Poses, reach_m: float
    ) -> tuple[Poses, NDArray[np.float64]]:
        """Weigh predicted and refined particles against each other, and keep as many as before."""
        refined, before, after = self._refine(self._particles, points, sensor, reach_m)
        pool = np.vstack((self._particles, refined))
        weights = normalized(np.concatenate((before, after)))
        mean, covariance = mean_pose(pool, weights)
        drawn = resampled(weights, self.parameters.particles, self._generator)
        self._particles = self._jittered(pool[drawn], drawn)
        return mean, covariance

    def _jittered(self, particles: Poses, drawn: NDArray[np.int64]) -> Poses:
        """Spread particles that were drawn more than once, so that they stay different."""
        its = self.parameters
        again = np.concatenate(([False], drawn[1:] == drawn[:-1]))
        spread = np.array([its.jitter_m, its.jitter_m, its.jitter_rad])
        jitter = self._generator.uniform(-1.0, 1.0, particles.shape) * spread
        particles = particles + jitter * again[:, None]
        particles[:, 2] = wrap(particles[:, 2])
        return particles

    def _estimate(
        self,
        pose: Poses,
        covariance: NDArray[np.float64],
        points: ScanPoints,
        sensor: Poses,
        reach_m: float,
    ) -> Estimate:
        away_m = self._refine.distances(pose, points, sensor, reach_m)
        return self._estimated(pose, covariance, points, away_m)
