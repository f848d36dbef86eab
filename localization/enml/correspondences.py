"""Short-term features: points off the map that two poses of an episode both saw."""

from dataclasses import dataclass
from functools import lru_cache
from math import cos
from typing import Self

import numpy as np
from numpy.typing import NDArray

from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.pose_node import PoseNode
from mend.localization.enml.problem import Floats, Indices, StfConstraints
from mend.localization.enml.settling import has_moved
from mend.localization.points import ScanPoints
from mend.localization.pose import Poses, relative

_MOST_PER_PAIR = 50
"""More points on the same things say little more about how two poses stand to each other."""
_NOWHERE = np.full(3, 1e9)


@dataclass(frozen=True, slots=True, eq=False)
class StfMatches:
    """Points of an earlier and a later pose that are the same thing, each in its robot's frame.

    `count` is how many there are; of the points and normals only some are kept, evenly spread.
    `later` are the rows of all of them among the later pose's points. `motion` is the later pose in
    the frame of the earlier when they were found.
    """

    motion: Poses
    count: int
    later: Indices
    earlier_points: Floats
    earlier_normals: Floats
    later_points: Floats
    later_normals: Floats

    @classmethod
    def of(
        cls, motion: Poses, a: ScanPoints, earlier: Indices, b: ScanPoints, later: Indices
    ) -> Self:
        """The given rows of two scans' points."""
        every = max(-(-len(later) // _MOST_PER_PAIR), 1)
        some_a, some_b = earlier[::every], later[::every]
        return cls(
            motion,
            len(later),
            later,
            a.points[some_a],
            a.normals[some_a],
            b.points[some_b],
            b.normals[some_b],
        )


class ShortTermFeatures:
    """Finds what the poses of an episode have in common, again only where something changed."""

    def __init__(self, parameters: EnmlParameters) -> None:
        self._parameters = parameters
        self._cos_max_angle = cos(parameters.max_angle_rad)
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
        pairs = _pairs(len(nodes))
        motions = relative(poses[pairs[:, 0]], poses[pairs[:, 1]])
        names = [(nodes[a].identity, nodes[b].identity) for a, b in pairs.tolist()]
        moved = self._moved(names, motions)
        tied: dict[tuple[int, int], StfMatches] = {}
        known: dict[tuple[int, int], StfMatches] = {}
        for index, (earlier, later) in enumerate(pairs.tolist()):
            matches = self._known.get(names[index])
            if matches is None or moved[index] or earlier in changed or later in changed:
                matches = self._nearest(nodes[earlier], nodes[later], motions[index])
            known[names[index]] = matches
            if matches.count > self._parameters.stf_min_matches:
                tied[earlier, later] = matches
        self._known = known
        _mark_newest(nodes, tied)
        return tied

    def _moved(self, names: list[tuple[int, int]], motions: Poses) -> NDArray[np.bool_]:
        """Which pairs stand otherwise to each other than when their matches were found."""
        known = [self._known.get(name) for name in names]
        before = [_NOWHERE if each is None else each.motion for each in known]
        return has_moved(motions - np.array(before).reshape(-1, 3))

    def _nearest(self, earlier: PoseNode, later: PoseNode, motion: Poses) -> StfMatches:
        a, b = earlier.scan_points, later.scan_points
        off_map = np.flatnonzero(~later.is_ltf)
        seen_a, seen_b = earlier.buckets.same_surface(b, off_map, motion, self._cos_max_angle)
        both = ~earlier.is_ltf[seen_a]
        return StfMatches.of(motion, a, seen_a[both], b, seen_b[both])


@lru_cache(maxsize=64)
def _pairs(count: int) -> Indices:
    """Which poses (earlier, later) of so many are compared: 1, 2, 4, 8... apart.

    Published: every fourth; so both what is near and what is far is tied, by fewer.
    """
    found = [
        (later - (1 << doublings), later)
        for later in range(count)
        for doublings in range(later.bit_length())
    ]
    return np.array(found, dtype=np.int64).reshape(-1, 2)


def _mark_newest(nodes: list[PoseNode], tied: dict[tuple[int, int], StfMatches]) -> None:
    newest = nodes[-1]
    newest.is_stf = np.zeros(len(newest.scan_points), dtype=np.bool_)
    for (_, later), matches in tied.items():
        if later == len(nodes) - 1:
            newest.is_stf[matches.later] = True


def stf_constraints(tied: dict[tuple[int, int], StfMatches], width_m: float) -> StfConstraints:
    """The correspondences as one list for the solver."""
    if not tied:
        return StfConstraints.none()
    found = list(tied.values())
    counts = [len(each.later_points) for each in found]
    return StfConstraints(
        np.array(list(tied), dtype=np.int64),
        np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        np.concatenate([each.earlier_points for each in found]),
        np.concatenate([each.earlier_normals for each in found]),
        np.concatenate([each.later_points for each in found]),
        np.concatenate([each.later_normals for each in found]),
        width_m,
    )
