"""Episodic non-Markov localization as a stream: a motion and a scan in, an estimate out."""

from enum import Enum

import numpy as np
from numpy.typing import NDArray

from mend.localization.distance_field import distance_field
from mend.localization.enml import normal_equations
from mend.localization.enml.alignment import Aligner
from mend.localization.enml.classification import LongTermFeatures
from mend.localization.enml.correspondences import ShortTermFeatures
from mend.localization.enml.episode import Episode, Ties
from mend.localization.enml.episodes import episode_start
from mend.localization.enml.familiarity import LEAST_RETURNS, Familiarity
from mend.localization.enml.global_search import Region, same_place
from mend.localization.enml.lost import MapFit, evidence_of
from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.prior import whitening_of
from mend.localization.enml.problem import Floats
from mend.localization.enml.recovery import Found, MayBeAt, Recovery
from mend.localization.enml.sight import Sight
from mend.localization.enml.solver import Linearize, Solution, solve
from mend.localization.localizer import Estimate, PointClass
from mend.localization.points import DEFAULT_MAX_RANGE_M
from mend.localization.pose import Poses, transform, wrap, wrap_angle
from mend.localization.scan import Scan, ScanStream
from mend.maps.vector_map import VectorMap

_FIELD_CELL_M = 0.1
_FIELD_REACH_M = 1.0
_LOST_STD = np.array([10.0, 10.0, np.pi])
_FOUND_STD = np.array([0.3, 0.3, np.radians(5.0)])
_LEAST_VARIANCE = 1e-8
_FIRST_STD = np.array([0.1, 0.1, np.radians(3.0)])


class Mode(Enum):
    """Whether the map is believed: lost, the robot goes by odometry and what it just saw."""

    TRACKING = "tracking"
    LOST = "lost"


