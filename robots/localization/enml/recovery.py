"""Finding a lost robot again: what it saw since, laid over the map near by, then everywhere."""

from dataclasses import dataclass

import numpy as np

from robots.localization.distance_field import DistanceField
from robots.localization.enml.classification import cast_bearings
from robots.localization.enml.episode import Episode
from robots.localization.enml.global_search import GlobalSearch, Region, same_place
from robots.localization.enml.lost import Evidence, evidence
from robots.localization.enml.parameters import EnmlParameters
from robots.localization.enml.problem import Floats
from robots.localization.pose import Poses, compose, relative, transform

_THINNED_M = 0.25
_CANDIDATES = 160
_GLANCES = 2
"""All candidates are weighed by so many scans..."""
_FINALISTS = 40
"""... and the best of them by more."""
_SCANS_WEIGHED = 5
_LEAST_EXPLAINED = 0.15
"""Where the map explains fewer of the returns, no robot is found."""
_LEAST_ON_MAP = 40.0
"""No robot is found by fewer returns than these."""
_ON_WALL_M = 0.15
_BEHIND_COUNTS = 8.0
"""Right places have hardly any return from behind a wall, those that look alike a few percent."""
_BEFORE_COUNTS = 0.15


@dataclass(frozen=True, slots=True)
class Found:
    """A place for the newest pose, and what speaks for it."""

    pose: Poses
    evidence: Evidence


class Recovery:
    """Searches a map for where the newest pose of an episode may be."""

    def __init__(
        self,
        segments: Floats,
        region: Region,
        field: DistanceField,
        max_range_m: float,
        parameters: EnmlParameters,
    ) -> None:
        self._segments = segments
        self._everywhere = region
        self._field = field
        self._search = GlobalSearch(field)
        self._max_range_m = max_range_m
        self._parameters = parameters

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
        places = [
            place
            for region in regions
            for place in self._search.best_places(points, region, _CANDIDATES)
        ]
        glanced = sorted(places, key=lambda place: -_score(self._weigh(episode, place, _GLANCES)))
        finalists = glanced[:_FINALISTS] if expected is None else [expected, *glanced[:_FINALISTS]]
        found = [Found(each, self._weigh(episode, each, _SCANS_WEIGHED)) for each in finalists]
        return self._clear_winner(found, expected, path_m)

    def _clear_winner(
        self, found: list[Found], expected: Poses | None, path_m: float
    ) -> Found | None:
        parameters = self._parameters

        def worth(each: Found) -> float:
            moves = expected is not None and not same_place(each.pose, expected)
            return _score(each.evidence) - parameters.recovery_move_costs * moves

        here = next((each for each in found if each.pose is expected), None)
        if here is not None:
            # Walls may be gone, but no place is left for one that explains less.
            found = [each for each in found if each.evidence.on_map >= here.evidence.on_map]
        if not found:
            return None
        best = max(found, key=worth)
        seen = best.evidence
        explained = seen.on_map >= max(_LEAST_EXPLAINED * seen.returns, _LEAST_ON_MAP)
        if seen.lost > parameters.found_below or not explained:
            return None
        rivals = [worth(each) for each in found if not same_place(each.pose, best.pose)]
        lead = worth(best) - max(rivals, default=-_BEHIND_COUNTS)
        enough = parameters.recovery_lead * max(0.0, 1.0 - path_m / parameters.recovery_patience_m)
        return best if lead >= enough else None

    def _weigh(self, episode: Episode, place: Poses, scans: int) -> Evidence:
        """What so many scans, spread over the episode, say about the newest being at a place."""
        total = Evidence()
        newest = episode.poses[-1]
        chosen = np.unique(np.linspace(len(episode) - 1, 0, scans).astype(int))
        for index in chosen:
            node = episode.nodes[index]
            pose = compose(place, relative(newest, episode.poses[index]))
            sensor = compose(pose, node.sensor_offset)
            reach_m = min(self._max_range_m, node.reach_m)
            expected_m, _ = cast_bearings(self._segments, sensor, node.bearings, reach_m)
            seen = transform(pose, node.scan_points.points)
            on_wall = self._field.at(seen) < _ON_WALL_M
            in_view = np.abs(node.ranges_m - expected_m) < 2.0
            total = total.faded(1.0, evidence(node.ranges_m, expected_m, on_wall & in_view))
        return total


def _score(seen: Evidence) -> float:
    """At most 1: explained returns, less those that could not be."""
    if not seen.returns:
        return 0.0
    against = _BEHIND_COUNTS * seen.behind + _BEFORE_COUNTS * seen.before
    return (seen.on_map - against) / seen.returns


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
