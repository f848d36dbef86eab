"""One way on which a robot is followed: its episode, laid over the map or by itself."""

from enum import Enum

import numpy as np

from mend.localization.enml.alignment import Aligner
from mend.localization.enml.classification import LongTermFeatures
from mend.localization.enml.correspondences import ShortTermFeatures
from mend.localization.enml.episode import Episode, Ties
from mend.localization.enml.episodes import episode_start
from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.prior import whitening_of
from mend.localization.enml.problem import Floats
from mend.localization.enml.settling import has_moved
from mend.localization.enml.solver import Linearize, Solution, solve
from mend.localization.enml.wheels import Step
from mend.localization.points import ScanPoints
from mend.localization.pose import Poses, transform, wrap
from mend.localization.scan import Scan

_MOST_ROUNDS = 4
"""Of association and optimization per update (published); they end once no pose has moved."""
_MOST_STEPS = 10
"""Of Levenberg-Marquardt per round (published 30, with a slower loss)."""


class By(Enum):
    """What a robot is followed by, besides odometry and what it just saw."""

    MAP = "map"
    ITSELF = "itself"


class Track:
    """Takes scans in, and finds the poses that they were taken from."""

    def __init__(
        self,
        by: By,
        start: Poses,
        covariance: Floats,
        *,
        parameters: EnmlParameters,
        aligner: Aligner,
        long_term: LongTermFeatures,
        linearize: Linearize,
    ) -> None:
        self.by = by
        self.episode = Episode(
            parameters, np.asarray(start, dtype=np.float64), whitening_of(covariance)
        )
        self._parameters = parameters
        self._aligner = aligner
        self._long_term = long_term
        self._short_term = ShortTermFeatures(parameters)
        self._linearize = linearize
        self._solution: Solution | None = None

    @property
    def pose(self) -> Poses:
        """Of the newest scan, or where the track begins before there is one."""
        return self.episode.poses[-1] if len(self.episode) else self.episode.prior

    def last_step(self) -> Step | None:
        """The way between the two newest poses, once both are kept."""
        episode, solution = self.episode, self._solution
        if solution is None or len(episode) < 2 or not episode.newest_stays:
            return None
        travel, (before, after) = episode.nodes[-1].travel, episode.poses[-2:]
        return Step(travel, before, after, solution.covariance_of(-2, -1))

    def advance(self, motion: Poses, scan: Scan, points: ScanPoints) -> Floats:
        """Take what was seen after a motion; the (3, 3) covariance of the newest pose."""
        self.episode.extend(motion, scan, points)
        self._align()
        self._set_first_gate()
        return self._settle()

    def go_by_itself(self, episode: Episode, covariance: Floats) -> None:
        """Take over what was seen on another track, but not where."""
        self.by = By.ITSELF
        self.episode = episode.off_map(whitening_of(covariance))
        self._settle()

    def lay_over_map(self, newest: Poses, deviations: Floats) -> Floats:
        """Take the episode to where its newest pose was found, so uncertain (x, y, heading)."""
        self.by = By.MAP
        self.episode.move(newest, np.diag(1.0 / deviations))
        for node in self.episode.nodes:
            node.gate_m = self._parameters.gate_m
        return self._settle()

    def _settle(self) -> Floats:
        """Find the best poses, let go of what the episode needs no more; the covariance."""
        ties, solution = self._associate_and_solve()
        boundary = episode_start(
            len(self.episode),
            ties,
            self._parameters.min_episode_length,
            self._parameters.max_episode_length,
        )
        self.episode.forget_before(boundary, ties)
        self._solution = solution
        return solution.covariance_of(-1)

    def _align(self) -> None:
        """Move the newest prediction to where its scan fits better."""
        episode, parameters = self.episode, self._parameters
        nodes, poses = episode.nodes, episode.poses
        recent = [
            transform(pose, node.scan_points.points)
            for node, pose in list(zip(nodes[:-1], poses, strict=False))[
                -parameters.min_episode_length :
            ]
        ]
        newest = nodes[-1]
        poses[-1] = self._aligner.align(
            np.concatenate([np.zeros((0, 2)), *recent]),
            newest.scan_points.points,
            poses[-1],
            newest.travel.deviations(parameters),
            on_map=self.by is By.MAP,
        )

    def _set_first_gate(self) -> None:
        """Open the newest pose's gate as wide as its prediction is uncertain."""
        parameters = self._parameters
        node = self.episode.nodes[-1]
        along_m, across_m, heading_rad = node.travel.deviations(parameters)
        points = node.scan_points.points
        reach_m = float(np.median(np.hypot(*points.T))) if len(points) else 0.0
        doubt_m = 2.0 * float(np.hypot(max(along_m, across_m), heading_rad * reach_m))
        node.gate_m = max(doubt_m, parameters.gate_m)

    def _associate_and_solve(self) -> tuple[Ties, Solution]:
        """Alternate between deciding what points are and where the poses are best."""
        episode = self.episode
        for _ in range(_MOST_ROUNDS):
            changed = self._classify()
            ties = self._short_term.match(episode.nodes, episode.poses, changed)
            solution = solve(episode.problem(ties), episode.poses, _MOST_STEPS, self._linearize)
            moved = solution.poses - episode.poses
            episode.poses = solution.poses
            narrowed = self._narrow_gates()
            if not narrowed and not has_moved(moved).any():
                break
        episode.poses[:, 2] = wrap(episode.poses[:, 2])
        return ties, solution

    def _classify(self) -> set[int]:
        """Decide what lies on the map's lines; at which poses that was decided anew."""
        if self.by is By.ITSELF:
            return set()
        poses = zip(self.episode.nodes, self.episode.poses, strict=True)
        return {
            index
            for index, (node, pose) in enumerate(poses)
            if self._long_term.classify(node, pose)
        }

    def _narrow_gates(self) -> bool:
        narrowed = False
        for node in self.episode.nodes:
            narrower_m = max(node.gate_m / 2.0, self._parameters.gate_m)
            narrowed |= narrower_m < node.gate_m
            node.gate_m = narrower_m
        return narrowed