class EnmlLocalizer:
    """Follows one robot over a vector map on which much of what it sees is missing."""

    def __init__(
        self,
        vector_map: VectorMap,
        *,
        parameters: EnmlParameters | None = None,
        start: Poses | None = None,
        linearize: Linearize = normal_equations.linearize,
        may_be_at: MayBeAt | None = None,
    ) -> None:
        """`may_be_at`: no search finds the robot where it cannot be, as outside of a building."""
        self._parameters = parameters or EnmlParameters()
        self._linearize = linearize
        self._long_term = LongTermFeatures(
            vector_map.segments, DEFAULT_MAX_RANGE_M, self._parameters
        )
        field = distance_field(vector_map, _FIELD_CELL_M, _FIELD_REACH_M)
        self._aligner = Aligner(field, self._parameters)
        x_min, y_min, x_max, y_max = vector_map.bounds
        self._recovery = Recovery(
            vector_map.segments,
            Region(x_min, y_min, x_max, y_max),
            field,
            DEFAULT_MAX_RANGE_M,
            self._parameters,
            may_be_at,
        )
        self._mode = Mode.TRACKING
        self._evidence = MapFit()
        self._familiarity = Familiarity(self._recovery.behind, self._parameters)
        self._may_be_anywhere = False
        self._driven_m = self._next_search_m = 0.0
        self._probation_until_m = self._confirmed_until_m = 0.0
        self._short_term = ShortTermFeatures(self._parameters)
        self.reset(np.zeros(3) if start is None else start)

    def reset(self, pose: Poses, covariance: NDArray[np.float64] | None = None) -> None:
        """Start anew at a pose, with its (3, 3) covariance or one that is small.

        A covariance wider than the place near which a lost robot is looked for says that the robot
        is lost: it is then looked for everywhere.
        """
        if covariance is None:
            covariance = np.diag(_FIRST_STD**2)
        covariance = np.asarray(covariance, dtype=np.float64) + _LEAST_VARIANCE * np.eye(3)
        self._stream = ScanStream()
        self._sight = Sight(self._parameters)
        self._short_term.forget()
        self._driven_m, self._next_search_m = 0.0, self._parameters.recovery_every_m
        self._probation_until_m = 0.0
        self._recovery.forget()
        self._track(MapFit())
        self._may_be_anywhere = bool(
            covariance[0, 0] + covariance[1, 1] > self._parameters.recovery_near_m**2
        )
        if self._may_be_anywhere:
            self._mode = Mode.LOST
        self._episode = Episode(
            self._parameters, np.asarray(pose, dtype=np.float64), whitening_of(covariance)
        )

    @property
    def episode_poses(self) -> Floats:
        """The poses (n, 3) that the newest episode holds, oldest first."""
        return self._episode.poses.copy()

    def search_next(self) -> None:
        """Let the next update of a robot that is lost, or in doubt, search the map at once."""
        self._next_search_m = self._driven_m

    def open_places(self) -> list[Poses]:
        """Where the robot may be by what it has seen since it was lost, the likeliest first."""
        if not len(self._episode.nodes):
            return []
        return [each.pose for each in self._recovery.open_places(self._episode)]

    def get_lost(self) -> None:
        """Where the robot is believed to be is believed no more, until a search finds a place."""
        self._may_be_anywhere = True
        self._lose()

    def take(self, place: Poses) -> None:
        """The robot is at one of the open places: on probation, as what was found by a search."""
        self._move(self._recovery.weighed(self._episode, np.asarray(place)), proven=False)

    def update(self, odometry: Poses, scan: Scan) -> Estimate:
        """Take the motion since the last update (robot's frame) and what is seen after it.

        Raises `InvalidScanError`, and is then as it was before.
        """
        motion = self._stream.accept(odometry, scan)
        moved_m = float(np.hypot(motion[0], motion[1]))
        self._episode.extend(motion, scan, self._sight.take(scan, moved_m))
        self._driven_m += moved_m
        self._recovery.move(motion)
        unexplained = self._align()
        on_map = self._mode is Mode.TRACKING
        if self._familiarity.notices_change(self._episode, unexplained, on_map=on_map):
            self._take_for_carried()
        self._set_first_gate()
        covariance = self._settle()
        if self._mode is Mode.TRACKING:
            self._weigh_evidence()
        if self._mode is Mode.LOST or self._in_doubt or self._on_probation:
            covariance = self._look_for_place(covariance)
        return self._estimate(covariance)

    def _estimate(self, covariance: Floats) -> Estimate:
        node = self._episode.nodes[-1]
        pose = self._episode.poses[-1].copy()
        pose[2] = wrap_angle(pose[2])
        classes = np.full(len(node.scan_points), PointClass.DF, dtype=np.int8)
        classes[node.is_stf] = PointClass.STF
        classes[node.is_ltf] = PointClass.LTF
        is_lost = self._mode is Mode.LOST
        lost = 1.0 if is_lost else max(self._evidence.lost, self._evidence.contradiction)
        return Estimate(
            pose,
            covariance,
            node.scan_points,
            classes,
            self._sight.doubted(lost),
            is_lost or self._says_doubt or self._sight.is_gone,
        )

    def _take_for_carried(self) -> None:
        """Forget the way here; but much may have changed at once where the robot was."""
        self._episode.keep_newest()
        self._recovery.forget(self._episode.poses[-1])
        self._probation_until_m = 0.0
        self._lose()
        self._may_be_anywhere = True

    def _weigh_evidence(self) -> None:
        """Judge by the newest scans whether the robot is where it is believed to be."""
        if self._familiarity.notices_strangers(self._episode):
            self._take_for_carried()
            return
        self._evidence = self._evidence.faded(
            self._parameters.evidence_fading, evidence_of(self._episode.nodes[-1])
        )
        if (
            self._driven_m >= self._next_search_m
            and self._evidence.contradiction > self._parameters.lost_above
            and self._evidence.returns >= LEAST_RETURNS
        ):
            self._lose()
            self._next_search_m = self._driven_m

    @property
    def _in_doubt(self) -> bool:
        return (
            self._evidence.contradiction > self._parameters.doubt_above
            and self._evidence.returns >= LEAST_RETURNS
        )

    @property
    def _says_doubt(self) -> bool:
        """Whether it is doubtful where the robot is, and no search has just found it there."""
        return self._in_doubt and self._driven_m >= self._confirmed_until_m

    def _look_for_place(self, covariance: Floats) -> Floats:
        """Search the map every so often; take the episode to where it clearly belongs."""
        if self._driven_m < self._next_search_m:
            return covariance
        self._next_search_m = self._driven_m + self._parameters.recovery_every_m
        here = self._episode.poses[-1]
        anywhere = self._may_be_anywhere or self._on_probation
        proven = self._evidence.lost < self._parameters.proven_below
        if self._mode is Mode.TRACKING and proven and not self._in_doubt:
            found = self._recovery.reconsider(self._episode, here)
        else:
            found = self._recovery.search(
                self._episode,
                None if anywhere else here,
                self._driven_m if anywhere or self._mode is Mode.LOST else 0.0,
            )
            if found is None and self._on_probation:
                self._lose()
        if found is None:
            return covariance
        if self._mode is Mode.TRACKING and same_place(found.pose, here):
            if found.evidence.lost < self._parameters.confirmed_below:
                self._confirmed_until_m = self._driven_m + 2.0 * self._parameters.recovery_every_m
            return covariance
        return self._move(found, proven=not anywhere and same_place(found.pose, here))

    def _move(self, found: Found, *, proven: bool) -> Floats:
        """Take the episode to where it was found; unless that is proven, be on one's guard."""
        self._episode.move(found.pose, np.diag(1.0 / _FOUND_STD))
        for node in self._episode.nodes:
            node.gate_m = self._parameters.ltf_gate_m
        self._track(found.evidence)
        if not proven:
            self._probation_until_m = self._driven_m + self._parameters.probation_m
        return self._settle()

    @property
    def _on_probation(self) -> bool:
        return self._driven_m < self._probation_until_m

    def _lose(self) -> None:
        """Believe the map no more. A place on probation that is lost was never the right one."""
        self._mode = Mode.LOST
        if self._on_probation:
            self._may_be_anywhere = True
        else:
            self._driven_m = 0.0
        self._probation_until_m = 0.0
        self._next_search_m = self._driven_m + self._parameters.recovery_every_m
        self._episode.leave_map(np.diag(1.0 / _LOST_STD))

    def _track(self, seen: MapFit) -> None:
        self._mode = Mode.TRACKING
        self._evidence = seen
        self._familiarity.forget()
        self._may_be_anywhere = False
        self._confirmed_until_m = 0.0

    def _settle(self) -> Floats:
        """Find the best poses, let go of what the episode needs no more; the covariance."""
        ties, solution = self._associate_and_solve()
        boundary = episode_start(
            len(self._episode),
            ties,
            self._parameters.min_episode_length,
            self._parameters.max_episode_length,
        )
        self._episode.forget_before(boundary, ties)
        return solution.covariance_of(-1)

    def _align(self) -> float:
        """Move the newest prediction to where its scan fits better; the share that fits nothing."""
        episode, parameters = self._episode, self._parameters
        nodes, poses = episode.nodes, episode.poses
        recent = [
            transform(pose, node.scan_points.points)
            for node, pose in list(zip(nodes[:-1], poses, strict=False))[
                -parameters.alignment_scans :
            ]
        ]
        newest = nodes[-1]
        aligned = self._aligner.align(
            np.concatenate([np.zeros((0, 2)), *recent]),
            newest.scan_points.points,
            poses[-1],
            newest.travel.deviations(parameters),
            on_map=self._mode is Mode.TRACKING,
        )
        believed = aligned.fit >= parameters.alignment_believed_above
        if believed and aligned.gain > parameters.alignment_min_gain:
            poses[-1] = aligned.pose
        return aligned.unexplained

    def _set_first_gate(self) -> None:
        """Open the newest pose's gate as wide as its prediction is uncertain."""
        parameters = self._parameters
        node = self._episode.nodes[-1]
        along_m, across_m, heading_rad = node.travel.deviations(parameters)
        points = node.scan_points.points
        reach_m = float(np.median(np.hypot(*points.T))) if len(points) else 0.0
        doubt_m = 2.0 * float(np.hypot(max(along_m, across_m), heading_rad * reach_m))
        node.gate_m = float(np.clip(doubt_m, parameters.ltf_gate_m, parameters.ltf_widest_gate_m))

    def _associate_and_solve(self) -> tuple[Ties, Solution]:
        """Alternate between deciding what points are and where the poses are best."""
        parameters = self._parameters
        episode = self._episode
        for _ in range(parameters.association_rounds):
            changed = self._classify()
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

    def _classify(self) -> set[int]:
        """Decide what lies on the map's lines; at which poses that was decided anew."""
        if self._mode is Mode.LOST:
            return set()
        poses = zip(self._episode.nodes, self._episode.poses, strict=True)
        return {
            index
            for index, (node, pose) in enumerate(poses)
            if self._long_term.classify(node, pose)
        }

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
