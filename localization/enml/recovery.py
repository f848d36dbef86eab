"""Finding a lost robot again: what it saw since, laid over the map."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np

from mend.localization.beam_model import BeamModelParameters
from mend.localization.distance_field import DistanceField
from mend.localization.enml.anywhere import Anywhere
from mend.localization.enml.episode import Episode
from mend.localization.enml.global_search import GlobalSearch, Region, distinct, same_place
from mend.localization.enml.looks import ScanLook, glance, log_likelihood, looks_of
from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.polishing import polish
from mend.localization.enml.problem import Floats
from mend.localization.enml.visible import Visible
from mend.localization.pose import Poses, compose, relative, transform

_THINNED_M = 0.25
_CANDIDATES = 4000
"""So many places of the lattice are glanced at with a few beams..."""
_BEAMS_GLANCED = 60
_CLIMBERS = 300
"""... the best of them moved to where the points fit, and weighed by two scans..."""
_FIRST_GATES_M = (0.6, 0.4, 0.25)
_LAST_GATES_M = (0.25, 0.15, 0.15)
_AROUND_M = (-0.6, -0.4, -0.2, 0.0, 0.2, 0.4, 0.6)
"""How far from where points have been moved to they may fit still better."""
_LEAST_FINALISTS, _MOST_FINALISTS = 40, 240
_IN_THE_RUNNING = 12.0
"""... and the best of those polished and weighed by more: many where many look much the same."""
_SCANS_POLISHED = 3
_SCANS_WEIGHED = 6
_LEAST_DOUBT = 0.5
"""The share of the lead that is always needed, and all that is where the robot is followed."""

_SHARP = BeamModelParameters(
    hit_share=0.4,
    short_share=0.59,
    random_share=0.01,
    hit_deviation_m=0.1,
    short_decay_per_m=0.05,
)
"""Places are told apart by some centimetres, and by the walls that they would be seen through."""

MayBeAt = Callable[[float, float], bool]
"""Whether the robot may be at a point of the map at all, x and y in metres."""


@dataclass(frozen=True, slots=True)
class Found:
    """A place for the newest pose, and what speaks for it."""

    pose: Poses
    score: float
    """Log-likelihood per scan, over that of a robot that may be anywhere."""


class Recovery:
    """Searches a map for where the newest pose of an episode may be.

    Places that one search leaves open are weighed again by the next, with what was seen since.
    """

    def __init__(
        self,
        everywhere: Region,
        field: DistanceField,
        visible: Visible,
        anywhere: Anywhere,
        parameters: EnmlParameters,
        may_be_at: MayBeAt | None = None,
    ) -> None:
        self._may_be_at = may_be_at
        self._everywhere = everywhere
        self._search = GlobalSearch(field)
        self._visible = visible
        self._anywhere = anywhere.by(_SHARP)
        self._parameters = parameters
        self.forget()

    def forget(self) -> None:
        """Begin anew: the robot may be elsewhere than all places so far."""
        self._open: Floats = np.zeros((0, 3))
        self._won: Poses | None = None

    def move(self, motion: Poses) -> None:
        """Let the open places come along with the robot."""
        if len(self._open):
            self._open = compose(self._open, motion)
        if self._won is not None:
            self._won = compose(self._won, motion)

    def open_places(self, episode: Episode) -> list[Found]:
        """The places that explain what is seen and are hardly worse than the best, best first."""
        looks = looks_of(episode, _SCANS_WEIGHED)
        ranked = _ranked(self._found(list(self._open), looks)) if len(self._open) else []
        return [
            each
            for each in ranked
            if each.score > self._parameters.found_above
            and each.score > ranked[0].score - _IN_THE_RUNNING
        ]

    def search(self, episode: Episode, followed: Episode | None, path_m: float) -> Found | None:
        """Where on the map the newest pose is; None if unclear.

        Where the robot is still `followed` is believed sooner than other places, which two searches
        in a row have to find then. `path_m` is how far it has driven since it was lost: the
        farther, the more of the surroundings is in the episode, and the smaller a lead has to be to
        be believed.
        """
        if self._visible.is_empty:
            return None
        places = self._climbers(episode, _submap(episode))
        promising = _in_the_running(self._found(places, looks_of(episode, 2)))
        found = self._weigh(episode, [each.pose for each in promising])
        here = None
        if followed is not None:
            looks = looks_of(followed, _SCANS_WEIGHED, newest=len(episode))
            (here,) = self._found([followed.poses[-1]], looks)
        winner = self._clear_winner(found, here, path_m)
        won, self._won = self._won, None if winner is None else winner.pose
        if winner is None:
            return None
        if here is not None:
            if same_place(winner.pose, here.pose):
                return winner
            if won is None or not same_place(winner.pose, won):
                return None
        return self._sharpened(winner, episode)

    def _climbers(self, episode: Episode, points: Floats) -> list[Poses]:
        """The places of the lattice that look right, each where the points fit best."""
        (newest,) = looks_of(episode, 1, _BEAMS_GLANCED)
        candidates = self._search.candidates(points, self._everywhere, _CANDIDATES)
        merits = np.array([glance(self._visible, newest, each) for each in candidates])
        best = np.argsort(-merits, kind="stable")[:_CLIMBERS]
        looks = looks_of(episode, 1)
        return [
            polish(
                self._visible,
                looks,
                self._search.climb(points, candidates[index]),
                self._parameters,
                _FIRST_GATES_M,
            )
            for index in best
        ]

    def _weigh(self, episode: Episode, places: list[Poses]) -> list[Found]:
        """Places new and still open, with what speaks for each; the best of them stay open."""
        few, looks = looks_of(episode, _SCANS_POLISHED), looks_of(episode, _SCANS_WEIGHED)
        polished = [
            polish(self._visible, few, place, self._parameters) for place in [*self._open, *places]
        ]
        found = self._found(self._possible(polished), looks)
        self._open = np.array([each.pose for each in _in_the_running(found)]).reshape(-1, 3)
        return found

    def _sharpened(self, found: Found, episode: Episode) -> Found:
        """The best place around one: along a corridor points slide only so far by themselves."""
        few, looks = looks_of(episode, _SCANS_POLISHED), looks_of(episode, _SCANS_WEIGHED)
        around = [
            polish(
                self._visible,
                few,
                compose(found.pose, np.array([ahead_m, left_m, 0.0])),
                self._parameters,
                _LAST_GATES_M,
            )
            for ahead_m, left_m in product(_AROUND_M, _AROUND_M)
        ]
        possible = self._possible(around)
        return max([found, *self._found(possible, looks)], key=lambda each: each.score)

    def _possible(self, places: list[Poses]) -> list[Poses]:
        may_be_at = self._may_be_at
        if may_be_at is None:
            return places
        return [each for each in places if may_be_at(float(each[0]), float(each[1]))]

    def _found(self, places: list[Poses], looks: list[ScanLook]) -> list[Found]:
        anywhere = float(
            np.mean([self._anywhere.log_likelihood(each.ranges_m, each.bearings) for each in looks])
        )
        return [
            Found(
                place, log_likelihood(self._visible, looks, place, self._anywhere.model) - anywhere
            )
            for place in places
        ]

    def _clear_winner(
        self, found: list[Found], followed: Found | None, path_m: float
    ) -> Found | None:
        if followed is not None:
            found = [followed, *found]
        if not found:
            return None
        best = max(found, key=lambda each: each.score)
        rivals = [each.score for each in found if not same_place(each.pose, best.pose)]
        lead = best.score - max(rivals, default=0.0)
        doubt = max(_LEAST_DOUBT, 1.0 - path_m / self._parameters.recovery_patience_m)
        if followed is not None and same_place(best.pose, followed.pose):
            doubt = _LEAST_DOUBT
        clear = lead >= doubt * self._parameters.recovery_lead
        return best if clear and best.score > self._parameters.found_above else None


def _ranked(found: list[Found]) -> list[Found]:
    """The best first, and of those at the same place only the best."""
    ranked = sorted(found, key=lambda each: -each.score)
    return [ranked[index] for index in distinct(np.array([each.pose for each in ranked]))]


def _in_the_running(found: list[Found]) -> list[Found]:
    """The distinct places that are not much worse than the best, best first."""
    ranked = _ranked(found)
    if not ranked:
        return ranked
    near = sum(each.score > ranked[0].score - _IN_THE_RUNNING for each in ranked)
    return ranked[: max(_LEAST_FINALISTS, min(near, _MOST_FINALISTS))]


def _submap(episode: Episode) -> Floats:
    """All points of an episode in the frame of its newest pose, one per small cell."""
    newest = episode.poses[-1]
    points = np.concatenate(
        [
            transform(relative(newest, pose), node.scan_points.points)
            for node, pose in zip(episode.nodes, episode.poses, strict=True)
        ]
    )
    cells = np.floor(points / _THINNED_M).astype(np.int64)
    _, first = np.unique(cells, axis=0, return_index=True)
    return np.ascontiguousarray(points[np.sort(first)])
