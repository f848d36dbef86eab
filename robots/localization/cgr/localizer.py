"""Corrective gradient refinement: predict, refine, weigh, resample."""

import numpy as np
from numpy.typing import NDArray

from maps.vector_map import VectorMap
from robots.localization.cgr.parameters import CgrParameters
from robots.localization.cgr.refinement import Refinement
from robots.localization.localizer import Estimate, PointClass
from robots.localization.particles.motion import moved, scattered
from robots.localization.particles.weights import mean_pose, normalized, resampled
from robots.localization.points import ScanPoints, scan_points
from robots.localization.pose import Poses, wrap
from robots.localization.scan import Scan, ScanStream


class CgrLocalizer:
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
        self._refine = Refinement(np.array(vector_map.segments), self.parameters)
        self._generator = np.random.default_rng(seed)
        self.reset(np.zeros(3))

    def reset(self, pose: Poses, covariance: NDArray[np.float64] | None = None) -> None:
        """Scatter the particles around a pose."""
        its = self.parameters
        deviations = (
            np.array([its.start_deviation_m, its.start_deviation_m, its.start_deviation_rad])
            if covariance is None
            else np.sqrt(np.diag(covariance))
        )
        self._particles = scattered(np.asarray(pose), deviations, its.particles, self._generator)
        self._stream = ScanStream()
        self._lost = 0.0

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
        its = self.parameters
        explained = self._refine.distances(pose, points, sensor, reach_m) < its.explained_within_m
        unexplained = 1.0 - float(explained.mean()) if len(points) else 1.0
        self._lost = its.lost_memory * self._lost + (1.0 - its.lost_memory) * unexplained
        classes = np.where(explained, PointClass.LTF, PointClass.DF).astype(np.int8)
        return Estimate(pose, covariance, points, classes, self._lost, self._lost > its.lost_above)
