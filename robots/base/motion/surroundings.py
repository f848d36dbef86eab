"""What the laser shows around a base, and has shown: where it stands, and how fast it comes."""

import math
from collections import deque
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from mend.robots.base.body import BasePose, RangeScan
from mend.robots.base.motion.beams import measure_beside

Points = NDArray[np.float64]
"""(n, 2), metres."""
NOTHING = np.zeros((0, 2))

_NEAR_M = 6.0
"""What is farther away is not remembered."""
_REMEMBERED_S = 15.0
"""What something else hides is believed to be there for so long."""
_CELL_M = 0.02
"""Of what is remembered one point a cell is enough."""
_BEHIND_M = 0.1
"""So much nearer than what is seen, or farther: an edge seen by another beam may differ by less."""
_HIDDEN_M = 0.03
"""What lies so far behind what is seen there is hidden: more than a laser's noise."""
_KNOWN_BEHIND_M = 0.3
"""So far behind what is seen there is what a map has: more than a pose on it is off."""
_MOVED_S = 0.3
"""What came to where nothing was so long ago moves."""
_FASTEST_M_S = 1.5
"""Nothing is believed to come faster: people walk, and robots drive, as fast."""
_POSES = 64
_FILLED_M, _WIDEST_GAP_M = 0.15, 6.0
"""Hits of one wall that are farther apart than the first have points between them."""
_OFF_LINE_M = 0.1
"""Hits of one wall are no farther from its line."""


@dataclass(frozen=True, slots=True, eq=False)
class Seen:
    """What stands around a base: `points` (n, 2), and how fast each may come, `speeds_m_s` (n,)."""

    points: Points
    speeds_m_s: NDArray[np.float64]

    @classmethod
    def still(cls, points: Points) -> Self:
        """What does not move."""
        return cls(points, np.zeros(len(points)))

    def with_still(self, points: Points) -> "Seen":
        """What does not move, besides."""
        return Seen(
            np.concatenate([self.points, points]),
            np.concatenate([self.speeds_m_s, np.zeros(len(points))]),
        )

    def in_frame_of(self, pose: BasePose) -> "Seen":
        """As a base has it that is at a pose."""
        return Seen(in_frame_of(self.points, pose), self.speeds_m_s)

    def seen_from(self, pose: BasePose) -> "Seen":
        """What a base sees that is at a pose, in the frame that the pose is in."""
        return Seen(out_of_frame_of(self.points, pose), self.speeds_m_s)


@dataclass(frozen=True, slots=True, eq=False)
class _Placed:
    """A scan, where it was made, and what it shows in the frame of that pose."""

    scan: RangeScan
    at: BasePose
    points: Points

    def range_m(self, points: Points) -> tuple[Points, Points]:
        """How far points are from here, and how far the beams next to them see.

        nan where none is, and of what is not near.
        """
        away_m, sees_m = np.empty(len(points)), np.empty(len(points))
        at = np.array([self.at.x, self.at.y, self.at.yaw])
        angles, ranges_m = self.scan.angles_rad, self.scan.ranges_m
        measure_beside(points, at, angles, ranges_m, _NEAR_M, away_m, sees_m)
        return away_m, sees_m


class Surroundings:
    """Takes scan after scan; what stands still is where it was, however far the base drove.

    What is hidden by something else, or beside the laser's field of view, is remembered a while.
    """

    def __init__(self) -> None:
        self._poses: deque[tuple[float, BasePose]] = deque(maxlen=_POSES)
        self._placed: deque[_Placed] = deque()
        self._hidden, self._hidden_since_s = np.zeros((0, 2)), np.zeros(0)
        self._still = np.zeros(0, np.bool_)
        self.seen = Seen.still(self._hidden)
        """In the frame of the poses."""

    def take(self, scan: RangeScan, here: BasePose, time_s: float) -> Seen:
        """Called in every control cycle, with the newest scan and where the base is now."""
        self._poses.append((time_s, here))
        if not self._placed or scan is not self._placed[-1].scan:
            at = self._pose_at(scan.time)
            placed = _Placed(scan, at, points_of(scan, at))
            speeds_m_s = self._speeds_m_s(placed)
            self._remember(placed)
            self._still = speeds_m_s == 0.0
            self._placed.append(placed)
            self.seen = Seen(placed.points, speeds_m_s).with_still(self._hidden)
        return self.seen

    def _pose_at(self, time_s: float) -> BasePose:
        """Where the base was when its time was nearest to this one, which is not long ago."""
        poses = reversed(self._poses)
        nearest_s, at = next(poses)
        for then_s, before in poses:
            if abs(then_s - time_s) > abs(nearest_s - time_s):
                break
            nearest_s, at = then_s, before
        return at

    def _speeds_m_s(self, now: _Placed) -> NDArray[np.float64]:
        """How fast what a scan shows may come: it is where a while ago nothing was."""
        while len(self._placed) > 1 and self._placed[1].scan.time <= now.scan.time - _MOVED_S:
            self._placed.popleft()
        speeds_m_s = np.zeros(len(now.points))
        if not self._placed or self._placed[0].scan.time > now.scan.time - _MOVED_S + 1e-9:
            return speeds_m_s
        before = self._placed[0]
        away_m, saw_m = before.range_m(now.points)
        came = np.flatnonzero((away_m < _NEAR_M) & (saw_m > away_m + _BEHIND_M))
        if len(came) and len(before.points):
            x, y = (
                np.subtract.outer(now.points[came, each], before.points[:, each]) for each in (0, 1)
            )
            step_m = np.sqrt((x * x + y * y).min(axis=1))
            speeds_m_s[came] = step_m / (now.scan.time - before.scan.time)
        else:
            speeds_m_s[came] = _FASTEST_M_S
        return np.minimum(speeds_m_s, _FASTEST_M_S)

    def _remember(self, now: _Placed) -> None:
        """What the scan before showed, and was hidden then, as far as this one does not see it."""
        if not self._placed:
            return
        before = self._placed[-1]
        # What moves is not where it was.
        stood = before.points[self._still]
        points = np.concatenate([stood, self._hidden])
        since_s = np.concatenate([np.full(len(stood), before.scan.time), self._hidden_since_s])
        away_m, sees_m = now.range_m(points)
        kept = (away_m < _NEAR_M) & (since_s > now.scan.time - _REMEMBERED_S)
        kept &= ~(sees_m > away_m - _HIDDEN_M)
        points, since_s = points[kept], since_s[kept]
        hidden = ~_beside(points, now)
        points, since_s = points[hidden], since_s[hidden]
        cells = np.round(points / _CELL_M).astype(np.int64)
        _, first = np.unique(cells[:, 0] * 1_000_003 + cells[:, 1], return_index=True)
        self._hidden, self._hidden_since_s = points[first], since_s[first]


