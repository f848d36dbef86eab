"""Finding a lost robot again: what it saw since, laid over the map near by, then everywhere."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np

from mend.localization.distance_field import DistanceField
from mend.localization.enml.episode import Episode
from mend.localization.enml.global_search import GlobalSearch, Region, distinct, same_place
from mend.localization.enml.looks import ScanLook, Weight, glance, look_of, looks_of, weigh
from mend.localization.enml.lost import MapFit
from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.polishing import polish
from mend.localization.enml.pose_node import PoseNode
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
_IN_THE_RUNNING = 0.15
"""... and the best of those polished and weighed by more: many where many look much the same."""
_SCANS_POLISHED = 3
_SCANS_WEIGHED = 6
_LEAST_EXPLAINED = 0.15
"""Where the map explains fewer of the returns, no robot is found."""
_LEAST_ON_MAP = 40.0
"""No robot is found by fewer returns than these."""
_LEAST_DOUBT = 0.25
"""However far it has driven, a robot does not choose between places that are all the same to it."""
_LEAST_SCORE_ELSEWHERE = 0.35
"""A robot that was not carried goes to no other place that fits less well."""
_BEHIND_COUNTS = 8.0
"""Right places have hardly any return from behind a wall, those that look alike a few percent."""


MayBeAt = Callable[[float, float], bool]
"""Whether the robot may be at a point of the map at all, x and y in metres."""


@dataclass(frozen=True, slots=True)
class Found:
    """A place for the newest pose, and what speaks for it."""

    pose: Poses
    weight: Weight

    @property
    def evidence(self) -> MapFit:
        """What the map says about what is seen from there."""
        return self.weight.evidence

    @property
    def score(self) -> float:
        """At most 1: how well the map explains the returns, less those that could not be."""
        returns = self.evidence.returns
        against = _BEHIND_COUNTS * self.evidence.behind
        return (self.weight.sharp - against) / returns if returns else 0.0


class Recovery:
    """Searches a map for where the newest pose of an episode may be.

    Places that one search leaves open are weighed again by the next, with what was seen since.
    """

    def __init__(
        self,
        segments: Floats,
        region: Region,
        field: DistanceField,
        max_range_m: float,
        parameters: EnmlParameters,
        may_be_at: MayBeAt | None = None,
    ) -> None:
        self._segments = segments
        self._may_be_at = may_be_at
        self._everywhere = region
        self._search = GlobalSearch(field)
        self._field = field
        self._visible = Visible(segments, max_range_m)
        self._parameters = parameters
        self.forget()

    def forget(self, last: Poses | None = None) -> None:
        """Begin anew: the robot may be elsewhere than all places so far.

        Where it was `last` is believed sooner than other places, as much may just have changed.
        """
        self._last = last
        self._open: Floats = np.zeros((0, 3)) if last is None else last[None].copy()

    def move(self, motion: Poses) -> None:
        """Let the open places come along with the robot."""
        if len(self._open):
            self._open = compose(self._open, motion)
        if self._last is not None:
            self._last = compose(self._last, motion)

    def open_places(self, episode: Episode) -> list[Found]:
        """The places that explain what is seen and are hardly worse than the best, best first."""
        looks = looks_of(episode, _SCANS_WEIGHED)
        ranked = _ranked(self._found(list(self._open), looks)) if len(self._open) else []
        return [
            each
            for each in ranked
            if self._explains(each) and each.score > ranked[0].score - _IN_THE_RUNNING
        ]

    def weighed(self, episode: Episode, place: Poses) -> Found:
        """A place, with what speaks for it."""
        return self._found([place], looks_of(episode, _SCANS_WEIGHED))[0]

    def behind(self, node: PoseNode, pose: Poses) -> float:
        """The share of a scan's returns from behind walls of the map, seen from a pose."""
        seen = weigh(self._visible, self._field, [look_of(node, np.zeros(3))], pose).evidence
        return seen.behind / seen.returns if seen.returns else 0.0

    def search(self, episode: Episode, expected: Poses | None, path_m: float) -> Found | None:
        """Where the newest pose is, near where it is `expected` or else anywhere; None if unclear.

        `path_m` is how far the robot has driven since it was lost: the farther, the more of the
        surroundings is in the episode, and the smaller a lead has to be to be believed.
        """
        if not len(self._segments):
            return None
        regions = [self._everywhere]
        if expected is not None:
            regions.insert(0, Region.around(expected, self._parameters.recovery_near_m))
        points = _submap(episode)
        places = [place for region in regions for place in self._climbers(episode, points, region)]
        promising = _in_the_running(self._found(places, looks_of(episode, 2)))
        found = self._weigh(episode, [each.pose for each in promising], expected)
        winner = self._clear_winner(found, expected, path_m)
        if winner is None or expected is not None:
            return winner
        return self._sharpened(winner, episode)

    def reconsider(self, episode: Episode, expected: Poses) -> Found | None:
        """An open place that is clearly better than the one found; None if none is."""
        if not len(self._open):
            return None
        found = self._weigh(episode, [], expected)
        best = max(found, key=lambda each: each.score)
        here = next(each for each in found if each.pose is expected)
        better = best.score - here.score > _LEAST_DOUBT * self._parameters.recovery_lead
        return best if better and self._explains(best) else None

    def _climbers(self, episode: Episode, points: Floats, region: Region) -> list[Poses]:
        """The places of a region's lattice that look right, each where the points fit best."""
        (newest,) = looks_of(episode, 1, _BEAMS_GLANCED)
        candidates = self._search.candidates(points, region, _CANDIDATES)
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

    def _weigh(self, episode: Episode, places: list[Poses], expected: Poses | None) -> list[Found]:
        """Places new and still open, with what speaks for each; the best of them stay open."""
        few, looks = looks_of(episode, _SCANS_POLISHED), looks_of(episode, _SCANS_WEIGHED)
        polished = [
            polish(self._visible, few, place, self._parameters) for place in [*self._open, *places]
        ]
        claims = [] if expected is None else [expected]
        found = self._found([*claims, *self._possible(polished)], looks)
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
        return [Found(place, weigh(self._visible, self._field, looks, place)) for place in places]

    def _clear_winner(
        self, found: list[Found], expected: Poses | None, path_m: float
    ) -> Found | None:
        parameters = self._parameters

        def worth(each: Found) -> float:
            moves = expected is not None and not same_place(each.pose, expected)
            return each.score - parameters.recovery_move_costs * moves

        here = next((each for each in found if each.pose is expected), None)
        if here is not None:
            # Walls may be gone, but no place is left for one that explains less.
            found = [each for each in found if each.evidence.on_map >= here.evidence.on_map]
        if not found:
            return None
        best = max(found, key=worth)
        rivals = [worth(each) for each in found if not same_place(each.pose, best.pose)]
        lead = worth(best) - max(rivals, default=-_BEHIND_COUNTS)
        doubt = max(_LEAST_DOUBT, 1.0 - path_m / parameters.recovery_patience_m)
        if self._last is not None and same_place(best.pose, self._last):
            doubt = _LEAST_DOUBT
        clear = lead >= doubt * parameters.recovery_lead
        if expected is not None and not same_place(best.pose, expected):
            clear = clear and best.score >= _LEAST_SCORE_ELSEWHERE
        return best if clear and self._explains(best) else None

    def _explains(self, found: Found) -> bool:
        """Whether a place explains enough of what is seen to be believed at all."""
        seen = found.evidence
        enough = seen.on_map >= max(_LEAST_EXPLAINED * seen.returns, _LEAST_ON_MAP)
        return enough and seen.lost <= self._parameters.found_below


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
