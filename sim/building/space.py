"""What stands where on the floors of a building, and where there is room among it."""

import math

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.building import Building
from mend.maps.building.clearance import clearance_m, distances_m
from mend.maps.building.crossing import crossed_by
from mend.maps.building.wall_ends import wall_ends
from mend.sim.building.barriers import Barriers
from mend.sim.building.building_robot import BuildingRobot
from mend.sim.building.bystander import RADIUS_M as PERSON_RADIUS_M
from mend.sim.building.crowd import Crowd
from mend.sim.building.doors import WorldDoors
from mend.sim.building.elevator_bank import ElevatorBank
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.furniture import Furniture
from mend.sim.building.social_force import KEEP_M
from mend.sim.building.stacked import StackedRows
from mend.sim.building.touching import touches_any

Matrix = NDArray[np.float64]

_BESIDE_M, _DIRECTIONS = (1.0, 1.3, 1.6), 16
_WALL_M = 0.08
"""So thick is a wall where it ends."""
_OFF_LANES_M = 0.8
"""So far from a place, and from lanes where there is room, stands who waits for a robot."""


class Space:
    """Walls, doors, cabins, furniture and barriers, with a crowd among them."""

    def __init__(
        self,
        building: Building,
        doors: WorldDoors,
        barriers: Barriers,
        elevators: ElevatorBank,
        furniture: Furniture,
        crowd: Crowd,
    ) -> None:
        self._building, self._doors, self._barriers = building, doors, barriers
        self._elevators, self._furniture, self._crowd = elevators, furniture, crowd
        self._ends: dict[str, Matrix] = {}
        self._all, self._seen = StackedRows(), StackedRows()

    def segments(self, floor: str) -> Matrix:
        """Walls, shut doors, cabins, furniture and barriers (n, 4)."""
        cabins = self._elevators.walls(floor)
        if floor not in self._building.floors:
            return cabins
        parts = (
            self._building.floors[floor].wall_segments,
            self._doors.shut(floor),
            cabins,
            self._furniture.segments(floor),
            self._barriers.segments(floor),
        )
        return self._all.of(floor, parts)

    def seen_by_lasers(self, floor: str) -> Matrix:
        """The same, and the ends of walls: who stands in line with a wall sees how thick it is."""
        if floor not in self._building.floors:
            return self.segments(floor)
        if floor not in self._ends:
            walls = self._building.floors[floor].wall_segments
            self._ends[floor] = wall_ends(walls, _WALL_M)
        return self._seen.of(floor, (self.segments(floor), self._ends[floor]))

    def touches(self, at: FloorPose, radius_m: float, but: BuildingRobot | None = None) -> bool:
        """Whether something round would touch anything there."""
        around = self._crowd.circles(at.floor, but)
        if any(math.hypot(x - at.x, y - at.y) < radius + radius_m for x, y, radius in around):
            return True
        return bool(touches_any(self.segments(at.floor), at.x, at.y, radius_m))

    def stands_in(self, floor: str, segments: Matrix) -> bool:
        """Whether a robot or a person is where something is to be put."""
        return any(
            distances_m(np.array([[x, y]]), segments)[0] < radius_m
            for x, y, radius_m in self._crowd.circles(floor)
        )

    def sees(self, a: FloorPose, b: FloorPose) -> bool:
        """Whether nothing stands between two points of a floor."""
        return not len(crossed_by(np.array([a.x, a.y, b.x, b.y]), self.segments(a.floor)))

    def room_beside(
        self,
        place: FloorPose,
        radius_m: float = PERSON_RADIUS_M,
        who: BuildingRobot | None = None,
    ) -> FloorPose | None:
        """Where somebody may stand who is at a place, off the lanes if there is room."""
        walls, lanes = self.segments(place.floor), self._lanes(place.floor)
        free = []
        for away_m in _BESIDE_M:
            for turn in np.arange(_DIRECTIONS) * math.tau / _DIRECTIONS:
                x, y = place.x + away_m * math.cos(turn), place.y + away_m * math.sin(turn)
                at = FloorPose(place.floor, x, y)
                seen = clearance_m((place.x, place.y), (x, y), walls) > 2.0 * KEEP_M
                in_cabin = self._elevators.is_in_a_cabin(place.floor, x, y, radius_m)
                if seen and not in_cabin and not self.touches(at, radius_m + KEEP_M, who):
                    free.append(at)
        points = np.array([(at.x, at.y) for at in free]).reshape(-1, 2)
        off_m = np.minimum(distances_m(points, lanes), _OFF_LANES_M)
        return free[int(np.argmax(off_m))] if free else None

    def _lanes(self, floor: str) -> Matrix:
        places, lanes = self._building.floors[floor].places, self._building.floors[floor].lanes
        ends = [(places[a], places[b]) for a, b in (each.between for each in lanes)]
        return np.array([(a.x, a.y, b.x, b.y) for a, b in ends], np.float64).reshape(-1, 4)
