"""A base that drives: sending it on its way, a control cycle at a time."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from mend.maps.building.building import ON_FLOOR_M
from mend.maps.building.cabin import CABIN_M
from mend.robots.base.basket import Basket, LoadSense, NoBasket
from mend.robots.base.battery import Battery, MainsPower
from mend.robots.base.body import BaseBody, BasePose
from mend.robots.base.closed_ways import Closed, ClosedWays
from mend.robots.base.companion import Companion, Company, NoCompanion
from mend.robots.base.driven_way import DrivenWay
from mend.robots.base.elevators import Elevators, NoElevators
from mend.robots.base.jumps import Jumps
from mend.robots.base.made_way import MadeWay
from mend.robots.base.motion.surroundings import Seen, Surroundings, hidden_behind
from mend.robots.base.motion.warming_up import warm_up
from mend.robots.base.motion.way_follower import WayFollower
from mend.robots.base.open_door import sees_through
from mend.robots.base.way_ahead import WayAhead
from mend.robots.base.ways import Ride, Ways
from mend.robots.base.whereabouts import AlwaysKnown, Whereabouts
from mend.robots.execution.effector import Effector
from mend.robots.link.messages import Driven

SLOW_M_S, SLOW_RAD_S = 0.05, 0.1
_SEES_OUT = 0.05
"""More of its beams lead out of an open cabin than fail to come back."""
_CHANGES_S = 10.0
"""Another elevator has to be quicker by so much than one for which a base waits already."""
_ABOUT_THERE_M = 0.3
"""Robots say by so much where they are, at worst, and lasers what they see."""
_BEHIND_M = 0.2
"""A door is so near to where the laser sees it, by the map."""


@dataclass(frozen=True, slots=True)
class Barrier:
    """What leaves a base no way on, so far from its rim; `door` if its map has one there.

    `robot`: the one that it is, where one that has failed stands there as far as is known.
    `between`: the neighbouring places of its map between which that is, where it is on a lane.
    """

    away_m: float
    door: str | None
    between: tuple[str, str] | None = None
    robot: str | None = None


class Base(Effector[BaseBody]):
    """A base; it is at rest wherever it stands."""

    def __init__(
        self,
        body: BaseBody,
        ways: Ways,
        elevators: Elevators | None = None,
        whereabouts: Whereabouts | None = None,
        basket: Basket | None = None,
        battery: Battery | None = None,
        companion: Companion | None = None,
    ) -> None:
        """`ways` says which points to pass to a goal, `whereabouts` if it may be lost."""
        warm_up()
        super().__init__(body)
        self.ways = ways
        self.elevators = elevators or NoElevators()
        self.basket = basket or NoBasket()
        self.battery: Battery = battery or MainsPower()
        self.load = LoadSense(self.basket)
        self.companion: Companion = companion or NoCompanion()
        self.company = Company(self.companion, body.time_s)
        self.whereabouts: Whereabouts = whereabouts or AlwaysKnown()
        self.closed = ClosedWays()
        self.asks_after_s = 0.0
        """So long others have, once they know, to do what it is about before it asks people."""
        self.at_rest = True
        self.made_way: MadeWay | None = None
        """What it was last told to do about another robot that it has met."""
        self.may_stand_aside = False
        """Whether it could make way although it does not drive."""
        self.failed: Mapping[str, tuple[float, float, float]] = {}
        """Where robots stand that work no more, as it was told (base frame)."""
        self._speed = 1.0
        self._surroundings = Surroundings()
        self._jumps = Jumps()
        self._way = DrivenWay()
        self._following: WayFollower | None = None
        self._barred: WayFollower | None = None
        self._barrier: tuple[str, str] | None = None

    def start(self, to: BasePose, speed: float) -> None:
        """Begin to drive to a pose, at `speed` in (0, 1] of its best. Raises `CommandError`."""
        self._following, self._speed = self._follower(to), speed
        self._barred = self._barrier = None
        self.at_rest = False

    def start_along(self, way: Sequence[tuple[float, float]]) -> None:
        """Begin to drive along points of this floor, whatever its map says of lanes."""
        here, (x, y) = self.body.pose(), way[-1]
        self._following = self._along(way, replace(here, x=x, y=y))
        self._speed, self._barred, self._barrier = 1.0, None, None
        self.at_rest = False

    def jumps(self) -> bool:
        """Whether it now believes to be elsewhere than where its way led it; once a cycle."""
        return self._jumps.note(self.body.pose(), self.body.odometry())

    def drive_on(self, *, waits: bool = False) -> None:
        """Choose how to move in the next control cycle; once a cycle, after `start`.

        Who is lost stands still until it knows where it is, and who `waits` until it does not.
        """
        assert self._following is not None, "it was started"
        here, now = self.body.pose(), self.body.velocity()
        seen = self._look_around(here)
        if self.whereabouts.is_lost or waits:
            self.body.stop()
            return
        scanned_s = self.body.scan().time
        self.body.move(self._following.choose(here, now, seen, self.pace, scanned_s))
        if self._following.barred and self.slow:
            self._way.stood(self.body.control_period_s)

    def stop(self) -> None:
        """Brake; it is on no way any more."""
        super().stop()
        if self._following is not None and self._following.barred:
            self._barred = self._following
        self._following = None
        self.at_rest = True

    @property
    def braking(self) -> bool:
        return self._following is None and self.body.moving

    @property
    def pace(self) -> float:
        """How fast it may go at the moment, in (0, 1] of its best."""
        return self._scaled(self._speed)

    @property
    def slow(self) -> bool:
        """Whether it stands, or is about to."""
        now = self.body.velocity()
        return now.speed_m_s < SLOW_M_S and abs(now.turn_rad_s) < SLOW_RAD_S

    def driven(self) -> Driven:
        """What it has driven so far."""
        return self._way.so_far(self.body.odometry())

    @property
    def following(self) -> WayFollower | None:
        """How it gets on along its way; None while it is on none."""
        return self._following

    def barrier(self) -> Barrier | None:
        """What leaves it no way on; None where it gets on."""
        following, here = self._following, self.body.pose()
        if following is None or not following.barred:
            return None
        points = self._surroundings.seen.in_frame_of(self.body.odometry()).seen_from(here).points
        met = following.first_met(points)
        if met is None:
            nearest_m = np.hypot(points[:, 0] - here.x, points[:, 1] - here.y).min(initial=math.inf)
            return Barrier(max(0.0, float(nearest_m) - self.body.radius_m), None)
        away_m = math.dist(met, (here.x, here.y))
        robot = self._failed_at(met, here.z)
        return Barrier(
            away_m=max(0.0, away_m - self.body.radius_m),
            door=self._door_where(met, here) if robot is None else None,
            between=self.ways.lane_at(here, met),
            robot=robot,
        )

    def _door_where(self, met: tuple[float, float], here: BasePose) -> str | None:
        """The shut door where something is met: what is seen through, or passed on the way to
        that, is open."""
        away_m = max(math.dist(met, (here.x, here.y)), 1e-6)
        off = (met[0] - here.x) / away_m, (met[1] - here.y) / away_m
        before_m, beyond_m = max(0.0, away_m - _BEHIND_M), away_m + _BEHIND_M
        before = replace(here, x=here.x + before_m * off[0], y=here.y + before_m * off[1])
        beyond = here.x + beyond_m * off[0], here.y + beyond_m * off[1]
        door = self.ways.door_at(before, beyond)
        return None if door is None or self._sees_open(door, here) else door

    def _sees_open(self, door: str, here: BasePose) -> bool:
        """Whether a door, or an elevator, is seen to stand open."""
        posts = self.ways.posts(door, here)
        if posts is None:
            return self.ways.elevator_at(here) == door and self.sees_out()
        return sees_through(self.body.scan(), here, posts)

    def _failed_at(self, met: tuple[float, float], z: float) -> str | None:
        """The robot that has failed and stands where something is met."""
        within_m = self.body.radius_m + _ABOUT_THERE_M
        for robot, (x, y, height) in self.failed.items():
            if math.dist(met, (x, y)) <= within_m and abs(height - z) < ON_FLOOR_M:
                return robot
        return None

    def failed_in(self, elevator: str) -> str | None:
        """The robot that has failed and stands in the cabin of an elevator, at whichever floor."""
        for robot, (x, y, z) in self.failed.items():
            if self.ways.elevator_at(BasePose(x, y, 0.0, z)) == elevator:
                return robot
        return None

    def bar(self, between: tuple[str, str]) -> None:
        """Remember that what leaves it no way on is between these places, the one behind first."""
        self._barrier = between
        for lane in self.ways.together(between):
            self.closed.bar(lane, between[0], self.body.time_s())

    def rode(self, between: tuple[str, str]) -> bool:
        """It has ridden an elevator; whether that counted as closed."""
        lanes = self.ways.together(between)
        closed = not self.closed.doubtful(self.body.time_s()).keys().isdisjoint(lanes)
        for lane in lanes:
            self.closed.passed(lane)
        return closed

    def rides_from_here(self, to: BasePose) -> Sequence[Ride]:
        """The rides to a pose that take no elevator that is closed, if others lead there. Raises
        `CommandError`."""
        return self.ways.rides(self.body.pose(), to, self._closed_now)

    def rides_round(self, ride: Ride, to: BasePose) -> Sequence[Ride]:
        """The rides to a pose that take no elevator that is closed, nor this one; none if none do.

        Raises `CommandError`.
        """
        shut = {**self._closed_now, **dict.fromkeys(self.ways.together(ride.between))}
        rides = self.ways.rides(self.body.pose(), to, shut)
        return () if any(frozenset(each.between) in shut for each in rides) else rides

    def rides_sooner(self, ride: Ride, to: BasePose) -> Sequence[Ride]:
        """The rides to a pose that begin with another elevator, as others are to ride before it in
        this one; none where those are not quicker. Raises `CommandError`.
        """
        waits_s = {
            name: wait_s if name == ride.elevator else wait_s + _CHANGES_S
            for name, wait_s in self.elevators.waits_s().items()
        }
        rides = self.ways.rides(self.body.pose(), to, self._closed_now, waits_s)
        goes = bool(rides) and rides[0].elevator != ride.elevator
        return rides if goes and not any(map(self.is_closed, rides)) else ()

    def is_closed(self, ride: Ride) -> bool:
        """Whether its elevator counts as closed."""
        return frozenset(ride.between) in self._closed_now

    def round_takes_s(self, to: BasePose) -> float:
        """How much longer than the way that is barred another one takes; infinite without one.

        Where something stands about where lanes meet, the way on may lead by no lane that is
        closed: it is another one only where the base gets on along it. Raises `CommandError`.
        """
        here = self.body.pose()
        barred = self._following or self._barred
        if barred is None or not self.ways.leads_round(here, to, self._closed_now):
            return math.inf
        other = self._follower(to)
        if not other.gets_on(here, self._look_around(here).points):
            return math.inf
        longer_m = other.length_m - barred.ahead_m
        return max(0.0, longer_m) / self.body.limits.speed_m_s

    def sees_out(self) -> bool:
        """Whether it sees farther than the walls of a cabin in which it would be."""
        out = self.body.scan().ranges_m > 2 * CABIN_M
        return float(out.mean()) > _SEES_OUT

    def way_to(self, to: BasePose, patience_s: float) -> WayAhead:
        """Whether what is seen leaves a way on to a pose. Raises `CommandError`.

        Where it stopped because it did not get on, it is the way there that counts: another one
        might lead back first, where of course nothing is in the way. One that leads round and
        takes longer by `patience_s` at most is taken.
        """
        here = self.body.pose()
        points = self._look_around(here).points
        barred = self._barred
        if barred is None or barred.goal != to:
            return WayAhead.FREE if self._follower(to).gets_on(here, points) else WayAhead.BARRED
        if barred.gets_on(here, points):
            if self._barrier is not None:
                self.closed.free(frozenset(self._barrier))
            gets_on = self._follower(to).gets_on(here, points)
            return WayAhead.FREE if gets_on else WayAhead.BARRED
        if self._barrier is None or self.round_takes_s(to) > patience_s:
            return WayAhead.BARRED
        return WayAhead.ROUND

    # --- Within -------------------------------------------------------------------------------

    def _apply_speed(self) -> None:
        """Every cycle asks how fast it may go."""

    def _follower(self, to: BasePose) -> WayFollower:
        return self._along(self.ways.path(self.body.pose(), to, self._closed_now), to)

    def _along(self, way: Sequence[tuple[float, float]], to: BasePose) -> WayFollower:
        body, here = self.body, self.body.pose()
        whole = [(here.x, here.y), *way]
        return WayFollower(body.limits, body.radius_m, body.control_period_s, whole, to)

    @property
    def _closed_now(self) -> Closed:
        return self.closed.at(self.body.time_s())

    def _look_around(self, here: BasePose) -> Seen:
        """What is seen and remembered, and walls that it hides, in the frame of `here`.

        It is remembered by the wheels, which never jump: what the base believes of where it is
        moves nothing that it sees around it.
        """
        wheels, scan = self.body.odometry(), self.body.scan()
        self._way.note(wheels)
        seen = self._surroundings.take(scan, wheels, self.body.time_s())
        seen = seen.in_frame_of(wheels).seen_from(here)
        return seen.with_still(hidden_behind(scan, here, self.ways.walls(here)))
