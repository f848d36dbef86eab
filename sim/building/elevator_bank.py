"""The elevators of a building: where their cabins are, and who is in them."""

import math
from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from mend.documents.strict_model import StrictModel
from mend.maps.building.building import Building, Caller
from mend.maps.building.cabin import CABIN_M, CORNER_M, cabin_walls, stop_of
from mend.robots.base.ways import Ride
from mend.sim.building.building_robot import BuildingRobot
from mend.sim.building.cabin import Cabin, CabinState, Call
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.stacked import StackedRows

Circle = tuple[float, float, float]
Point = tuple[float, float]
Matrix = NDArray[np.float64]

_AHEAD_S = 0.3
"""A door sees so far ahead who comes by, beside what they need to stop."""


class Rider(Protocol):
    """Who may ride in a cabin: a robot, or a person with one."""

    @property
    def at(self) -> FloorPose: ...

    @property
    def radius_m(self) -> float: ...

    @property
    def moving(self) -> bool: ...

    def ride(self, room: str) -> None:
        """Be in a cabin that is shut."""
        ...

    def get_out_at(self, floor: str, shift: tuple[float, float]) -> None:
        """Be on a floor, where a shaft is so much shifted (metres)."""
        ...


class CabinSnapshot(StrictModel):
    """What a cabin is rebuilt from; calls are robot, from, wanted, pressed."""

    floor: str
    state: CabinState
    since_s: float
    until_s: float
    heading_for: str | None
    calls: list[tuple[int, str, str, str | None]]
    misdirected: bool = False


class ElevatorBank:
    """All elevators. Who is in a cabin that is shut is on no floor, but in its `room`."""

    def __init__(self, building: Building) -> None:
        order = list(building.floors)
        self._building = building
        self.cabins: Mapping[str, Cabin] = {
            name: Cabin(name, plan, order, min(plan.stops, key=order.index))
            for name, plan in building.document.elevators.items()
        }
        self._stacked = StackedRows()
        self._walls = {
            (name, floor): cabin_walls(stop_of(building, name, floor))
            for name, each in self.cabins.items()
            for floor in each.plan.stops
        }
        self._stops = {
            name: {floor: stop_of(building, name, floor) for floor in each.plan.stops}
            for name, each in self.cabins.items()
        }
        self._heading: dict[int, str] = {}
        """The elevator to which each robot is on its way, by their numbers."""

    # --- Where things are ---------------------------------------------------------------------

    @staticmethod
    def room(elevator: str) -> str:
        """What stands for the floor of who is in a cabin that is shut: no floor has a slash."""
        return f"/{elevator}"

    def height_m(self, floor: str, time_s: float) -> float:
        """The height of a floor, or of the cabin that it stands for."""
        if not floor.startswith("/"):
            return self._building.floors[floor].height
        cabin, floors = self.cabins[floor[1:]], self._building.floors
        begin_m = floors[cabin.floor].height
        if cabin.heading_for is None:
            return begin_m
        end_m = floors[cabin.heading_for].height
        return begin_m + cabin.share_of_way(time_s) * (end_m - begin_m)

    def walls(self, floor: str) -> Matrix:
        """The walls of cabins on a floor (n, 4); an open one has none."""
        rows = [
            self._walls[name, cabin.floor if floor == self.room(name) else floor]
            for name, cabin in self.cabins.items()
            if (stops := self._stops[name])
            and (floor == self.room(name) or (floor in stops and not cabin.is_open_at(floor)))
        ]
        return self._stacked.of(floor, rows)

    def is_in_a_cabin(self, floor: str, x: float, y: float, radius_m: float) -> bool:
        """Whether something round there would be in the room of any cabin."""
        return any(
            floor in stops and math.dist(stops[floor], (x, y)) < CORNER_M + radius_m
            for stops in self._stops.values()
        )

    # --- Time ---------------------------------------------------------------------------------

    def pass_time(
        self,
        time_s: float,
        robots: Sequence[BuildingRobot],
        led: Mapping[int, Rider],
        circles: Callable[[str], Sequence[Circle]],
    ) -> None:
        """One cycle: cabins move, with whoever is in them; `led`: people, by their robots."""
        for cabin in self.cabins.values():
            inside = [n for n, each in enumerate(robots) if self._is_inside(cabin, each)]
            before, riders = cabin.floor, list[Rider](robots[each] for each in inside)
            with_them = (led[each] for each in inside if each in led)
            riders += [each for each in with_them if self._is_inside(cabin, each)]
            free = self._is_door_free(cabin, riders, circles)
            free = free and not any(self._comes_by(cabin, each) for each in robots)
            cabin.pass_time(time_s, inside, door_is_free=free)
            for rider in riders:
                self._take_along(cabin, rider, before)

    def _take_along(self, cabin: Cabin, rider: Rider, before: str) -> None:
        """Have a rider where its cabin is now; `before` is the floor at which that was."""
        if cabin.state is not CabinState.OPEN:
            rider.ride(self.room(cabin.name))
        elif rider.at.floor != cabin.floor:
            stops = self._stops[cabin.name]
            (x0, y0), (x1, y1) = stops[before], stops[cabin.floor]
            rider.get_out_at(cabin.floor, (x1 - x0, y1 - y0))

    def state(self) -> Hashable:
        """All that cabins do, for comparison."""
        return tuple(each.state_now() for each in self.cabins.values())

    def changes_s(self, time_s: float) -> float:
        """When the next cabin may do something by the clock alone; infinite if none does."""
        times_s = (at_s for each in self.cabins.values() for at_s in each.changes_s())
        return min((each for each in times_s if each > time_s), default=math.inf)

    def stop_around(self, rider: Rider) -> Point | None:
        """The middle of the cabin that somebody is in; None for who is in none."""
        for name, cabin in self.cabins.items():
            if self._is_inside(cabin, rider):
                return self._stops[name][cabin.floor]
        return None

    def _is_inside(self, cabin: Cabin, rider: Rider) -> bool:
        """Whether all of somebody is in a cabin."""
        if rider.at.floor == self.room(cabin.name):
            return True
        away_m = math.dist(self._stops[cabin.name][cabin.floor], (rider.at.x, rider.at.y))
        return cabin.is_open_at(rider.at.floor) and away_m < CABIN_M - rider.radius_m

    def _is_door_free(
        self,
        cabin: Cabin,
        riders: Sequence[Rider],
        circles: Callable[[str], Sequence[Circle]],
    ) -> bool:
        """Whether nobody is in the room of a cabin but who stands in it."""
        x, y = self._stops[cabin.name][cabin.floor]
        within = sum(
            math.dist((x, y), each[:2]) < CORNER_M + each[2] for each in circles(cabin.floor)
        )
        return within <= len(riders) and not any(each.moving for each in riders)

    def _comes_by(self, cabin: Cabin, robot: BuildingRobot) -> bool:
        """Whether a robot drives so near by that it could not stop before a door that shuts."""
        if robot.at.floor != cabin.floor or not robot.moving:
            return False
        speed_m_s = robot.velocity().speed_m_s
        stops_m = speed_m_s**2 / (2.0 * robot.limits.acceleration_m_s2) + _AHEAD_S * speed_m_s
        stop = self._stops[cabin.name][cabin.floor]
        away_m = math.dist(stop, (robot.at.x, robot.at.y))
        return away_m < CORNER_M + robot.radius_m + stops_m

    # --- Who wants what -----------------------------------------------------------------------

    def of_robot(self, number: int) -> "RobotElevators":
        """The elevators as one robot has them."""
        return RobotElevators(self.cabins, self._heading, number)

    def wants_ride(self, number: int) -> bool:
        """Whether a robot wants to ride anywhere."""
        return any(each.call_of(number) is not None for each in self.cabins.values())

    def waits(self, number: int, robot: BuildingRobot) -> list[Cabin]:
        """The elevators for which a robot waits until people press a button."""
        return [
            each
            for each in self.cabins.values()
            if (call := each.call_of(number)) is not None
            and call.to is None
            and (robot.at.floor == call.begin or self._is_inside(each, robot))
        ]

    # --- What it is rebuilt from ----------------------------------------------------------------

    def snapshot(self) -> dict[str, CabinSnapshot]:
        """Where all cabins are, and who wants what."""
        return {
            name: CabinSnapshot(
                floor=each.floor,
                state=each.state,
                since_s=each.since_s,
                until_s=each.until_s,
                heading_for=each.heading_for,
                calls=[(call.robot, call.begin, call.wants, call.to) for call in each.calls],
                misdirected=each.misdirected,
            )
            for name, each in self.cabins.items()
        }

    def restore(self, kept: Mapping[str, CabinSnapshot]) -> None:
        """Raises `ValueError` for other elevators than the building has."""
        if kept.keys() != self.cabins.keys():
            raise ValueError("the snapshot has other elevators than the building")
        for name, each in kept.items():
            cabin = self.cabins[name]
            cabin.floor, cabin.state, cabin.heading_for = each.floor, each.state, each.heading_for
            cabin.since_s, cabin.until_s = each.since_s, each.until_s
            cabin.calls = [Call(*call) for call in each.calls]
            cabin.misdirected = each.misdirected


