"""The poses that still matter, and what ties them to the map and to each other."""

from dataclasses import replace
from itertools import count

import numpy as np

from mend.localization.enml.correspondences import StfMatches, stf_constraints
from mend.localization.enml.motion_model import Travel
from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.pose_node import PoseNode
from mend.localization.enml.prior import prior_on_last
from mend.localization.enml.problem import Floats, LtfConstraints, PoseGraph
from mend.localization.points import ScanPoints
from mend.localization.pose import Poses, compose, relative
from mend.localization.scan import Scan

Ties = dict[tuple[int, int], StfMatches]


class Episode:
    """Nodes and their poses, oldest first, with a prior on the oldest.

    The newest pose is provisional: it stays only if the robot has moved away far enough by the time
    the next scan comes, and otherwise gives way to it.
    """

    def __init__(self, parameters: EnmlParameters, prior: Poses, prior_whitening: Floats) -> None:
        self._parameters = parameters
        self._identities = count()
        self.prior = prior
        self.prior_whitening = prior_whitening
        self.nodes: list[PoseNode] = []
        self.poses: Floats = np.zeros((0, 3))

    def __len__(self) -> int:
        return len(self.nodes)

    def off_map(self, prior_whitening: Floats) -> "Episode":
        """The same scans, wherever they were taken."""
        other = Episode(self._parameters, self.poses[0].copy(), prior_whitening)
        other._identities = count(self.nodes[-1].identity + 1)
        other.nodes = [node.off_map() for node in self.nodes]
        other.poses = self.poses.copy()
        return other

    def extend(self, step: Poses, scan: Scan, scan_points: ScanPoints) -> None:
        """Add what was seen after a motion, in place of the newest pose if that is too near."""
        if not self.nodes:
            travel, predicted = Travel(), self.prior
        elif self.newest_stays:
            travel, predicted = Travel(), compose(self.poses[-1], step)
            travel.add(step)
        else:
            travel, predicted = self.nodes.pop().travel, compose(self.poses[-1], step)
            travel.add(step)
            self.poses = self.poses[:-1]
        its = self._parameters
        node = PoseNode.of(next(self._identities), scan, scan_points, travel, its.gate_m)
        self.nodes.append(node)
        self.poses = np.vstack([self.poses, predicted])

    @property
    def newest_stays(self) -> bool:
        """Whether the newest pose will be kept beside the next."""
        travel = self.nodes[-1].travel
        return (
            len(self.nodes) == 1
            or float(np.hypot(*travel.motion[:2])) >= self._parameters.min_translation_m
            or travel.turned_rad >= self._parameters.min_rotation_rad
        )

    def move(self, newest: Poses, prior_whitening: Floats) -> None:
        """Shift all poses alike, so that the newest comes to a place; all are open to doubt."""
        self.poses = compose(newest, relative(self.poses[-1], self.poses))
        self.prior, self.prior_whitening = self.poses[0].copy(), prior_whitening

    def problem(self, ties: Ties, first: int = 0, last: int | None = None) -> PoseGraph:
        """The constraints on the poses from `first` to `last` (exclusive; all if None)."""
        nodes = self.nodes[first:last]
        parameters = self._parameters
        width_m = parameters.laser_std_m
        moves = [node.travel for node in nodes[1:]]
        return PoseGraph(
            prior=self.prior,
            prior_whitening=self.prior_whitening,
            odometry=np.array([each.motion for each in moves]).reshape(-1, 3),
            odometry_whitening=np.array([each.whitening(parameters) for each in moves]).reshape(
                -1, 3, 3
            ),
            odometry_width=parameters.odometry_robust_width,
            ltf=_ltf_constraints(nodes, width_m / parameters.gate_m),
            stf=stf_constraints(ties, width_m),
            ltf_weight=parameters.ltf_correlation / parameters.laser_std_m**2,
            stf_weight=parameters.stf_correlation / parameters.laser_std_m**2,
        )

    def forget_before(self, boundary: int, ties: Ties) -> None:
        """Drop the poses before `boundary`; its prior keeps what they knew of it."""
        if boundary == 0:
            return
        kept = {pair: found for pair, found in ties.items() if pair[1] < boundary}
        # The boundary's own points stay in the episode, so they must not count in its prior.
        left = self.problem(kept, 0, boundary + 1)
        without = _without_last_ltf(left)
        self.prior, self.prior_whitening = prior_on_last(without, self.poses[: boundary + 1])
        self.nodes = self.nodes[boundary:]
        self.poses = self.poses[boundary:]


def _ltf_constraints(nodes: list[PoseNode], width_per_gate: float) -> LtfConstraints:
    counts = [len(node.ltf.rows) for node in nodes]
    return LtfConstraints(
        start=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        points=np.concatenate([node.ltf.points for node in nodes]),
        normals=np.concatenate([node.ltf.normals for node in nodes]),
        offsets=np.concatenate([node.ltf.offsets for node in nodes]),
        widths_m=np.array([node.gate_m * width_per_gate for node in nodes]),
    )


def _without_last_ltf(problem: PoseGraph) -> PoseGraph:
    ltf = problem.ltf
    start = ltf.start.copy()
    start[-1] = start[-2]
    without = LtfConstraints(start, ltf.points, ltf.normals, ltf.offsets, ltf.widths_m)
    return replace(problem, ltf=without)
