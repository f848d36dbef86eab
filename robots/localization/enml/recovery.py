"""Finding a lost robot again: what it saw since, laid over the map near by, then everywhere."""

from dataclasses import dataclass

import numpy as np

from robots.localization.enml.classification import cast_bearings
from robots.localization.enml.episode import Episode
from robots.localization.enml.global_search import Region, best_places, same_place
from robots.localization.enml.lost import Evidence, evidence
from robots.localization.enml.parameters import EnmlParameters
from robots.localization.enml.problem import Floats
from robots.localization.mcl.likelihood_field import DistanceField
from robots.localization.pose import Poses, compose, relative, transform

_THINNED_M = 0.25
_CANDIDATES = 80
_SCANS_WEIGHED = 5
_LEAST_EXPLAINED = 0.25
"""Where the map explains fewer of the returns, no robot is found."""
_ON_WALL_M = 0.15
_BEHIND_COUNTS = 2.0
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
        self._max_range_m = max_range_m
        self._parameters = parameters

    def search(self, episode: Episode, expected: Poses, path_m: float) -> Found | None:
        """Where the newest pose is, looking near `expected` and then anywhere; None if unclear.

        `path_m` is how far the robot has driven since it was lost: the farther, the more of the
        surroundings is in the episode, and the smaller a lead has to be to be believed.
        """
        if not len(self._segments):
            return None
        near = Region.around(expected, self._parameters.recovery_near_m)
        points = _submap(episode)
        places = [
            place
            for region in (near, self._everywhere)
            for place in best_places(self._field, points, region, _CANDIDATES)
        ]
        ranked = sorted(
            ((place, self._weigh(episode, place)) for place in places),
            key=lambda each: -_score(each[1]),
        )
        return self._clear_winner(ranked, path_m)

    def _clear_winner(self, ranked: list[tuple[Poses, Evidence]], path_m: float) -> Found | None:
        parameters = self._parameters
        if not ranked or ranked[0][1].lost > parameters.found_below:
            return None
        best, seen = ranked[0]
        if seen.on_map < _LEAST_EXPLAINED * seen.returns:
            return None
        rivals = [_score(other) for place, other in ranked[1:] if not same_place(place, best)]
        lead = _score(seen) - max(rivals, default=-2.0)
        enough = parameters.recovery_lead * max(0.0, 1.0 - path_m / parameters.recovery_patience_m)
        return Found(best, seen) if lead >= enough else None

    def _weigh(self, episode: Episode, place: Poses) -> Evidence:
        """What the scans of the episode, spread over it, say about the newest being at a place."""
        total = Evidence()
        newest = episode.poses[-1]
        chosen = np.unique(np.linspace(0, len(episode) - 1, _SCANS_WEIGHED).astype(int))
        for index in chosen:
            node = episode.nodes[index]
            pose = compose(place, relative(newest, episode.poses[index]))
            sensor = compose(pose, node.sensor_offset)
            expected_m, _ = cast_bearings(self._segments, sensor, node.bearings, self._max_range_m)
            seen = transform(pose, node.scan_points.points)
            on_wall = self._field.at(seen) < _ON_WALL_M
            in_view = np.abs(node.ranges_m - expected_m) < 2.0
            total = total.faded(1.0, evidence(node.ranges_m, expected_m, on_wall & in_view))
        return total


def _score(seen: Evidence) -> float:
    """From -2 to 1: explained returns, less those that could not be."""
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
