"""Short-term features: points off the map that two poses of an episode both saw."""

from dataclasses import dataclass
from math import cos

import numpy as np
from numpy.typing import NDArray

from robots.localization.enml.parameters import EnmlParameters
from robots.localization.enml.pose_node import PoseNode
from robots.localization.enml.problem import Floats, Indices, StfConstraints
from robots.localization.pose import Poses, relative, transform, turn, wrap

_MOST_PER_PAIR = 50
"""More points on the same things say little more about how two poses stand to each other."""


@dataclass(frozen=True, slots=True, eq=False)
class StfMatches:
    """Rows of the points of an earlier and a later pose that are the same thing.

    `motion` is the later pose in the frame of the earlier when they were found.
    """

    earlier: Indices
    later: Indices
    motion: Poses

    @classmethod
    def none(cls) -> "StfMatches":
        """Nothing is the same."""
        nothing = np.zeros(0, dtype=np.int64)
        return cls(nothing, nothing, np.zeros(3))

    def __len__(self) -> int:
        return len(self.earlier)

    def thinned(self, most: int) -> "StfMatches":
        """At most so many of them, evenly spread."""
        every = -(-len(self) // most)
        return StfMatches(self.earlier[::every], self.later[::every], self.motion)


class ShortTermFeatures:
    """Finds what the poses of an episode have in common, again only where something changed."""

    def __init__(self, parameters: EnmlParameters) -> None:
        self._parameters = parameters
        self._cos_max_angle = cos(parameters.stf_max_angle_rad)
        self._known: dict[tuple[int, int], StfMatches] = {}

    def forget(self) -> None:
        """Let go of all that was found."""
        self._known.clear()

    def match(
        self, nodes: list[PoseNode], poses: Floats, changed: set[int]
    ) -> dict[tuple[int, int], StfMatches]:
        """The correspondences of every tied pair (earlier, later) of the episode.

        `changed` names (by index) the poses whose long-term features are not what they were. Marks
        the newest pose's short-term features.
        """
        pairs = self._pairs(len(nodes))
        motions = relative(poses[pairs[:, 0]], poses[pairs[:, 1]])
        names = [(nodes[a].identity, nodes[b].identity) for a, b in pairs]
        moved = self._moved(names, motions)
        tied: dict[tuple[int, int], StfMatches] = {}
        known: dict[tuple[int, int], StfMatches] = {}
        for index, (earlier, later) in enumerate(pairs):
            matches = self._known.get(names[index])
            if matches is None or moved[index] or earlier in changed or later in changed:
                matches = self._nearest(nodes[earlier], nodes[later], motions[index])
            known[names[index]] = matches
            if len(matches) > self._parameters.stf_min_matches:
                tied[int(earlier), int(later)] = matches
        self._known = known
        _mark_newest(nodes, tied)
        return tied

    def _pairs(self, count: int) -> Indices:
        """Which poses (earlier, later) of so many are compared."""
        found = [
            (later - separation, later)
            for later in range(count)
            for separation in self._parameters.stf_separations
            if separation <= later
        ]
        return np.array(found, dtype=np.int64).reshape(-1, 2)

    def _moved(self, names: list[tuple[int, int]], motions: Poses) -> NDArray[np.bool_]:
        """Which pairs stand otherwise to each other than when their matches were found."""
        unknown = StfMatches.none()
        before = np.array([self._known.get(name, unknown).motion for name in names])
        change = motions - before.reshape(-1, 3)
        return np.asarray(
            (np.hypot(change[:, 0], change[:, 1]) > self._parameters.settled_m)
            | (np.abs(wrap(change[:, 2])) > self._parameters.settled_rad)
        )

    def _nearest(self, earlier: PoseNode, later: PoseNode, motion: Poses) -> StfMatches:
        rows = np.flatnonzero(~later.is_ltf & later.has_normal)
        if earlier.tree is None or not len(rows):
            return StfMatches(rows[:0], rows[:0], motion)
        points = transform(motion, later.scan_points.points[rows])
        gaps, nearest = earlier.tree.query(points, distance_upper_bound=self._parameters.stf_gate_m)
        rows, nearest = rows[np.isfinite(gaps)], nearest[np.isfinite(gaps)]
        normals = turn(float(motion[2]), later.scan_points.normals[rows])
        same_side = np.sum(normals * earlier.scan_points.normals[nearest], axis=1)
        kept = (same_side > self._cos_max_angle) & ~earlier.is_ltf[nearest]
        return StfMatches(nearest[kept], rows[kept], motion)


def _mark_newest(nodes: list[PoseNode], tied: dict[tuple[int, int], StfMatches]) -> None:
    newest = nodes[-1]
    newest.is_stf = np.zeros(len(newest.scan_points), dtype=np.bool_)
    for (_, later), matches in tied.items():
        if later == len(nodes) - 1:
            newest.is_stf[matches.later] = True


def stf_constraints(
    nodes: list[PoseNode], tied: dict[tuple[int, int], StfMatches], width_m: float
) -> StfConstraints:
    """The correspondences as one list for the solver."""
    if not tied:
        return StfConstraints.none()
    matched = [matches.thinned(_MOST_PER_PAIR) for matches in tied.values()]
    earlier = [(nodes[a].scan_points, each) for (a, _), each in zip(tied, matched, strict=True)]
    later = [(nodes[b].scan_points, each) for (_, b), each in zip(tied, matched, strict=True)]
    counts = [len(each) for each in matched]
    return StfConstraints(
        np.array(list(tied), dtype=np.int64),
        np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        np.concatenate([points.points[each.earlier] for points, each in earlier]),
        np.concatenate([points.normals[each.earlier] for points, each in earlier]),
        np.concatenate([points.points[each.later] for points, each in later]),
        np.concatenate([points.normals[each.later] for points, each in later]),
        width_m,
    )
