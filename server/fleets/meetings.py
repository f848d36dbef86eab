"""Robots of one site that meet where they cannot pass each other: who makes way is told so."""

import math
from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from mend.fleet.right_of_way.right_of_way import RightOfWay, Standing, Yielding
from mend.maps.building.building import Building
from mend.maps.building.floor_grid import Point, sampled
from mend.robots.base.body import BasePose
from mend.robots.base.floor_ways import FloorWays
from mend.robots.execution.command_error import CommandError
from mend.robots.link.messages import BaseLimits, MakeWay, Poses, WayPoint
from mend.server.poses.bases import in_scene
from mend.tasks.frames import Frame

Standings = Mapping[str, Standing]

NEAR_M = 5.0
"""Of robots that are farther from one that does not get on it matters only where they stand."""
PATIENCE_S = 1.5
"""So long robots that meet try to get past each other by themselves."""
THERE_M = 0.5
"""Who stands so near to where it goes next is at work there, or waits for an elevator."""
ON_WAY_M = 0.6
"""Who has come off its way is no farther from it."""
_OFF_WAY_M = 0.4
"""A place where a robot has so much room to one that comes past is not on its way."""
_SPARE_M = 0.05
"""So much farther than its rim a robot keeps from walls."""


@dataclass(frozen=True, slots=True)
class Occupation:
    """What a robot is about. `goal`: the place that it is on its way to, as `FLOOR/PLACE`.

    `rests`: whether it has nothing to do, and could be sent elsewhere.
    """

    goal: str | None = None
    rests: bool = False


