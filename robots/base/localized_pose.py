"""The pose of a base by its laser: a localizer's estimate, carried on by odometry in between."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from mend.localization.localizer import SearchingLocalizer
from mend.localization.pose import Poses, compose, relative, wrap_angle
from mend.localization.scan import Scan
from mend.robots.base.body import RangeScan
from mend.robots.link.messages import MOST_GUESSES

Describe = Callable[[float, float], str | None]
"""What people call a point of the map: `at F1-101`, `near F1-101`; None where it has no name."""

_EVERY_M, _EVERY_RAD = 0.3, 0.3
"""A scan is taken after so much has been driven or turned since the last; wheels do for less."""
_EVERY_S = 2.0
"""One that stands takes one so often; who is lost takes every one."""
_JUMPS_M, _JUMPS_RAD = 1.0, 1.0
"""No estimate is corrected by so much at once that was right before."""
_BEAM_RAD = math.radians(2.0)
"""Of denser beams some are enough, for less time."""
_SEARCHES_AFTER_S = 0.5
_SEARCHES_EVERY_S = 5.0
"""A lost robot that stands searches its map so soon, and so often again."""
_ANYWHERE = np.diag([100.0, 100.0, 10.0])
_NOT_YET_S = -math.inf


class LocalizedPose:
    """Implements `Whereabouts` for one base on the map of one floor; poses are in the map's frame.

    `odometry` is where the wheels say that the base has come to, in a frame of their own. There is
    no clock: time is that of the scans.
    """

    def __init__(
        self, localizer: SearchingLocalizer, describe: Describe, at: Poses, odometry: Poses
    ) -> None:
        """The base is `at` a pose that is known to some decimetres."""
        self.change_map(localizer, describe, at, odometry)

    def change_map(
        self, localizer: SearchingLocalizer, describe: Describe, at: Poses, odometry: Poses
    ) -> None:
        """From now on it is on another map, `at` a known pose of it: on another floor."""
        self._localizer, self._describe = localizer, describe
        self.start_anew(at, odometry, lost=False)

    def start_anew(self, at: Poses, odometry: Poses, *, lost: bool) -> None:
        """It is `at` a pose, or (`lost`) may be anywhere."""
        self._localizer.reset(at, _ANYWHERE if lost else None)
        self._at, self._from = np.array(at, np.float64), np.array(odometry, np.float64)
        self.is_lost = lost
        self._covariance: Sequence[float] | None = None
        self._time_s = self._lost_since_s = self._updated_s = _NOT_YET_S
        self._searches_s = math.inf
        self._newest: Scan | None = None

    # --- What it knows ------------------------------------------------------------------------

    def pose(self, odometry: Poses) -> Poses:
        """Where it is, if its wheels are there."""
        return _carried_on(self._at, self._from, odometry)

    @property
    def lost_s(self) -> float:
        """How long it has been lost, at the newest scan."""
        return self._time_s - self._lost_since_s if self.is_lost else 0.0

    def covariance(self) -> Sequence[float] | None:
        """That of its last estimate; None before the first, and while it is lost."""
        return None if self.is_lost else self._covariance

    def guesses(self) -> Sequence[str]:
        """What the places are called that it may be at, each once.

        Where it has followed itself comes first, if what it sees allows that: a doubt is more often
        false than it has been carried to a place that looks the same. Then the likeliest.
        """
        named = (self._describe(float(each[0]), float(each[1])) for each in self._open_places())
        return list(dict.fromkeys(each for each in named if each is not None))[:MOST_GUESSES]

    # --- What it is told ----------------------------------------------------------------------

    def note(self, odometry: Poses, scan: RangeScan) -> None:
        """Take a new scan, made where the wheels are now."""
        self._time_s = scan.time
        if self.is_lost and self._lost_since_s == _NOT_YET_S:
            self._get_lost()
        self._newest = _as_scan(scan)
        if scan.time >= self.due_s(odometry):
            moved = relative(self._from, odometry)
            far = _is_far(moved)
            if scan.time >= self._searches_s and not far:
                self._localizer.search_next()
                self._searches_s = scan.time + _SEARCHES_EVERY_S
            self._update(moved, odometry)

    def due_s(self, odometry: Poses) -> float:
        """When it needs a scan, if its wheels are there; any before that only passes the time."""
        if self.is_lost or _is_far(relative(self._from, odometry)):
            return -math.inf
        return self._updated_s + _EVERY_S

    def believe(self, guess: str) -> bool:
        """Take the first place of that name, in the order of `guesses`, if what it sees agrees.

        It looks anew first: it may have been carried on since it asked.
        """
        if self._newest is None:
            return False
        if self.is_lost:
            self._localizer.search_next()
            self._update(np.zeros(3), self._from)
        if not self.is_lost:
            return self._describe(float(self._at[0]), float(self._at[1])) == guess
        for place in self._open_places():
            if self._describe(float(place[0]), float(place[1])) == guess:
                self._localizer.take(place)
                self._update(np.zeros(3), self._from)
                return not self.is_lost
        return False

    # --- Within -------------------------------------------------------------------------------

    def _open_places(self) -> Sequence[Poses]:
        places = self._localizer.open_places() if self.is_lost else ()
        return sorted(places, key=lambda place: _is_elsewhere(self._at, place))

    def _update(self, moved: Poses, odometry: Poses) -> None:
        assert self._newest is not None, "there was a scan"
        expected = compose(self._at, moved)
        estimate = self._localizer.update(moved, self._newest)
        is_lost, at = estimate.is_lost, estimate.pose.copy()
        self._covariance = estimate.covariance[[0, 0, 1], [0, 1, 1]].tolist()
        if not (is_lost or self.is_lost) and _is_elsewhere(expected, at):
            # It has only found a place that it likes better: neither is sure.
            self._localizer.get_lost()
            is_lost, at = True, expected
        self._at, self._from = at, np.array(odometry, np.float64)
        self._updated_s = self._time_s
        if is_lost and not self.is_lost:
            self._get_lost()
        self.is_lost = is_lost

    def _get_lost(self) -> None:
        self._lost_since_s = self._time_s
        self._searches_s = self._time_s + _SEARCHES_AFTER_S


def _is_far(moved: Poses) -> bool:
    return math.hypot(moved[0], moved[1]) >= _EVERY_M or abs(float(moved[2])) >= _EVERY_RAD


def _is_elsewhere(a: Poses, b: Poses) -> bool:
    apart_m = math.hypot(a[0] - b[0], a[1] - b[1])
    return apart_m > _JUMPS_M or abs(wrap_angle(float(a[2] - b[2]))) > _JUMPS_RAD


def _carried_on(at: Poses, was: Poses, odometry: Poses) -> Poses:
    """Where who was `at` a pose is now; in plain numbers, as it is asked for again and again."""
    turn = float(at[2] - was[2])
    x, y = float(odometry[0] - was[0]), float(odometry[1] - was[1])
    cos, sin = math.cos(turn), math.sin(turn)
    yaw = math.remainder(float(odometry[2]) + turn, math.tau)
    return np.array([at[0] + cos * x - sin * y, at[1] + sin * x + cos * y, yaw])


def _as_scan(scan: RangeScan) -> Scan:
    angles = scan.angles_rad
    every = max(1, round(_BEAM_RAD / float(angles[1] - angles[0])))
    step = float(angles[1] - angles[0]) * every
    return Scan(scan.ranges_m[::every], float(angles[0]), step, math.inf, scan.time)
