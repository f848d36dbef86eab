"""Monte Carlo localization: particles moved by odometry, weighed by a likelihood field."""

import numpy as np
from numpy.typing import NDArray

from maps.vector_map import VectorMap
from robots.localization.localizer import Estimate, PointClass
from robots.localization.mcl.likelihood import FieldLikelihood
from robots.localization.mcl.likelihood_field import distance_field
from robots.localization.mcl.parameters import MclParameters
from robots.localization.particles.motion import moved, scattered
from robots.localization.particles.weights import (
    effective_count,
    mean_pose,
    normalized,
    resampled,
)
from robots.localization.points import ScanPoints, scan_points
from robots.localization.pose import Poses, compose, transform
from robots.localization.scan import Scan, ScanStream


class MclLocalizer:
    """Follows one robot; the same seed and input give the same estimates."""

    def __init__(
        self,
        vector_map: VectorMap,
        *,
        parameters: MclParameters | None = None,
        seed: int = 1,
    ) -> None:
        """Stands at the origin until `reset`. Raises `ValueError` where the map is too large."""
        self.parameters = parameters or MclParameters()
        self._field = distance_field(
            vector_map, self.parameters.cell_m, self.parameters.field_reach_m
        )
        self._likelihood = FieldLikelihood(self._field, self.parameters)
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
        self._log_weights = np.zeros(its.particles)
        self._stream = ScanStream()
        self._pending = np.zeros(3)
        self._way_m = self._turned = np.inf
        self._lost = 0.0

    def update(self, odometry: Poses, scan: Scan) -> Estimate:
        """Raises `InvalidScanError`, and is then as it was before."""
        its = self.parameters
        motion = self._stream.accept(odometry, scan)
        self._pending = compose(self._pending, motion)
        self._way_m += float(np.hypot(motion[0], motion[1]))
        self._turned += abs(float(motion[2]))
        points = scan_points(scan, its.min_range_m, its.max_range_m)
        if self._way_m < its.min_move_m and self._turned < its.min_turn_rad:
            mean, covariance = mean_pose(self._particles, normalized(self._log_weights))
            return self._estimate(compose(mean, self._pending), covariance, points)
        self._particles = moved(self._particles, self._pending, its.motion, self._generator)
        self._pending = np.zeros(3)
        self._way_m = self._turned = 0.0
        if len(points):
            self._weigh(points)
        weights = normalized(self._log_weights)
        mean, covariance = mean_pose(self._particles, weights)
        if effective_count(weights) < its.resample_below * its.particles:
            drawn = resampled(weights, its.particles, self._generator)
            self._particles = self._particles[drawn]
            self._log_weights = np.zeros(its.particles)
        return self._estimate(mean, covariance, points)

    def _weigh(self, points: ScanPoints) -> None:
        used = np.linspace(0, len(points) - 1, min(self.parameters.beams, len(points)))
        chosen = np.ascontiguousarray(points.points[used.round().astype(np.int64)])
        likelihood = self._likelihood(self._particles, chosen)
        self._log_weights = self._log_weights + self.parameters.trust * likelihood

    def _estimate(
        self, pose: Poses, covariance: NDArray[np.float64], points: ScanPoints
    ) -> Estimate:
        its = self.parameters
        away = self._field.at(transform(pose, points.points))
        explained = away < its.explained_within_m
        unexplained = 1.0 - float(explained.mean()) if len(points) else 1.0
        self._lost = its.lost_memory * self._lost + (1.0 - its.lost_memory) * unexplained
        classes = np.where(explained, PointClass.LTF, PointClass.DF).astype(np.int8)
        return Estimate(pose, covariance, points, classes, self._lost, self._lost > its.lost_above)
