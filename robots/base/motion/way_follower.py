"""Following a way: what to steer for next, round what is seen on it, until the goal is reached."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.robots.base.body import BasePose, DriveLimits, Velocity
from mend.robots.base.motion.dynamic_window import DynamicWindow, Steering
from mend.robots.base.motion.local_route import (
    NO_WAY,
    SPARE_M,
    TIGHT_M,
    Ends,
    LocalRoute,
    find_route,
)
from mend.robots.base.motion.polyline import Polyline
from mend.robots.base.motion.surroundings import Seen, in_frame_of

Points = NDArray[np.float64]

_SEEN_AHEAD_M = 2.5
"""It looks so far along its way for the farthest point that it can get to: within the grid."""
_EVERY_M = 0.05
_STAND_OFF_M = 0.1
"""It stops so far before the point beyond which it cannot get."""
_DETOUR_M = 8.0
"""It goes round things by no more than this, but tells of them."""
_GETS_ON_M = 0.3
"""Who stands goes on when it gets so far: it does not start for every hand's breadth."""
_THERE_M = 0.02
_STILL_THERE_M = 0.04
"""At the goal it turns; only farther off than this it drives to it again."""
FACES_GOAL_M = 1.0
"""Who goes sideways turns as it is to stand at the end once it is so near to it."""
_STANDS_M_S = 0.01


@dataclass(frozen=True, slots=True)
class _Steered:
    """What it steers for since a scan: `carrot`, with so much left, so far along its way then."""

    scanned_s: float
    carrot: tuple[float, float]
    left_m: float
    along_m: float


