"""What changed between two scans: what stood there is gone, or something stands where was none.

And what did not: what is seen again where it was.
"""

from dataclasses import dataclass
from math import cos

import numpy as np
from numpy.typing import NDArray

from mend.localization.enml.episode import Episode
from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.pose_node import PoseNode
from mend.localization.enml.problem import Floats
from mend.localization.enml.usual_change import UsualChange, log_density_of_carried
from mend.localization.pose import Poses, compose, relative, transform, wrap

_THROUGH_M = 0.3
_BEAMS_ASIDE = 2
"""A point is seen through only if its neighbouring beams go past it too: edges move a little."""
_GAP_IN_BEAMS = 2.5
_LEAST_COMPARED = 20
LEAST_RETURNS = 40
"""Fewer returns say nothing about where a robot is."""
_COMPARED_WITHIN_M = 1.2


@dataclass(frozen=True, slots=True)
class Comparison:
    """What a scan shows beside an earlier one."""

    strange: float
    """What speaks for having been carried since then, as log odds; 0 if nothing can be said."""
    is_with_familiar: bool = True
    """Whether the earlier one was familiar itself, or none is; who was carried before a strange
    one sees the same again as there, too."""
    is_sudden: bool = False
    """Whether it is the first strange one after one that was familiar."""


_NOTHING = Comparison(0.0)


class Strangeness:
    """Compares the newest scan with the last that was familiar; a strange one is not yet."""

    def __init__(self, parameters: EnmlParameters) -> None:
        self._parameters = parameters
        self._usual = UsualChange(parameters)
        self._familiar: int | None = None

    def begin_anew(self) -> None:
        """The scans so far are of another episode; what is usual stays so."""
        self._familiar = None

    def compare(self, episode: Episode, within_m: float, news: float = 0.0) -> Comparison:
        """The newest scan beside the last familiar one.

        Nothing can be said where they are farther apart than `within_m` (and radians, together).
        Only what is on no map is to be recognized, as walls look the same in many places; for who
        was carried what changed less what is recognized is as likely anything from 0 on. The scan
        is learned from as far as it is `news` (0 to 1).
        """
        before = self._compared_with(episode)
        if before is None:
            return _NOTHING
        apart = _apart(episode, before)
        if apart > within_m:
            return _NOTHING
        identity = episode.nodes[before].identity
        change = self._change(episode, before)
        strange = log_density_of_carried(change) - self._usual.log_density(change)
        self._usual.learn(change, news)
        compared = Comparison(
            strange, self._familiar in (None, identity), strange > 0.0 and self._familiar is None
        )
        self._familiar = identity if strange > 0.0 else None
        return compared

    def _change(self, episode: Episode, before: int) -> float:
        """What changed from a pose to the newest, less what is recognized (-1 to 2)."""
        earlier, later = episode.nodes[before], episode.nodes[-1]
        there, here = episode.poses[before], episode.poses[-1]
        recognized = recognized_points(earlier, later, relative(there, here), self._parameters)
        of_those = recognized[~later.is_ltf]
        # Laplace's rule of succession: of a few points the share is hardly known.
        share = (1.0 + float(of_those.sum())) / (2.0 + len(of_those))
        return changed(earlier, there, later, here) - share

    def _compared_with(self, episode: Episode) -> int | None:
        """The last familiar pose, unless it is too far back, or else the last that saw enough."""
        *nodes, newest = episode.nodes
        if len(newest.scan_points) < LEAST_RETURNS:
            return None
        enough = [
            index for index, node in enumerate(nodes) if len(node.scan_points) >= LEAST_RETURNS
        ]
        familiar = next((i for i in enough if nodes[i].identity == self._familiar), None)
        if familiar is not None and _apart(episode, familiar) < _COMPARED_WITHIN_M:
            return familiar
        return enough[-1] if enough else None


def _apart(episode: Episode, before: int) -> float:
    """Metres moved and radians turned on the way from a pose to the newest, together."""
    steps = relative(episode.poses[before:-1], episode.poses[before + 1 :])
    return float((np.hypot(steps[:, 0], steps[:, 1]) + np.abs(wrap(steps[:, 2]))).sum())


def changed(earlier: PoseNode, earlier_pose: Poses, later: PoseNode, pose: Poses) -> float:
    """What vanished and what appeared between two scans, in shares of what both looked at (0 to 2).

    In a world that stands still neither happens, however far the robot moves: no beam goes
    through what another scan saw.
    """
    return seen_through(later, pose, earlier, earlier_pose) + seen_through(
        earlier, earlier_pose, later, pose
    )


def seen_through(seer: PoseNode, seer_pose: Poses, seen: PoseNode, seen_pose: Poses) -> float:
    """The share of what one scan saw, within another's view, that the other's beams go through."""
    if len(seer.bearings) < 2 * _BEAMS_ASIDE or not len(seen.scan_points):
        return 0.0
    sensor = compose(seer_pose, seer.sensor_offset)
    points = transform(relative(sensor, seen_pose), seen.scan_points.points)
    free_m, looked = _free_at(seer, np.arctan2(points[:, 1], points[:, 0]))
    if looked.sum() < _LEAST_COMPARED:
        return 0.0
    through = free_m[looked] > np.hypot(*points[looked].T) + _THROUGH_M
    return float(np.mean(through))


def _free_at(node: PoseNode, bearings: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """How far the beams around some bearings went, and whether any looked there."""
    count = len(node.bearings)
    around = node.bearings[0] + np.mod(bearings - node.bearings[0], 2.0 * np.pi)
    after = np.searchsorted(node.bearings, around)
    inside = np.clip(after, 1, count - 1)
    gaps = node.bearings[inside] - node.bearings[inside - 1]
    looked = (after > 0) & (after < count) & (gaps < _GAP_IN_BEAMS * node.beam_spacing_rad)
    aside = after[:, None] + np.arange(-_BEAMS_ASIDE, _BEAMS_ASIDE)
    return node.ranges_m[np.clip(aside, 0, count - 1)].min(axis=1), looked


def recognized_points(
    earlier: PoseNode, later: PoseNode, motion: Poses, parameters: EnmlParameters
) -> NDArray[np.bool_]:
    """Which points of a scan lie where an earlier one saw some, on a surface that faces alike.

    `motion` leads from the earlier pose to the later.
    """
    every = np.arange(len(later.scan_points))
    _, again = earlier.buckets.same_surface(
        later.scan_points, every, motion, cos(parameters.max_angle_rad)
    )
    seen = np.zeros(len(later.scan_points), dtype=np.bool_)
    seen[again] = True
    return seen
