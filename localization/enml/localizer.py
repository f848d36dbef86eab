"""Episodic non-Markov localization as a stream: a motion and a scan in, an estimate out."""

from functools import partial

import numpy as np
from numpy.typing import NDArray

from mend.localization.beam_model import log_densities, spread
from mend.localization.distance_field import distance_field
from mend.localization.enml import normal_equations
from mend.localization.enml.alignment import Aligner
from mend.localization.enml.anywhere import Anywhere
from mend.localization.enml.change import LEAST_RETURNS, Strangeness
from mend.localization.enml.classification import LongTermFeatures, look_at
from mend.localization.enml.global_search import Region, same_place
from mend.localization.enml.lost_measure import LOST_ABOVE, LostMeasure
from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.pose_node import PoseNode
from mend.localization.enml.problem import Floats
from mend.localization.enml.recovery import MayBeAt, Recovery
from mend.localization.enml.sight import Sight
from mend.localization.enml.solver import Linearize
from mend.localization.enml.track import By, Track
from mend.localization.enml.wheels import Wheels
from mend.localization.localizer import Estimate, PointClass
from mend.localization.points import DEFAULT_MAX_RANGE_M, ScanPoints
from mend.localization.pose import Poses, compose, wrap_angle
from mend.localization.scan import Scan, ScanStream
from mend.maps.ray_cast import NOTHING
from mend.maps.segment_grid import segment_grid
from mend.maps.vector_map import VectorMap

_FIELD_CELL_M = 0.1
_FIELD_REACH_M = 1.0
_LOST_STD = np.array([10.0, 10.0, np.pi])
_FOUND_STD = np.array([0.3, 0.3, np.radians(5.0)])
_LEAST_VARIANCE = 1e-8
_FIRST_STD = np.array([0.1, 0.1, np.radians(3.0)])


