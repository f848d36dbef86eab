"""Episodic non-Markov localization as a stream: a motion and a scan in, an estimate out."""

import numpy as np
from numpy.typing import NDArray

from maps.vector_map import VectorMap
from robots.localization.enml import normal_equations
from robots.localization.enml.classification import LongTermFeatures
from robots.localization.enml.correspondences import ShortTermFeatures
from robots.localization.enml.episode import Episode, Ties
from robots.localization.enml.episodes import episode_start
from robots.localization.enml.parameters import EnmlParameters
from robots.localization.enml.prior import whitening_of
from robots.localization.enml.problem import Floats
from robots.localization.enml.solver import Linearize, Solution, solve
from robots.localization.localizer import Estimate, PointClass
from robots.localization.points import DEFAULT_MAX_RANGE_M, scan_points
from robots.localization.pose import Poses, wrap, wrap_angle
from robots.localization.scan import Scan, ScanStream

_FIRST_STD = np.array([0.1, 0.1, np.radians(3.0)])


class EnmlLocalizer:
    """Follows one robot over a vector map on which much of what it sees is missing."""

    def __init__(
        self,
        vector_map: VectorMap,
        *,
        parameters: EnmlParameters | None = None,
        start: Poses | None = None,
        linearize: Linearize = normal_equations.linearize,
    ) -> None:
        self._parameters = parameters or EnmlParameters()
        self._linearize = linearize
        self._long_term = LongTermFeatures(
            vector_map.segments, DEFAULT_MAX_RANGE_M, self._parameters
        )
        self._short_term = ShortTermFeatures(self._parameters)
        self.reset(np.zeros(3) if start is None else start)

    def reset(self, pose: Poses, covariance: NDArray[np.float64] | None = None) -> None:
        """Start anew at a pose, with its (3, 3) covariance or one that is small."""
        if covariance is None:
            covariance = np.diag(_FIRST_STD**2)
        self._stream = ScanStream()
        self._short_term.forget()
        self._episode = Episode(
            self._parameters, np.asarray(pose, dtype=np.float64), whitening_of(covariance)
        )

    @property
    def episode_poses(self) -> Floats:
        """The poses (n, 3) that the newest episode holds, oldest first."""
        return self._episode.poses.copy()

    def update(self, odometry: Poses, scan: Scan) -> Estimate:
        """Take the motion since the last update (robot's frame) and what is seen after it.

        Raises `InvalidScanError`, and is then as it was before.
        """
        motion = self._stream.accept(odometry, scan)
        episode = self._episode
        episode.extend(motion, scan, scan_points(scan))
        self._set_first_gate()
        ties, solution = self._associate_and_solve()
        covariance = solution.covariance_of(-1)
        boundary = episode_start(
            len(episode),
            ties,
            self._parameters.min_episode_length,
            self._parameters.max_episode_length,
        )
        episode.forget_before(boundary, ties)
        node = episode.nodes[-1]
        pose = episode.poses[-1].copy()
        pose[2] = wrap_angle(pose[2])
        classes = np.full(len(node.scan_points), PointClass.DF, dtype=np.int8)
        classes[node.is_stf] = PointClass.STF
        classes[node.is_ltf] = PointClass.LTF
        return Estimate(pose, covariance, node.scan_points, classes, 0.0, False)

    def _set_first_gate(self) -> None:
        """Open the newest pose's gate as wide as its prediction is uncertain."""
        parameters = self._parameters
        node = self._episode.nodes[-1]
        along_m, across_m, heading_rad = node.travel.deviations(parameters)
        points = node.scan_points.points
        reach_m = float(np.median(np.hypot(*points.T))) if len(points) else 0.0
        doubt_m = 2.0 * float(np.hypot(max(along_m, across_m), heading_rad * reach_m))
        node.gate_m = float(
            np.clip(doubt_m, parameters.ltf_gate_m, parameters.ltf_widest_gate_m)
        )

    def _associate_and_solve(self) -> tuple[Ties, Solution]:
        """Alternate between deciding what points are and where the poses are best."""
        parameters = self._parameters
        episode = self._episode
        for _ in range(parameters.association_rounds):
            changed = {
                index
                for index, (node, pose) in enumerate(
                    zip(episode.nodes, episode.poses, strict=True)
                )
                if self._long_term.classify(node, pose)
            }
            ties = self._short_term.match(episode.nodes, episode.poses, changed)
            solution = solve(
                episode.problem(ties),
                episode.poses,
                parameters.solver_iterations,
                self._linearize,
            )
            moved = solution.poses - episode.poses
            episode.poses = solution.poses
            narrowed = self._narrow_gates()
            if not narrowed and self._is_settled(moved):
                break
        episode.poses[:, 2] = wrap(episode.poses[:, 2])
        return ties, solution

    def _narrow_gates(self) -> bool:
        narrowed = False
        for node in self._episode.nodes:
            narrower_m = max(node.gate_m / 2.0, self._parameters.ltf_gate_m)
            narrowed |= narrower_m < node.gate_m
            node.gate_m = narrower_m
        return narrowed

    def _is_settled(self, moved: Floats) -> bool:
        return bool(
            np.hypot(moved[:, 0], moved[:, 1]).max() < self._parameters.settled_m
            and np.abs(moved[:, 2]).max() < self._parameters.settled_rad
        )
