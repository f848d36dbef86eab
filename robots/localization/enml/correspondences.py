"""Short-term features: points off the map that two poses of an episode both saw."""

from dataclasses import dataclass
from math import cos

import numpy as np

from robots.localization.enml.parameters import EnmlParameters
from robots.localization.enml.pose_node import PoseNode
from robots.localization.enml.problem import Floats, Indices, StfConstraints
from robots.localization.pose import Poses, relative, transform, turn, wrap_angle


@dataclass(frozen=True, slots=True, eq=False)
class StfMatches:
    """Rows of the points of an earlier and a later pose that are the same thing.

    `motion` is the later pose in the frame of the earlier when they were found.
    """

    earlier: Indices
    later: Indices
    motion: Poses

    def __len__(self) -> int:
        return len(self.earlier)


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
        each node's short-term features.
        """
        tied: dict[tuple[int, int], StfMatches] = {}
        known: dict[tuple[int, int], StfMatches] = {}
        for later in range(len(nodes)):
            for separation in self._parameters.stf_separations:
                earlier = later - separation
                if earlier < 0:
                    break
                name = nodes[earlier].identity, nodes[later].identity
                motion = relative(poses[earlier], poses[later])
                matches = self._known.get(name)
                stale = earlier in changed or later in changed
                if matches is None or stale or self._moved(matches.motion, motion):
                    matches = self._nearest(nodes[earlier], nodes[later], motion)
                known[name] = matches
                if len(matches) > self._parameters.stf_min_matches:
                    tied[earlier, later] = matches
        self._known = known
        self._mark(nodes, tied)
        return tied

    def _moved(self, before: Poses, motion: Poses) -> bool:
        return bool(
            np.hypot(*(motion - before)[:2]) > self._parameters.settled_m
            or abs(wrap_angle(motion[2] - before[2])) > self._parameters.settled_rad
        )

    def _nearest(self, earlier: PoseNode, later: PoseNode, motion: Poses) -> StfMatches:
        rows = np.flatnonzero(~later.is_ltf & later.has_normal)
        if earlier.tree is None or not len(rows):
            return StfMatches(rows[:0], rows[:0], motion)
        points = transform(motion, later.scan_points.points[rows])
        gaps, nearest = earlier.tree.query(
            points, distance_upper_bound=self._parameters.stf_gate_m
        )
        rows, nearest = rows[np.isfinite(gaps)], nearest[np.isfinite(gaps)]
        normals = turn(float(motion[2]), later.scan_points.normals[rows])
        same_side = np.sum(normals * earlier.scan_points.normals[nearest], axis=1)
        kept = (same_side > self._cos_max_angle) & ~earlier.is_ltf[nearest]
        return StfMatches(nearest[kept], rows[kept], motion)

    def _mark(self, nodes: list[PoseNode], tied: dict[tuple[int, int], StfMatches]) -> None:
        for node in nodes:
            node.is_stf = np.zeros(len(node.scan_points), dtype=np.bool_)
        for (earlier, later), matches in tied.items():
            nodes[earlier].is_stf[matches.earlier] = True
            nodes[later].is_stf[matches.later] = True


def stf_constraints(
    nodes: list[PoseNode], tied: dict[tuple[int, int], StfMatches], width_m: float
) -> StfConstraints:
    """The correspondences as one list for the solver."""
    if not tied:
        return StfConstraints.none()
    counts = [len(matches) for matches in tied.values()]
    earlier = [
        (nodes[a].scan_points, matches.earlier) for (a, _), matches in tied.items()
    ]
    later = [(nodes[b].scan_points, matches.later) for (_, b), matches in tied.items()]
    return StfConstraints(
        np.array(list(tied), dtype=np.int64),
        np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        np.concatenate([points.points[rows] for points, rows in earlier]),
        np.concatenate([points.normals[rows] for points, rows in earlier]),
        np.concatenate([points.points[rows] for points, rows in later]),
        np.concatenate([points.normals[rows] for points, rows in later]),
        width_m,
    )
