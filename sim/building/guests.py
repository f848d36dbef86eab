"""People whom robots escort: they wait where they are met, follow, and now and then dawdle."""

import math
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.crossing import crossed_by
from mend.robots.base.companion import CAUGHT_UP_M
from mend.sim.building.building_robot import PERIOD_S, BuildingRobot
from mend.sim.building.bystander import RADIUS_M
from mend.sim.building.door import WorldDoor, open_doors
from mend.sim.building.draws import read_draws, written_draws
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.guest import Guest, GuestSnapshot, guest_of, is_at
from mend.sim.building.social_force import KEEP_M, ahead, free_step, pushed
from mend.sim.building.way_on_foot import may_walk, way_on_foot

Matrix = NDArray[np.float64]
Point = tuple[float, float]

_SPEEDS_M_S = (0.7, 1.3)
_LATE = 0.3
_LATE_S = (5.0, 60.0)
"""So often who is to be met comes only so long after the robot."""
_THINKS_EVERY_S = 10.0
_DAWDLES_S = (5.0, 60.0)
_LOOKS_EVERY_S = 5.0
"""Who is off their way looks for another so often."""
_FOLLOWS_M = 1.1
"""Who follows stays so far behind, along the way."""
_SLOWS_OVER_M = 0.8
_STILL_M_S = 0.08
_FROM_STOP_M = 0.33
_ASIDE_M = 0.15
"""In a cabin whose middle a robot leaves by less there is no room for anybody else."""
_NEAR_STOP_M = 1.6
_IN_CABIN_KEEP_M = 0.02


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What people may ask of the building they are in.

    `segments`: what nobody walks through on a floor; `people`: who else is there. `room_beside`: a
    free place near a point, if any; `stop_around`: the middle of the cabin that somebody is in.
    """

    segments: Callable[[str], Matrix]
    people: Callable[[str, Guest], Iterable[FloorPose]]
    robots: Sequence[BuildingRobot]
    room_beside: Callable[[FloorPose], FloorPose | None]
    stop_around: Callable[[Guest | BuildingRobot], Point | None]
    doors: Sequence[WorldDoor]


class Guests:
    """All whom robots, by their numbers, are to meet or lead; drawn by a generator of their own."""

    def __init__(
        self, no_shows: float, dawdling: float, places: Mapping[str, FloorPose], seed: int
    ) -> None:
        """`places`: where people are met, by the names that robots know."""
        self._no_shows, self._dawdling = no_shows, dawdling
        self._places = places
        self._rng = np.random.default_rng([seed, 0xE5C0])
        self.of_robots: dict[int, Guest] = {}

    @property
    def there(self) -> dict[int, Guest]:
        """Those who have come."""
        return {n: each for n, each in self.of_robots.items() if each.where is not None}

    # --- What robots want -----------------------------------------------------------------------

    def expect(self, robot: int, person: str, place: str) -> None:
        """A robot comes to meet somebody, who hears of it."""
        known = self.of_robots.get(robot)
        if known is not None and known.waits_for(person, place, self._places.get(place)):
            known.left_s = None
            return
        absent, late, late_s, speed = self._rng.random(4)
        guest = Guest(person, place, _between(_SPEEDS_M_S, speed), 0.0)
        if absent < self._no_shows:
            guest.late_s = None
        elif late < _LATE:
            guest.late_s = _between(_LATE_S, late_s)
        self.of_robots[robot] = guest

    def lead(self, robot: int, person: str) -> None:
        """A robot has somebody follow whom it has met."""
        guest = self.of_robots.get(robot)
        if guest is not None and guest.person == person:
            if not guest.led:
                guest.trail.clear()
            guest.led, guest.left_s = True, None

    def leave(self, robot: int, time_s: float) -> None:
        """A robot leads nobody any more."""
        guest = self.of_robots.get(robot)
        if guest is not None and guest.left_s is None:
            guest.led, guest.left_s = False, time_s

    def send(self, robot: int, time_s: float, near: FloorPose, around: Surroundings) -> str:
        """Somebody tells a robot's guest to come; returns why they cannot, or nothing.

        Who is on another floor takes the elevator alone, and is met near its door again.
        """
        guest = self.of_robots[robot]
        if guest.late_s is None:
            return f"nobody here is called {guest.person}"
        guest.paused_until_s, guest.thinks_s = time_s, time_s + _THINKS_EVERY_S
        guest.looks_s = time_s
        if guest.where is None:
            guest.comes_s = time_s
        elif guest.at.floor != near.floor:
            return _ride_alone(guest, near, around)
        return ""

    # --- Whether they do anything ---------------------------------------------------------------

    def state(self) -> Hashable:
        """All that they do, for comparison."""
        return tuple(
            (n, e.where, e.velocity, e.led, len(e.trail), *e.times_s())
            for n, e in self.of_robots.items()
        )

    def changes_s(self, time_s: float) -> float:
        """When the next one may do something by the clock alone; infinite if none does."""
        times_s = (at_s for each in self.of_robots.values() for at_s in each.times_s())
        return min((each for each in times_s if each > time_s), default=math.inf)

    # --- What they do ---------------------------------------------------------------------------

    def walk(self, time_s: float, robots: Sequence[BuildingRobot], around: Surroundings) -> None:
        """One cycle."""
        gone = [n for n, each in self.of_robots.items() if each.has_gone(time_s)]
        for number in gone:
            del self.of_robots[number]
        for number, guest in self.of_robots.items():
            robot = robots[number]
            if guest.where is None:
                self._come(guest, robot, time_s, around)
            elif not guest.at.floor.startswith("/"):
                self._follow(guest, robot, time_s, around)

    def _come(
        self, guest: Guest, robot: BuildingRobot, time_s: float, around: Surroundings
    ) -> None:
        place = self._places.get(guest.place)
        if place is None or guest.late_s is None:
            return
        if guest.comes_s is None and (guest.late_s == 0.0 or is_at(robot.at, place)):
            guest.comes_s = time_s + guest.late_s
        if guest.comes_s is not None and time_s >= guest.comes_s:
            guest.where = around.room_beside(place)
            guest.thinks_s = time_s + _THINKS_EVERY_S

    def _follow(
        self, guest: Guest, robot: BuildingRobot, time_s: float, around: Surroundings
    ) -> None:
        if guest.led:
            guest.note(robot.at)
        guest.pass_on()
        here = np.array([guest.at.x, guest.at.y])
        stop, inside = around.stop_around(robot), around.stop_around(guest)
        if stop is not None and _gets_in(guest, robot, stop):
            self._get_in(guest, robot, stop, around)
            return
        left_m = guest.way_m(robot.at)
        goes = inside is not None or (guest.led and not self._dawdles(guest, time_s))
        goes = goes and robot.at.floor == guest.at.floor and left_m >= _FOLLOWS_M
        goes |= not guest.led and self._goes_to_meet(guest, robot, around)
        # Nobody lets themselves be pushed out of a cabin where it has no door.
        keep_m = None if inside is None else _IN_CABIN_KEEP_M
        if not goes or not self._has_way(guest, robot, time_s, around):
            self._step(guest, here, 0.0, robot, around, keep_m)
            return
        if open_doors(around.doors, guest.at, time_s):
            return
        slowed = (guest.way_m(robot.at) - _FOLLOWS_M + 0.2) / _SLOWS_OVER_M
        goal = np.array(guest.trail[0])
        speed_m_s = guest.speed_m_s * min(1.0, max(0.0, slowed))
        self._step(guest, goal, speed_m_s, robot, around, keep_m)

    def _goes_to_meet(self, guest: Guest, robot: BuildingRobot, around: Surroundings) -> bool:
        """Whether a robot has come for who waits out of its sight, or too far away."""
        place = self._places.get(guest.place)
        if guest.left_s is not None or place is None or not is_at(robot.at, place):
            return False
        if robot.moving or robot.at.floor != guest.at.floor:
            return False
        way = np.array([guest.at.x, guest.at.y, robot.at.x, robot.at.y])
        far = math.dist(way[:2], way[2:]) > CAUGHT_UP_M - 0.5
        return far or bool(len(crossed_by(way, around.segments(guest.at.floor))))

    def _has_way(
        self, guest: Guest, robot: BuildingRobot, time_s: float, around: Surroundings
    ) -> bool:
        """Whether there is a point to walk to; who is off their way looks for another."""
        walls, here = around.segments(guest.at.floor), (guest.at.x, guest.at.y)
        goal = guest.trail[0] if guest.trail else (robot.at.x, robot.at.y)
        if may_walk(here, goal, walls):
            guest.trail, guest.trail_floor = guest.trail or [goal], guest.at.floor
        elif time_s >= guest.looks_s:
            guest.looks_s = time_s + _LOOKS_EVERY_S
            guest.trail = way_on_foot(here, (robot.at.x, robot.at.y), walls) or guest.trail
            guest.trail_floor = guest.at.floor
            _cut_off(guest, walls)
        return bool(guest.trail)

    def _dawdles(self, guest: Guest, time_s: float) -> bool:
        if time_s >= guest.thinks_s:
            stops, long = self._rng.random(2)
            guest.thinks_s = time_s + _THINKS_EVERY_S
            if stops < self._dawdling:
                guest.paused_until_s = time_s + _between(_DAWDLES_S, long)
                guest.thinks_s += guest.paused_until_s - time_s
        return time_s < guest.paused_until_s

    def _get_in(
        self, guest: Guest, robot: BuildingRobot, stop: Point, around: Surroundings
    ) -> None:
        """To the other side of the middle of a cabin that a robot stands in."""
        off = np.array([stop[0] - robot.at.x, stop[1] - robot.at.y])
        goal = np.array(stop) + _FROM_STOP_M * off / max(float(np.hypot(*off)), 1e-6)
        away_m = math.dist(goal, (guest.at.x, guest.at.y))
        speed = 0.0 if away_m < 0.01 else min(guest.speed_m_s, away_m / 0.5)
        self._step(guest, goal, speed, robot, around, _IN_CABIN_KEEP_M)

    def _step(
        self,
        guest: Guest,
        goal: Matrix,
        speed_m_s: float,
        robot: BuildingRobot,
        around: Surroundings,
        keep_m: float | None = None,
    ) -> None:
        """One step to a goal; who is to `keep_m` from robots is not pushed off by any."""
        at = guest.at
        here = np.array([at.x, at.y])
        hard = _near(guest, around, robot if keep_m is not None else None)
        if keep_m is not None:
            wanted = speed_m_s * (goal - here) / max(float(np.hypot(*(goal - here))), 1e-6)
        else:
            most_m_s = max(speed_m_s, guest.speed_m_s)
            wanted = pushed(np.array(guest.velocity), here, goal, speed_m_s, hard, most_m_s)
            if speed_m_s == 0.0 and np.hypot(*wanted) < _STILL_M_S:
                wanted = np.zeros(2)
        to = free_step(here, wanted, hard, around.segments(at.floor))
        if to is None:
            guest.velocity = (0.0, 0.0)
            return
        x, y = float(to[0]), float(to[1])
        guest.velocity = ((x - at.x) / PERIOD_S, (y - at.y) / PERIOD_S)
        guest.where = FloorPose(at.floor, x, y)

    # --- What they are rebuilt from -------------------------------------------------------------

    def snapshot(self) -> dict[int, GuestSnapshot]:
        """Who is where, and whom they follow."""
        return {robot: each.snapshot() for robot, each in self.of_robots.items()}

    def draws(self) -> str:
        """What is drawn next."""
        return written_draws(self._rng)

    def restore(self, guests: Mapping[int, GuestSnapshot], draws: str) -> None:
        """Raises `ValueError` for draws that no generator wrote."""
        read_draws(self._rng, draws)
        self.of_robots = {robot: guest_of(each) for robot, each in guests.items()}


def _between(limits: tuple[float, float], share: float) -> float:
    low, high = limits
    return float(low + share * (high - low))


def _cut_off(guest: Guest, segments: Matrix) -> None:
    """Where the trail led past what is shut by now, as a cabin is, go on from where that ends."""
    here = (guest.at.x, guest.at.y)
    free = (
        number
        for number, point in enumerate(guest.trail)
        if not len(crossed_by(np.array([*here, *point]), segments))
    )
    del guest.trail[: next(free, 0)]


def _ride_alone(guest: Guest, robot: FloorPose, around: Surroundings) -> str:
    """Be on the robot's floor, where it came along, as near to the elevator as there is room."""
    for number, point in enumerate([*guest.trail, (robot.x, robot.y)]):
        at = around.room_beside(FloorPose(robot.floor, *point))
        if at is not None:
            guest.where, guest.trail = at, guest.trail[number:]
            return ""
    return f"there is no room for {guest.person} beside the robot"


def _near(guest: Guest, around: Surroundings, beside: BuildingRobot | None) -> Matrix:
    """What somebody keeps off, as circles (n, 3): of who they are `beside` by less."""
    floor = guest.at.floor
    people = ((at.x, at.y, RADIUS_M + KEEP_M) for at in around.people(floor, guest))
    robots = (
        circle
        for each in around.robots
        if each.at.floor == floor
        for circle in (ahead(each, _IN_CABIN_KEEP_M) if each is beside else ahead(each))
    )
    return np.array([*people, *robots], np.float64).reshape(-1, 3)


def _gets_in(guest: Guest, robot: BuildingRobot, stop: Point) -> bool:
    """Whether who follows is near the cabin in which the robot stands, and has room there."""
    if math.dist(stop, (robot.at.x, robot.at.y)) < _ASIDE_M:
        return False
    near = math.dist(stop, (guest.at.x, guest.at.y)) < _NEAR_STOP_M
    return guest.led and near and robot.at.floor == guest.at.floor and not robot.moving