class EnmlLocalizer:
    """Follows one robot over a vector map on which much of what it sees is missing.

    While it doubts that the robot is where it follows it, it goes on doing so, and beside it
    gathers what is seen from then on, by itself, to lay over the map elsewhere.
    """

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
        self._grid = grid = segment_grid(vector_map.segments)
        field = distance_field(vector_map, _FIELD_CELL_M, _FIELD_REACH_M)
        self._new_track = partial(
            Track,
            parameters=self._parameters,
            aligner=Aligner(field, self._parameters),
            long_term=LongTermFeatures(grid, self._parameters),
            linearize=linearize,
        )
        everywhere = Region(*vector_map.bounds)
        self._is_empty = not len(vector_map)
        self._anywhere = Anywhere(grid, everywhere)
        self._recovery = Recovery(
            everywhere, field, grid, self._anywhere, self._parameters, may_be_at
        )
        self._measure = LostMeasure(self._parameters)
        self.reset(np.zeros(3) if start is None else start)

    def reset(self, pose: Poses, covariance: NDArray[np.float64] | None = None) -> None:
        """Start anew at a pose, with its (3, 3) covariance or one that is small.

        A covariance that is very wide says that the robot is lost: it is then looked for
        everywhere. On a map that shows nothing it always is.
        """
        if covariance is None:
            covariance = np.diag(_FIRST_STD**2)
        covariance = np.asarray(covariance, dtype=np.float64) + _LEAST_VARIANCE * np.eye(3)
        self._stream = ScanStream()
        self._sight = Sight(self._parameters)
        self._wheels = Wheels(self._parameters)
        self._unweighed = self._parameters.min_translation_m
        self._searched_m = self._probation_m = 0.0
        self._off_map_m = np.inf
        self._recovery.forget()
        self._measure.begin()
        self._strangeness = Strangeness(self._parameters)
        variance = covariance[0, 0] + covariance[1, 1]
        known = not self._is_empty and variance <= self._parameters.known_within_m**2
        self._track: Track = self._new_track(By.MAP if known else By.ITSELF, pose, covariance)
        self._stray: Track | None = None
        self._seen: tuple[Scan, ScanPoints] | None = None
        self._since_lost_m = 0.0
        self._drifted = self._search_at_once = self._is_in_doubt = False

    @property
    def episode_poses(self) -> Floats:
        """The poses (n, 3) that the newest episode holds, oldest first."""
        return self._track.episode.poses.copy()

    def search_next(self) -> None:
        """Let the next update of a robot that is lost, or in doubt, search the map to the end."""
        self._search_at_once = True

    def open_places(self) -> list[Poses]:
        """Where the robot may be by what it has seen since it was lost, the likeliest first."""
        episode = self._unplaced.episode
        if not len(episode):
            return []
        return [each.pose for each in self._recovery.open_places(episode)]

    def get_lost(self) -> None:
        """Where the robot is believed to be is believed no more, until a search finds a place."""
        if not self._is_lost:
            self._lose(drifted=False)
        self._track, self._stray = self._unplaced, None

    def take(self, place: Poses) -> None:
        """The robot is at one of the open places: on probation, as what was found by a search."""
        self._believe(np.asarray(place, dtype=np.float64))

    def update(self, odometry: Poses, scan: Scan) -> Estimate:
        """Take the motion since the last update (robot's frame) and what is seen after it.

        Raises `InvalidScanError`, and is then as it was before.
        """
        told = self._stream.accept(odometry, scan)
        moved_m = float(np.hypot(told[0], told[1]))
        motion = self._wheels.corrected(told)
        points = self._sight.take(scan, moved_m)
        self._seen = scan, points
        covariance = self._track.advance(motion, scan, points)
        if self._stray is not None:
            self._stray.advance(motion, scan, points)
        self._recovery.move(motion)
        self._unweighed += moved_m + abs(float(motion[2]))
        self._since_lost_m += moved_m
        self._off_map_m += moved_m
        self._searched_m += moved_m
        self._probation_m -= moved_m
        self._weigh_place()
        self._learn_wheels()
        if self._is_lost or self._probation_m > 0.0:
            covariance = self._look_for_place(covariance)
        self._search_at_once = False
        return self._estimate(covariance)

    def _learn_wheels(self) -> None:
        """While it is sure where the robot is."""
        if self._is_lost or self._probation_m > 0.0:
            return
        step = self._track.last_step()
        if step is not None:
            self._wheels.learn(step)

    @property
    def _is_lost(self) -> bool:
        return self._stray is not None or self._track.by is By.ITSELF

    @property
    def _unplaced(self) -> Track:
        """What has been seen since the robot was lost, wherever it is."""
        return self._stray or self._track

    def _estimate(self, covariance: Floats) -> Estimate:
        node = self._track.episode.nodes[-1]
        pose = self._track.pose.copy()
        pose[2] = wrap_angle(pose[2])
        classes = np.full(len(node.scan_points), PointClass.DF, dtype=np.int8)
        classes[node.is_stf] = PointClass.STF
        classes[node.is_ltf] = PointClass.LTF
        lost = self._measure.probability
        if self._is_lost:
            lost = LOST_ABOVE if self._is_in_doubt else 1.0
        return Estimate(
            pose,
            covariance,
            node.scan_points,
            classes,
            self._sight.doubted(lost),
            (self._is_lost and not self._is_in_doubt) or self._sight.is_gone,
        )

    def _weigh_place(self) -> None:
        """Judge by the newest scan whether the robot was carried, or is followed elsewhere."""
        episode = self._unplaced.episode
        if len(episode.nodes[-1].ranges_m) < LEAST_RETURNS:
            return
        # Who is lost begins anew only for what is sure, as a look at all since then is worth much.
        within_m = self._parameters.min_translation_m if self._is_lost else np.inf
        its = self._parameters
        news = 0.0 if self._is_lost else min(self._unweighed / its.min_translation_m, 1.0)
        beside = self._strangeness.compare(episode, within_m, news)
        elsewhere = 0.0
        if not self._is_lost:
            place = self._against_place(episode.nodes[-1])
            elsewhere = its.map_counts * (place - its.map_misleads)
        # Whoever stands may be carried, too, and the first scan there is all news; the next ones
        # say much the same again.
        least_m = its.min_translation_m if beside.is_sudden else 0.0
        self._measure.weigh(max(self._unweighed, least_m), beside, elsewhere)
        self._unweighed = 0.0
        if self._measure.probability > LOST_ABOVE:
            self._lose(drifted=beside.strange <= 0.0 and self._measure.is_by_map)

    def _against_place(self, node: PoseNode) -> float:
        """How much likelier a scan is anywhere on the map than where the robot is followed.

        Infinitely, where the map has shown nothing at all for long: who is off the map is not
        there.
        """
        model = self._anywhere.model
        used = spread(len(node.ranges_m), model.beams)
        bearings = node.bearings[used]
        if not self._is_off_map(node, bearings):
            self._off_map_m = 0.0
        if self._off_map_m >= self._parameters.off_map_for_m:
            return np.inf
        here = log_densities(node.ranges_m[used], node.expected_m[used], model).mean()
        anywhere = self._anywhere.log_likelihood(
            node.ranges_m[used], bearings + node.sensor_offset[2]
        )
        return anywhere - model.trust * model.beams * float(here)

    def _is_off_map(self, node: PoseNode, bearings: Floats) -> bool:
        """Whether the map shows nothing around the robot, however far a laser reaches."""
        if (node.expected_m < node.reach_m).any():
            return False
        sensor = compose(self._track.pose, node.sensor_offset)
        looked = look_at(self._grid, sensor, bearings, DEFAULT_MAX_RANGE_M)[1]
        return bool((looked == NOTHING).all())

    def _lose(self, *, drifted: bool) -> None:
        """Doubt the place: what is seen from now on may belong elsewhere.

        Where it has drifted off, rather than been carried, that holds for the last metres, too. It
        is only in doubt then until a search has ended: of all places of a map some fits what one
        scan shows of things that are on none.

        A place on probation that is lost was never the right one.
        """
        if self._probation_m <= 0.0:
            self._recovery.forget()
            self._since_lost_m = 0.0
        self._recovery.stop()
        unplaced = self._by_itself()
        self._drifted = drifted
        self._is_in_doubt = drifted and self._track.by is By.MAP
        if drifted:
            unplaced.go_by_itself(self._track.episode, np.diag(_LOST_STD**2))
        if self._track.by is By.ITSELF:
            self._track = unplaced
        else:
            self._stray = unplaced
        self._measure.begin()
        self._strangeness.begin_anew()
        self._probation_m = 0.0
        self._searched_m = np.inf if drifted else 0.0

    def _by_itself(self) -> Track:
        """What begins with the newest scan, and nothing before it."""
        track: Track = self._new_track(By.ITSELF, self._track.pose, np.diag(_LOST_STD**2))
        if self._seen is not None:
            track.advance(np.zeros(3), *self._seen)
        return track

    def _look_for_place(self, covariance: Floats) -> Floats:
        """Search the map every so often; take the episode to where it clearly belongs."""
        track, recovery = self._track, self._recovery
        at_once = self._search_at_once
        due = self._searched_m >= self._parameters.min_translation_m
        if at_once or (due and not recovery.is_searching):
            self._searched_m = 0.0
            followed = track.episode if track.by is By.MAP else None
            recovery.begin(
                self._unplaced.episode, followed, self._since_lost_m, drifted=self._drifted
            )
        searches = recovery.is_searching
        found = recovery.go_on(to_its_end=at_once)
        if self._is_in_doubt and searches and not recovery.is_searching and found is None:
            self._is_in_doubt = False
            if not recovery.suspects_elsewhere:
                self._believe(track.pose)
            return covariance
        if found is None or (not self._is_lost and same_place(found.pose, track.pose)):
            return covariance
        moved = self._believe(found.pose)
        return covariance if moved is None else moved

    def _believe(self, place: Poses) -> Floats | None:
        """The robot is at a place; the covariance, if it was followed elsewhere."""
        self._is_in_doubt = False
        # What a search still looked through was seen before this was known.
        self._recovery.stop()
        self._measure.begin(self._recovery.is_wrong)
        self._strangeness.begin_anew()
        if self._track.by is By.MAP and same_place(place, self._track.pose):
            self._stray = None
            return None
        self._track, self._stray = self._unplaced, None
        self._probation_m = self._parameters.blind_for_m
        return self._track.lay_over_map(place, _FOUND_STD)
