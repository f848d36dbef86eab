"""How long a base takes from pose to pose of a building if nothing holds it up, rides included."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.building import Building, Door, DoorOpening
from mend.maps.building.cabin import CABIN_M
from mend.maps.building.crossing import crossed_by
from mend.maps.building.trip import Trip, TripRide, TripStage
from mend.robots.base.body import BasePose, DriveLimits
from mend.robots.base.drive_time import drive_s, length_m
from mend.robots.base.floor_ways import FloorWays
from mend.robots.base.ways import Ride
from mend.tasks.frames import Frame

Matrix = NDArray[np.float64]
Point = tuple[float, float]

_SLANT_RAD = 0.1
_SLANTING_S = 0.3
"""Who does not go straight through a door goes slower there: it is hardly wider than need be.

Measured on the ways to elevators that `benchmarks/drive_times.py --steps` printed (--first 1)."""


class TripTime:
    """Knows the trips of one base through a building; poses are in the building's frame."""

    def __init__(
        self,
        building: Building,
        limits: DriveLimits,
        radius_m: float,
        needs_m: float,
        period_s: float,
    ) -> None:
        """`needs_m`: as `FloorWays` has it; `period_s`: of the base's control."""
        self._building = building
        self._ways = FloorWays(building, Frame(), limits.speed_m_s, needs_m)
        self._limits, self._radius_m, self._period_s = limits, radius_m, period_s
        doors = {name: list(each.doors.values()) for name, each in building.floors.items()}
        self._doors = {name: _rows(each) for name, each in doors.items()}
        self._by_people = {
            name: _rows(door for door in each if door.opens is DoorOpening.PEOPLE)
            for name, each in doors.items()
        }

    def trip(self, here: BasePose, to: BasePose) -> Trip:
        """Its stages. Raises `CommandError` where there is no way."""
        stages = []
        for ride in self._ways.rides(here, to):
            waits = ride.wait_at or here
            stages.append(replace(self._stage(here, waits), ride=self._ride(ride)))
            # It has got in backwards, to get out forwards.
            here = replace(ride.there, yaw=ride.inside.yaw)
        return [*stages, self._stage(here, to)]

    def _stage(self, here: BasePose, to: BasePose) -> TripStage:
        """A drive on one floor."""
        way = [(here.x, here.y), *self._ways.path(here, to)] if to != here else []
        floor = self._ways.floor(here) or ""
        legs = [np.array([*a, *b]) for a, b in pairwise(way)]
        by_people = sum(len(crossed_by(leg, self._by_people[floor])) for leg in legs)
        slanting_s = _SLANTING_S * sum(_slanting(leg, self._doors[floor]) for leg in legs)
        lasts_s = self._drive_s(way, here, to) + slanting_s
        return TripStage(lasts_s, length_m(way), by_people)

    def _ride(self, ride: Ride) -> TripRide:
        gets_in_s = 0.0
        if ride.wait_at is not None:
            way = [(each.x, each.y) for each in (ride.wait_at, ride.inside)]
            gets_in_s = self._drive_s(way, ride.wait_at, ride.inside)
        out_m = CABIN_M + self._radius_m
        gets_out_s = math.sqrt(2.0 * out_m / self._limits.acceleration_m_s2)
        return TripRide(ride.elevator, ride.from_floor, ride.to_floor, gets_in_s, gets_out_s)

    def _drive_s(self, way: Sequence[Point], here: BasePose, to: BasePose) -> float:
        return drive_s(way, here.yaw, to.yaw, self._limits, self._period_s)


def _rows(doors: Iterable[Door]) -> Matrix:
    """Doors as rows (n, 4)."""
    return np.array([(*each.posts[0], *each.posts[1]) for each in doors]).reshape(-1, 4)


def _slanting(leg: Matrix, doors: Matrix) -> int:
    """How many doors (n, 4) a leg (4,) does not lead through straight."""
    along = leg[2:] - leg[:2]
    across = doors[crossed_by(leg, doors)]
    turns = np.abs((across[:, 2:] - across[:, :2]) @ along)
    sizes = np.hypot(*(across[:, 2:] - across[:, :2]).T) * np.hypot(*along)
    return int((turns > math.sin(_SLANT_RAD) * sizes).sum())