class WayFollower:
    """Follows one way of a base to its end, and turns there as its goal says."""

    def __init__(
        self,
        limits: DriveLimits,
        radius_m: float,
        period_s: float,
        way: Sequence[tuple[float, float]],
        goal: BasePose,
    ) -> None:
        """`way` is all of it, from where the base is; poses and points are in one frame."""
        self._window = DynamicWindow(limits, radius_m, period_s)
        self._limits, self._radius_m = limits, radius_m
        self._way, self.goal = Polyline(way), goal
        self._along_m = 0.0
        self._before: BasePose | None = None
        self._unspent_m = 0.0
        self._at_end = False
        self._kept = NO_WAY
        self._steered: _Steered | None = None
        self.length_m = self._way.length_m
        self.left_m = self.length_m
        """What is left of it: the way to the farthest point that can be got to, and on from there
        along the way."""
        self.barred = False
        """Whether what is seen leaves no way on."""

    def choose(
        self, here: BasePose, now: Velocity, seen: Seen, speed: float, scanned_s: float
    ) -> Velocity:
        """The velocity of the next cycle; what is seen is in the way's frame.

        `scanned_s`: when the newest scan was made. Until the next one a way that leads on is kept.
        """
        self._advance(here)
        steering = self._steering(here, now, seen.points, scanned_s)
        return self._window.choose(now, steering, seen.in_frame_of(here), speed)

    def gets_on(self, here: BasePose, points: Points, by_m: float = _GETS_ON_M) -> bool:
        """Whether it could go on along its way, to its end or by so much at least."""
        ahead_m = self._samples_m()
        return self._leads_on(self._route(here, points, ahead_m, by_m), ahead_m, by_m)

    @property
    def ahead_m(self) -> float:
        """How far its way still leads, whatever is on it."""
        return self.length_m - self._along_m

    @property
    def turns_at_end(self) -> bool:
        """Whether it is where the way ends."""
        return self._at_end

    def first_met(self, points: Points) -> tuple[float, float] | None:
        """The first of what is seen that is on its way, round or not; None if that is free."""
        samples = self._way.points_at(self._samples_m())
        away_m = np.hypot(*(samples[:, None] - points[None]).T).T
        met = away_m < self._radius_m + SPARE_M
        if not met.any():
            return None
        first = int(np.argmax(met.any(axis=1)))
        x, y = points[np.argmin(away_m[first])]
        return float(x), float(y)

    # --- Within -------------------------------------------------------------------------------

    def _advance(self, here: BasePose) -> None:
        """Find how far on the way it has come: no farther than it can have moved.

        Who cuts a corner is nearest to what is before that for a while, and then far beyond. Who
        goes back to get round something still wants to get as far as before.
        """
        moved_m = 0.0 if self._before is None else here.distance_m(self._before)
        self._before = here
        self._unspent_m = min(self._unspent_m + 2.0 * moved_m, _SEEN_AHEAD_M)
        most_m = min(self._along_m + self._unspent_m + 1e-3, self.length_m)
        along_m = self._way.nearest_m(here.x, here.y, self._along_m, most_m)
        self._unspent_m = max(0.0, self._unspent_m - (along_m - self._along_m))
        self._along_m = along_m

    def _samples_m(self) -> Points:
        """How far along the way the points are that it may get to next."""
        end_m = min(self._along_m + _SEEN_AHEAD_M, self.length_m)
        count = max(1, math.ceil((end_m - self._along_m) / _EVERY_M))
        return np.linspace(self._along_m, end_m, count + 1)[1:]

    def _route(self, here: BasePose, points: Points, ahead_m: Points, by_m: float) -> LocalRoute:
        """As roomy as there is one that leads on by so much, else as tight as it may be."""
        limits = self._limits
        carrot_m = 0.4 + limits.speed_m_s**2 / (2.0 * limits.acceleration_m_s2)
        ends = Ends(self._way.points_at(ahead_m), ahead_m - self._along_m + _DETOUR_M)

        def route(spare_m: float) -> LocalRoute:
            at = (here.x, here.y)
            return find_route(at, points, ends, self._radius_m, carrot_m, self._kept, spare_m)

        found = route(SPARE_M)
        return found if self._leads_on(found, ahead_m, by_m) else route(TIGHT_M)

    def _leads_on(self, route: LocalRoute, ahead_m: Points, by_m: float) -> bool:
        if route.reached is None:
            return False
        ahead = ahead_m[route.reached]
        return bool(ahead >= self.length_m - 1e-9 or ahead - self._along_m > by_m)

    def _steering(
        self, here: BasePose, now: Velocity, points: Points, scanned_s: float
    ) -> Steering:
        off_m = math.dist((here.x, here.y), self._way.end)
        self._at_end = off_m <= (_STILL_THERE_M if self._at_end else _THERE_M)
        turn_rad = math.remainder(self.goal.yaw - here.yaw, math.tau)
        if self._at_end:
            self.left_m, self.barred, self._steered = off_m, False, None
            return Steering(None, turn_rad)
        steered = self._steered
        if steered is None or steered.scanned_s != scanned_s:
            steered = self._steered = self._found(here, now, points, scanned_s)
        self.barred = steered is None
        if steered is None:
            return Steering(None, 0.0)
        self.left_m = max(0.0, steered.left_m - (self._along_m - steered.along_m))
        towards = in_frame_of(np.array([steered.carrot]), here)[0]
        if off_m > FACES_GOAL_M:
            turn_rad = math.atan2(towards[1], towards[0])
        return Steering((float(towards[0]), float(towards[1])), turn_rad)

    def _found(
        self, here: BasePose, now: Velocity, points: Points, scanned_s: float
    ) -> _Steered | None:
        """What to steer for, by what is seen now; None where no way leads on."""
        ahead_m = self._samples_m()
        stood = self.barred and now.speed_m_s < _STANDS_M_S
        by_m = _GETS_ON_M if stood else _STAND_OFF_M
        route = self._route(here, points, ahead_m, by_m)
        self._kept = route.way
        if not self._leads_on(route, ahead_m, by_m):
            return None
        assert route.reached is not None, "it leads on"
        left_m = route.cost_m + self.length_m - float(ahead_m[route.reached])
        return _Steered(scanned_s, route.carrot, left_m, self._along_m)
