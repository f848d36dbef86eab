"""Somebody who now and then carries a robot elsewhere: its wheels do not measure that."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from mend.maps.building.building import Building, Floor, FloorPlace, PlaceKind
from mend.sim.building.building_robot import BuildingRobot
from mend.sim.building.floor_pose import FloorPose

_TRIES_TO_PUT_DOWN = 20
_SPARE_M = 0.3
"""So much room is left all round where a robot is put down."""


class Carrying:
    """When somebody carries a robot next, and to where; drawn by the world's generator."""

    def __init__(self, every_s: float, rng: np.random.Generator) -> None:
        """About every so many seconds; never if 0."""
        self._every_s = every_s
        self._rng = rng
        self.due_s: float | None = every_s or None

    def is_due(self, time_s: float) -> bool:
        """Whether somebody carries a robot now; if so, it is some time until the next one."""
        if self.due_s is None or time_s < self.due_s:
            return False
        self.due_s += self._every_s * float(self._rng.uniform(0.5, 1.5))
        return True

    def carry_one(
        self,
        robots: Sequence[BuildingRobot],
        building: Building,
        touches: Callable[[FloorPose, float, BuildingRobot], bool],
    ) -> bool:
        """Lift a robot that drives, and put it down elsewhere, if there is room."""
        driving = [e for e in robots if e.moving and e.at.floor in building.floors]
        if not driving:
            return False
        robot = driving[int(self._rng.integers(len(driving)))]
        places = _within_reach(building.floors[robot.at.floor])
        for _ in range(_TRIES_TO_PUT_DOWN if places else 0):
            to = self._draw(robot.at.floor, places)
            if not touches(to, robot.radius_m + _SPARE_M, robot):
                robot.stand(to)
                return True
        return False

    def _draw(self, floor: str, places: Sequence[FloorPlace]) -> FloorPose:
        """At one of the places, turned somehow."""
        place = places[int(self._rng.integers(len(places)))]
        yaw = float(self._rng.uniform(-math.pi, math.pi))
        return FloorPose(floor, place.x, place.y, yaw)


def _within_reach(floor: Floor) -> list[FloorPlace]:
    """Where people can put a robot: a shaft is shut while its cabin is elsewhere."""
    return [each for each in floor.places.values() if each.kind is not PlaceKind.ELEVATOR]
