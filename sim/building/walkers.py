"""People who walk from room to room, sit there, and step around robots and each other."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.documents.strict_model import StrictModel
from mend.maps.building.building import Building, DoorOpening
from mend.sim.building.building_robot import PERIOD_S, BuildingRobot
from mend.sim.building.bystander import RADIUS_M
from mend.sim.building.door import WorldDoor, open_doors
from mend.sim.building.draws import read_draws, written_draws
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.social_force import KEEP_M, ahead, free_step, pushed
from mend.sim.building.walkways import Point, Walkways

Matrix = NDArray[np.float64]

_SPEEDS_M_S = (0.7, 1.3)
_SITS_S = (10.0, 60.0)
_ARRIVED_M = 0.35
_STUCK_S = 4.0
"""Who needs so much longer than twice the way to the next point goes back."""


class WalkerSnapshot(StrictModel):
    """Who walks: where, how fast (m/s), to which room, along which points; sits until then (s)."""

    floor: str
    at: list[float]
    velocity: list[float]
    speed_m_s: float
    room: str
    way: list[list[float]]
    left: str
    passed: list[list[float]]
    until_s: float
    came_on_s: float


@dataclass(slots=True)
class Walker:
    """`room`: where they sit, or go; `way`: the points still to come, none while they sit.

    `left`, `passed`: the room they come from, and the points since.
    """

    at: FloorPose
    velocity: Point
    speed_m_s: float
    room: str
    way: list[Point]
    left: str
    passed: list[Point]
    until_s: float
    came_on_s: float = 0.0


class Walkers:
    """All who walk in a building; drawn by a generator of their own."""

    def __init__(
        self, building: Building, count: int, doors: Iterable[WorldDoor], seed: int
    ) -> None:
        """So many people in all, as long as there are seats for them."""
        self._rng = np.random.default_rng([seed, 0x3A1C])
        self._doors = [each for each in doors if each.plan.opens is DoorOpening.PEOPLE]
        self._ways: dict[str, Walkways] = {}
        if count:
            self._ways = {name: Walkways(building, name) for name in building.floors}
        self.people: list[Walker] = []
        seats = [(f, room) for f, each in self._ways.items() for room in each.seats]
        for number in self._rng.permutation(len(seats))[:count]:
            floor, room = seats[int(number)]
            at = FloorPose(floor, *self._ways[floor].seats[room])
            speed = float(self._rng.uniform(*_SPEEDS_M_S))
            sits_s = float(self._rng.uniform(0.0, _SITS_S[0]))
            self.people.append(Walker(at, (0.0, 0.0), speed, room, [], room, [], sits_s))

    def leave_room_for(self, starts: Iterable[FloorPose], radius_m: float) -> None:
        """Whoever would be where a robot begins is not there at all."""
        begin = list(starts)
        self.people = [
            each
            for each in self.people
            if all(
                at.floor != each.at.floor
                or math.hypot(at.x - each.at.x, at.y - each.at.y) > radius_m + RADIUS_M + 0.2
                for at in begin
            )
        ]

    def walk(
        self,
        time_s: float,
        robots: Sequence[BuildingRobot],
        others: Iterable[FloorPose],
        segments: Callable[[str], Matrix],
    ) -> None:
        """One cycle; `segments`: what nobody walks through on a floor."""
        standing, walls = list(others), dict[str, Matrix]()
        for each in self.people:
            if not each.way and not self._sets_out(each, time_s):
                continue
            floor = each.at.floor
            if open_doors(self._doors, each.at, time_s) or floor not in walls:
                walls[floor] = segments(floor)
            circles = [*standing, *(e.at for e in self.people if e is not each)]
            around = [
                *((at.x, at.y, RADIUS_M + KEEP_M) for at in circles if at.floor == floor),
                *(c for robot in robots if robot.at.floor == floor for c in ahead(robot)),
            ]
            self._step(each, time_s, np.array(around, np.float64).reshape(-1, 3), walls[floor])

    def changes_s(self, time_s: float) -> float:
        """Until when all of them sit; `time_s` where somebody walks."""
        return min((time_s if each.way else each.until_s for each in self.people), default=math.inf)

    def _sets_out(self, who: Walker, time_s: float) -> bool:
        if time_s < who.until_s:
            return False
        ways = self._ways[who.at.floor]
        there = [each for each in self.people if each.at.floor == who.at.floor]
        taken = {room for each in there for room in (each.room, each.left)}
        free = [each for each in ways.seats if each not in taken]
        who.until_s = time_s + float(self._rng.uniform(*_SITS_S))
        if not free:
            return False
        room = free[int(self._rng.integers(len(free)))]
        way = ways.way(who.room, room)
        if way is None:
            return False
        who.left, who.passed = who.room, [ways.seats[who.room]]
        who.room, who.way, who.came_on_s = room, way, time_s
        return True

    def _step(self, who: Walker, time_s: float, around: Matrix, walls: Matrix) -> None:
        here = np.array([who.at.x, who.at.y])
        goal = np.array(who.way[0])
        if np.hypot(*(goal - here)) < (_ARRIVED_M if len(who.way) > 1 else 0.1):
            who.passed.append(who.way.pop(0))
            if not who.way:
                who.left = who.room
                who.velocity = (0.0, 0.0)
                who.until_s = time_s + float(self._rng.uniform(*_SITS_S))
            who.came_on_s = time_s
            return
        wanted = pushed(np.array(who.velocity), here, goal, who.speed_m_s, around)
        to = free_step(here, wanted, around, walls)
        if to is None:
            who.velocity = (0.0, 0.0)
        else:
            x, y = float(to[0]), float(to[1])
            who.velocity = ((x - who.at.x) / PERIOD_S, (y - who.at.y) / PERIOD_S)
            who.at = FloorPose(who.at.floor, x, y)
        if time_s - who.came_on_s > _STUCK_S + np.hypot(*(goal - here)) / who.speed_m_s * 2.0:
            _turn_back(who, time_s)

    # --- What they are rebuilt from ---

    def snapshot(self) -> list[WalkerSnapshot]:
        return [
            WalkerSnapshot(
                floor=each.at.floor,
                at=[each.at.x, each.at.y],
                velocity=list(each.velocity),
                speed_m_s=each.speed_m_s,
                room=each.room,
                way=[list(point) for point in each.way],
                left=each.left,
                passed=[list(point) for point in each.passed],
                until_s=each.until_s,
                came_on_s=each.came_on_s,
            )
            for each in self.people
        ]

    def draws(self) -> str:
        return written_draws(self._rng)

    def restore(self, people: Iterable[WalkerSnapshot], draws: str) -> None:
        """Raises `ValueError` for draws that no generator wrote."""
        read_draws(self._rng, draws)
        self.people = [
            Walker(
                FloorPose(each.floor, each.at[0], each.at[1]),
                (each.velocity[0], each.velocity[1]),
                each.speed_m_s,
                each.room,
                [(point[0], point[1]) for point in each.way],
                each.left,
                [(point[0], point[1]) for point in each.passed],
                each.until_s,
                each.came_on_s,
            )
            for each in people
        ]


def _turn_back(who: Walker, time_s: float) -> None:
    who.room, who.left = who.left, who.room
    who.way, who.passed = who.passed[::-1], who.way[::-1]
    who.came_on_s = time_s