class RobotElevators:
    """Implements `mend.robots.base.elevators.Elevators` for one robot, by its number."""

    def __init__(self, cabins: Mapping[str, Cabin], heading: dict[int, str], number: int) -> None:
        """`heading`: to which elevator each robot is on its way."""
        self._cabins, self._heading = cabins, heading
        self._number = number

    def ask(self, ride: Ride, *, stay_open: bool = False) -> None:
        self._heading.pop(self._number, None)
        cabin = self._cabins[ride.elevator]
        cabin.call(self._number, ride.from_floor, ride.to_floor, stay_open=stay_open)

    def withdraw(self) -> None:
        self._heading.pop(self._number, None)
        for each in self._cabins.values():
            each.withdraw(self._number)

    def heads_for(self, elevator: str) -> None:
        self._heading[self._number] = elevator

    def waits_s(self) -> Mapping[str, float]:
        return {
            name: self._wait_s(cabin)
            for name, cabin in self._cabins.items()
            if cabin.plan.called_by is Caller.ROBOTS
        }

    def _wait_s(self, cabin: Cabin) -> float:
        """How long those take who have called a cabin, or are to call it, before this robot."""
        mine = cabin.call_of(self._number)
        if mine is not None:
            return sum(cabin.takes_s(each) for each in cabin.calls[: cabin.calls.index(mine)])
        others = sum(
            elevator == cabin.name and number != self._number
            for number, elevator in self._heading.items()
        )
        return sum(map(cabin.takes_s, cabin.calls)) + others * cabin.plan.ride_s

    def is_open_for(self, ride: Ride) -> bool:
        return self._cabins[ride.elevator].is_open_for(self._number, ride.from_floor)
