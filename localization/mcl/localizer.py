"""Monte Carlo localization: particles moved by odometry, weighed by a likelihood field."""

import numpy as np
from numpy.typing import NDArray

from mend.localization.distance_field import distance_field
from mend.localization.localizer import Estimate
from mend.localization.mcl.likelihood import FieldLikelihood
from mend.localization.mcl.parameters import MclParameters
from mend.localization.particles.cloud import ParticleCloud
from mend.localization.particles.motion import moved
from mend.localization.particles.weights import (
    effective_count,
    mean_pose,
    normalized,
    resampled,
)
from mend.localization.points import ScanPoints, scan_points
from mend.localization.pose import Poses, compose, transform
from mend.localization.scan import Scan
from mend.maps.vector_map import VectorMap


class MclLocalizer(ParticleCloud):
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
        super().__init__(self.parameters, seed)
        self._field = distance_field(
            vector_map, self.parameters.cell_m, self.parameters.field_reach_m
        )
        self._likelihood = FieldLikelihood(self._field, self.parameters)
        self.reset(np.zeros(3))

    def reset(self, pose: Poses, covariance: NDArray[np.float64] | None = None) -> None:
        """Scatter the particles around a pose."""
        super().reset(pose, covariance)
        self._log_weights = np.zeros(self.parameters.particles)
        self._pending = np.zeros(3)
        self._way_m = self._turned = np.inf

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
        away_m = self._field.at(transform(pose, points.points))
        return self._estimated(pose, covariance, points, away_m)
