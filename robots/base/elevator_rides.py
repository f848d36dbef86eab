"""The elevators of a building as one robot uses them: where it waits, stands and gets out."""

import math
from collections.abc import Iterator, Sequence

from mend.maps.building.building import Building, Caller
from mend.maps.building.cabin import CABIN_M, stop_of, waiting_points
from mend.maps.building.clearance import is_clear
from mend.maps.navigation import Place
from mend.robots.base.body import BasePose
from mend.robots.base.ways import Ride
from mend.robots.execution.command_error import CommandError
from mend.tasks.frames import Frame

Point = tuple[float, float]

_ASIDE_M = 0.25
"""So far from the middle of a cabin a robot stands with somebody beside it."""


class ElevatorRides:
    """Points are in the building's frame, poses in `frame`, the robot's.

    `needs_m`: so far from its middle a wall has to be; `turn`: which of those who wait it is. `at`:
    the elevator that stops at each place that is a stop.
    """

    def __init__(self, building: Building, frame: Frame, needs_m: float, turn: int) -> None:
        self._building, self._frame = building, frame
        self._needs_m, self._turn = needs_m, turn
        self._waiting: dict[tuple[str, Point], Sequence[Point]] = {}
        self._cabins = [
            (floor, stop_of(building, elevator, floor))
            for elevator, each in building.document.elevators.items()
            for floor in each.stops
        ]
        self.at = {
            f"{floor}/{place}": name
            for name, each in building.document.elevators.items()
            for floor, place in each.stops.items()
        }

    def cabins_on(self, floor: str) -> Iterator[Point]:
        """The middles of the cabins that stop on a floor."""
        return (stop for name, stop in self._cabins if name == floor)

    def cabin_around(self, floor: str, point: Point) -> Point | None:
        """The middle of the cabin that a point of a floor is in; None in none."""
        return next((e for e in self.cabins_on(floor) if math.dist(e, point) < CABIN_M), None)

    def way_out(self, floor: str, stop: Point) -> BasePose:
        """Where to get out of a cabin. Raises `CommandError` where there is no room."""
        out = self._outside(floor, stop)
        return self._pose(floor, out, out)

    def ride(self, begin: str, end: str, after: Place | None) -> Ride:
        """From stop to stop; `after` is where the way leads on from there.

        Raises `CommandError` where there is no room to wait, or to get out.
        """
        from_floor, to_floor = begin.split("/", 1)[0], end.split("/", 1)[0]
        elevator = self.at[begin]
        stop = stop_of(self._building, elevator, from_floor)
        stop_there = stop_of(self._building, elevator, to_floor)
        waits = self._waits(from_floor, stop)
        if not waits:
            raise CommandError(f"there is no room to wait for {elevator} on {from_floor}")
        out = self._outside(to_floor, stop_there) if after is None else (after.x_m, after.y_m)
        wait = waits[self._turn % len(waits)]
        return Ride(
            elevator=elevator,
            from_floor=from_floor,
            to_floor=to_floor,
            wait_at=self._pose(from_floor, wait, stop),
            inside=self._pose(from_floor, stop, wait),
            there=self._pose(to_floor, stop_there, out),
            out_at=self._pose(to_floor, out, out),
            called=self._building.document.elevators[elevator].called_by is Caller.ROBOTS,
            between=(begin, end),
            aside=self._aside(from_floor, stop, wait),
        )

    def _aside(self, floor: str, stop: Point, wait: Point) -> BasePose | None:
        """Beside the middle of a cabin; None where walls leave no room on both sides."""
        away_m, walls = math.dist(stop, wait), self._building.floors[floor].wall_segments
        off = _ASIDE_M * (wait[1] - stop[1]) / away_m, _ASIDE_M * (stop[0] - wait[0]) / away_m
        at, other = ((stop[0] + n * off[0], stop[1] + n * off[1]) for n in (1.0, -1.0))
        if not is_clear(at, other, walls, self._needs_m):
            return None
        return self._pose(floor, at, (at[0] + wait[0] - stop[0], at[1] + wait[1] - stop[1]))

    def _outside(self, floor: str, stop: Point) -> Point:
        waits = self._waits(floor, stop)
        if not waits:
            raise CommandError(f"there is no room to get out on {floor}")
        return waits[self._turn % len(waits)]

    def _waits(self, floor: str, stop: Point) -> Sequence[Point]:
        """Where one may wait for a cabin, computed once."""
        if (floor, stop) not in self._waiting:
            found = waiting_points(self._building.floors[floor], stop, self._needs_m)
            self._waiting[floor, stop] = found
        return self._waiting[floor, stop]

    def _pose(self, floor: str, at: Point, facing: Point) -> BasePose:
        x, y = self._frame.to_robot(*at)
        to_x, to_y = self._frame.to_robot(*facing)
        yaw = math.atan2(to_y - y, to_x - x)
        return BasePose(x, y, yaw, self._building.floors[floor].height)
