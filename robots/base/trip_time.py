"""How long a base takes from pose to pose of a building if nothing holds it up, rides included."""

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.building import Building, DoorOpening, Floor
from mend.maps.building.cabin import CABIN_M
from mend.maps.building.crossing import crossed_by
from mend.maps.building.trip import Trip, TripRide, TripStage
from mend.robots.base.body import BasePose, DriveLimits
from mend.robots.base.drive_time import drive_s, length_m
from mend.robots.base.floor_ways import FloorWays
from mend.robots.base.ways import Ride
from mend.tasks.frames import Frame

Point = tuple[float, float]


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
        self._doors = {name: _doors_of_people(each) for name, each in building.floors.items()}

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
        doors = self._doors[self._ways.floor(here) or ""]
        passed = sum(len(crossed_by(np.array([*a, *b]), doors)) for a, b in pairwise(way))
        return TripStage(self._drive_s(way, here, to), length_m(way), passed)

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


def _doors_of_people(floor: Floor) -> NDArray[np.float64]:
    """The doors of a floor that people open, as rows (n, 4)."""
    doors = [each for each in floor.doors.values() if each.opens is DoorOpening.PEOPLE]
    return np.array([(*each.posts[0], *each.posts[1]) for each in doors]).reshape(-1, 4)