class Meetings:
    """Knows where the robots of a site are, and resolves where they meet.

    `occupation` tells what each is about, `base_of` how wide and fast it is; robots that do not say
    that, or whether they are barred, are only driven round.
    """

    def __init__(
        self,
        building: Building,
        frames: Mapping[str, Frame],
        reachable: Container[str],
        occupation: Callable[[str], Occupation],
        base_of: Callable[[str], BaseLimits | None],
    ) -> None:
        """`reachable`: the places that robots can be sent to, as `FLOOR/PLACE`."""
        self._building, self._frames = building, frames
        self._reachable, self._occupation = reachable, occupation
        self._base_of = base_of
        self._right_of_way = RightOfWay(building)
        self._ways: dict[tuple[float, float], FloorWays] = {}
        self._poses: dict[str, Poses] = {}
        self._since_s: dict[str, float] = {}
        """Since when what robots see has left them no way on, by their clocks."""

    def take(self, robot: str, poses: Poses) -> bool:
        """A robot says where it is; whether it may have met another one."""
        self._poses[robot] = poses
        if not poses.barred:
            self._since_s.pop(robot, None)
        self._since_s.setdefault(robot, poses.time)
        return self._stands(robot)

    def standings(self) -> Standings:
        """Where all are, and how those go on who are near one that does not get on."""
        at = {e: in_scene(self._frames[e], p.base) for e, p in self._poses.items()}
        barred = [at[each] for each in self._poses if self._stands(each)]
        standings = {}
        for robot, (x, y, z, *_) in at.items():
            floor = self._building.floor_at(z)
            if floor is None:
                continue
            near = any(math.dist((x, y, z), each[:3]) < NEAR_M for each in barred)
            standings[robot] = self._standing(robot, floor, (x, y), near=near)
        return standings

    def decide(self, standings: Standings, now_s: float) -> Yielding | None:
        """Who is to make way, if anybody newly is. Takes some 50 ms where robots have met."""
        return self._right_of_way.decide(standings, now_s)

    def told(self, decided: Yielding, now_s: float) -> Sequence[tuple[str, MakeWay]]:
        """What is to be told to which robots."""
        left_s = decided.until_s - now_s
        z = self._poses[decided.robot].base[2]
        frame = self._frames[decided.robot]
        way = [WayPoint(x=x, y=y) for x, y in (frame.to_robot(*each) for each in decided.way)]
        return [
            (decided.robot, self._told(decided.robot, decided.other, way, z, left_s)),
            (decided.other, self._told(decided.other, decided.robot, [], z, left_s)),
        ]

    def rests(self, robot: str) -> bool:
        """Whether it has nothing to do, so that it is sent elsewhere to make way."""
        return self._occupation(robot).rests

    def place_to_rest(self, decided: Yielding, standings: Standings) -> str | None:
        """Where a robot goes that rests where another one comes: near its bay, and free.

        As `FLOOR/PLACE`; None where robots are sent to no such place.
        """
        other, floor = standings[decided.other], standings[decided.robot].floor
        own_m = standings[decided.robot].radius_m + _OFF_WAY_M
        taken = [
            (e.at, own_m + e.radius_m)
            for n, e in standings.items()
            if n != decided.robot and e.floor == floor
        ]
        taken += [((x, y), own_m + other.radius_m) for x, y in sampled(other.way).tolist()]
        free = [
            (math.dist((place.x, place.y), decided.way[-1]), f"{floor}/{name}")
            for name, place in self._building.floors[floor].places.items()
            if f"{floor}/{name}" in self._reachable
            and all(math.dist((place.x, place.y), at) >= away_m for at, away_m in taken)
        ]
        return min(free, default=(0.0, None))[1]

    def take_back(self, decided: Yielding, now_s: float) -> None:
        """Nobody makes way after all."""
        self._right_of_way.take_back(decided, now_s)

    # --- Within -------------------------------------------------------------------------------

    def _stands(self, robot: str) -> bool:
        """Whether it has not got on for a while."""
        poses = self._poses[robot]
        stood = poses.time >= self._since_s[robot] + PATIENCE_S
        return bool(poses.barred) and stood and self._base_of(robot) is not None

    def _told(
        self, robot: str, other: str, way: list[WayPoint], z: float, left_s: float
    ) -> MakeWay:
        """In a robot's own clock."""
        until = self._poses[robot].time + left_s
        return MakeWay(other=other, way=way, z=z, until=until)

    def _standing(self, robot: str, floor: str, at: Point, *, near: bool) -> Standing:
        base, barred = self._base_of(robot), self._poses[robot].barred
        widest = base or self._widest()
        stands = Standing(floor, at, widest.radius_m, widest.speed_m_s)
        if not near:
            return stands
        occupation, knows = self._occupation(robot), base is not None and barred is not None
        if occupation.goal is None:
            return replace(stands, may_move=occupation.rests)
        way = self._way(floor, at, occupation.goal, self._ways_of(widest))
        if not barred and way and math.dist(at, way[-1]) < THERE_M:
            return replace(stands, may_move=knows)
        return replace(stands, way=way, may_move=knows, barred=self._stands(robot))

    def _widest(self) -> BaseLimits:
        """What is reckoned of a robot that has not said how wide it is."""
        told = [base for each in self._poses if (base := self._base_of(each)) is not None]
        return max(told, key=lambda each: each.radius_m)

    def _ways_of(self, base: BaseLimits) -> FloorWays:
        key = base.speed_m_s, base.radius_m + _SPARE_M
        if key not in self._ways:
            self._ways[key] = FloorWays(self._building, Frame(), *key)
        return self._ways[key]

    def _way(self, floor: str, at: Point, goal: str, ways: FloorWays) -> list[Point]:
        """What is left of the way to a place on this floor; empty where there is none."""
        to_floor, place = goal.split("/", 1)
        there = self._building.floors[to_floor]
        here = BasePose(*at, 0.0, self._building.floors[floor].height)
        to = BasePose(there.places[place].x, there.places[place].y, 0.0, there.height)
        try:
            if floor != to_floor:
                ride = ways.rides(here, to)[0]
                to = ride.wait_at or ride.inside
            return _left_of([at, *ways.path(here, to)], at)
        except CommandError:
            return []


def _left_of(way: list[Point], at: Point) -> list[Point]:
    """What is left of a way for who is on it: ways that are laid out anew lead to a place first."""
    points = sampled(way)
    on_it = np.flatnonzero(np.hypot(*(points - at).T) < ON_WAY_M)
    return [at, *((x, y) for x, y in points[on_it[-1] :].tolist())]