def _beside(points: Points, now: _Placed) -> NDArray[np.bool_]:
    """Which of some near points (n,) are as good as what a scan shows: a cell off, or less."""
    side = 2 * round(_NEAR_M / _CELL_M) + 5
    corner = np.array([now.at.x, now.at.y]) - (side // 2) * _CELL_M

    def cells(of: Points) -> NDArray[np.int64]:
        return np.round((of - corner) / _CELL_M).astype(np.int64)

    shown = cells(now.points)
    shown = shown[((shown > 0) & (shown < side - 1)).all(axis=1)]
    # With a margin of one cell, so that every cell has eight beside it.
    marked = np.zeros((side + 2) ** 2, np.bool_)
    marked[(shown[:, 0] + 1) * (side + 2) + shown[:, 1] + 1] = True
    at = cells(points) + 1
    around = np.add.outer(np.arange(-1, 2) * (side + 2), np.arange(-1, 2)).ravel()
    return np.asarray(marked[np.add.outer(around, at[:, 0] * (side + 2) + at[:, 1])].any(axis=0))


def hidden_behind(scan: RangeScan, here: BasePose, known: Points) -> Points:
    """Those of some near points (n, 2) that a map has, before which something is seen."""
    if not len(known):
        return known
    away_m, sees_m = _Placed(scan, here, NOTHING).range_m(known)
    return known[(away_m < _NEAR_M) & (sees_m < away_m - _KNOWN_BEHIND_M)]


def points_of(scan: RangeScan, at: BasePose) -> Points:
    """What a scan shows (n, 2) that was made at a pose, in the pose's frame.

    Along a wall that is seen at a grazing angle hits lie far apart: it is closed between them.
    """
    seen = np.isfinite(scan.ranges_m)
    ranges_m, bearings = scan.ranges_m[seen], scan.angles_rad[seen] + at.yaw
    hits = _beside_each_other(
        at.x + ranges_m * np.cos(bearings), at.y + ranges_m * np.sin(bearings)
    )
    return np.concatenate([hits, _between(hits, np.flatnonzero(seen))])


def _between(hits: Points, beams: NDArray[np.intp]) -> Points:
    """Points of walls between the hits (n, 2) of beams that are next to each other."""
    if len(hits) < 3:
        return np.zeros((0, 2))
    steps = np.diff(hits, axis=0)
    gaps_m = np.hypot(*steps.T)
    shorter_m = np.maximum(np.minimum(gaps_m[:-1], gaps_m[1:]), 1e-6)
    # How far the end of the longer of two steps is from the line of the other.
    turns = np.abs(_cross(steps[:-1], steps[1:])) / shorter_m
    straight = np.zeros(len(steps), np.bool_)
    straight[1:] = turns < _OFF_LINE_M
    straight[:-1] |= turns < _OFF_LINE_M
    wide = (np.diff(beams) == 1) & (gaps_m > _FILLED_M) & (gaps_m < _WIDEST_GAP_M)
    closed = np.flatnonzero(straight & wide)
    counts = np.ceil(gaps_m[closed] / _FILLED_M - 1.0).astype(np.intp)
    each = np.repeat(closed, counts)
    before = np.repeat(np.cumsum(counts) - counts, counts)
    along_m = (np.arange(len(each)) - before + 1.0) * _FILLED_M
    return np.asarray(hits[each] + (along_m / gaps_m[each])[:, None] * steps[each])


def _cross(a: Points, b: Points) -> NDArray[np.float64]:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def out_of_frame_of(points: Points, pose: BasePose) -> Points:
    """Points (n, 2) that a base has that is at a pose, in the frame that the pose is in."""
    cos, sin = math.cos(pose.yaw), math.sin(pose.yaw)
    x, y = points[:, 0], points[:, 1]
    return _beside_each_other(pose.x + cos * x - sin * y, pose.y + sin * x + cos * y)


def in_frame_of(points: Points, pose: BasePose) -> Points:
    """Points (n, 2) as a base has them that is at a pose."""
    cos, sin = math.cos(pose.yaw), math.sin(pose.yaw)
    x, y = points[:, 0] - pose.x, points[:, 1] - pose.y
    return _beside_each_other(cos * x + sin * y, cos * y - sin * x)


def _beside_each_other(x: NDArray[np.float64], y: NDArray[np.float64]) -> Points:
    """The points (n, 2) of two coordinates; `column_stack` takes twice as long for so few."""
    points = np.empty((len(x), 2))
    points[:, 0], points[:, 1] = x, y
    return points
