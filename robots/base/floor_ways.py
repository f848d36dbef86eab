"""Ways through a building: along its lanes, by what the robot's map of it says."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.building import Building
from mend.maps.building.crossing import crossed_by
from mend.maps.navigation import Place
from mend.robots.base.body import BasePose
from mend.robots.execution.command_error import CommandError
from mend.tasks.frames import Frame

Point = tuple[float, float]

_ON_FLOOR_M = 0.5


class FloorWays:
    """`Ways` of one robot, whose base frame is `frame` in the building's; poses are in it.

    `speed_m_s`: as fast as the robot is where nothing says less.
    """

    def __init__(self, building: Building, frame: Frame, speed_m_s: float) -> None:
        self._building = building
        self._frame = frame
        self._speed_m_s = speed_m_s
        self._walls = {
            name: np.array(each.walls, np.float64).reshape(-1, 4)
            for name, each in building.floors.items()
        }

    def path(self, here: BasePose, to: BasePose) -> Sequence[Point]:
        """The points to pass, the last one the goal's.

        Raises `CommandError` for a goal on another floor, or that no lane leads to.
        """
        floor, goal_floor = self._floor(here), self._floor(to)
        if floor != goal_floor:
            raise CommandError(f"I am on {floor}, and that is on {goal_floor}")
        start, goal = self._on_map(here), self._on_map(to)
        if self._is_free(floor, start, goal):
            return [(to.x, to.y)]
        points = [start, *self._lanes(floor, start, goal), goal]
        return [self._frame.to_robot(*each) for each in self._cut_short(floor, points)[1:]]

    def door_at(self, here: BasePose, ahead: Point) -> str | None:
        """The door between a pose and a point ahead."""
        floor = self._building.floors[self._floor(here)]
        way = np.array([*self._on_map(here), *self._frame.to_scene(*ahead)])
        for name, door in floor.doors.items():
            if len(crossed_by(way, np.array([[*door.posts[0], *door.posts[1]]]))):
                return name
        return None

    def _lanes(self, floor: str, start: Point, goal: Point) -> list[Point]:
        """From the place that is nearest to the start to the one nearest to the goal."""
        graph = self._building.graph
        numbers = [graph.index(f"{floor}/{name}") for name in self._building.floors[floor].places]
        first, last = (self._nearest(floor, numbers, each) for each in (start, goal))
        path = graph.quickest_path(first, last, self._speed_m_s)
        if not path:
            raise CommandError(
                f"no lane leads from {graph.places[first].name} to {graph.places[last].name}"
            )
        places = [graph.places[number] for number, _ in path]
        if len({each.floor for each in places}) > 1:
            raise CommandError(f"the way to {graph.places[last].name} leads over another floor")
        return [(each.x_m, each.y_m) for each in places]

    def _nearest(self, floor: str, numbers: Sequence[int], point: Point) -> int:
        """The nearest place that no wall is before. Raises `CommandError`."""
        places = self._building.graph.places
        ordered = sorted(numbers, key=lambda each: _distance_m(places[each], point))
        for each in ordered:
            if self._is_free(floor, point, (places[each].x_m, places[each].y_m)):
                return each
        raise CommandError("there are walls between me and every place that I know of here")

    def _cut_short(self, floor: str, points: list[Point]) -> list[Point]:
        """Without going back to where the lanes begin, or beyond where they end."""
        if len(points) > 3 and self._is_free(floor, points[0], points[2]):
            points = [points[0], *points[2:]]
        if len(points) > 3 and self._is_free(floor, points[-3], points[-1]):
            points = [*points[:-2], points[-1]]
        return points

    def _is_free(self, floor: str, a: Point, b: Point) -> bool:
        walls: NDArray[np.float64] = self._walls[floor]
        return not len(crossed_by(np.array([*a, *b]), walls))

    def _floor(self, pose: BasePose) -> str:
        for name, each in self._building.floors.items():
            if abs(each.height - pose.z) < _ON_FLOOR_M:
                return name
        raise CommandError(f"no floor is {pose.z:g} m high")

    def _on_map(self, pose: BasePose) -> Point:
        return self._frame.to_scene(pose.x, pose.y)


def _distance_m(place: Place, point: Point) -> float:
    return math.hypot(place.x_m - point[0], place.y_m - point[1])
