"""Ways through a building: along its lanes, by what the robot's map of it says."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.building import Building
from mend.maps.building.clearance import clearance_m
from mend.maps.building.crossing import crossed_by
from mend.maps.navigation import NavigationGraph, Place, WayKind
from mend.robots.base.body import BasePose
from mend.robots.execution.command_error import CommandError
from mend.tasks.frames import Frame

Point = tuple[float, float]

_NEAR_M = 4.0
_SAMPLE_M = 0.15


class FloorWays:
    """`Ways` of one robot, whose base frame is `frame` in the building's; poses are in it.

    `speed_m_s`: as fast as the robot is where nothing says less; `needs_m`: so far from its middle
    a wall has to be where it leaves the lanes. Doors are taken to be open: the robot will see.
    """

    def __init__(self, building: Building, frame: Frame, speed_m_s: float, needs_m: float) -> None:
        self._building = building
        self._frame = frame
        self._speed_m_s = speed_m_s
        self._needs_m = needs_m
        self._walls: dict[str, NDArray[np.float64]] = {}
        self._graphs = {floor: _lanes_of(building, floor) for floor in building.floors}

    def path(self, here: BasePose, to: BasePose) -> Sequence[Point]:
        """The points to pass, the last one the goal's.

        Raises `CommandError` for a goal on another floor, or that no lane leads to.
        """
        floor, goal_floor = self._floor(here), self._floor(to)
        if floor != goal_floor:
            raise CommandError(f"the way from {floor} to {goal_floor} needs an elevator")
        start, goal = self._on_map(here), self._on_map(to)
        points = [start, *self._along_lanes(floor, start, goal), goal]
        if self._is_wide(floor, points[0], points[2]):
            del points[1]
        if len(points) > 2 and self._is_wide(floor, points[-3], points[-1]):
            del points[-2]
        return [self._frame.to_robot(*each) for each in points[1:]]

    def door_at(self, here: BasePose, ahead: Point) -> str | None:
        """The door between a pose and a point ahead."""
        floor = self._building.floors[self._floor(here)]
        way = np.array([*self._on_map(here), *self._frame.to_scene(*ahead)])
        for name, door in floor.doors.items():
            if len(crossed_by(way, np.array([[*door.posts[0], *door.posts[1]]]))):
                return name
        return None

    def walls_near(self, here: BasePose) -> NDArray[np.float64]:
        """Points (n, 2) on the walls around a pose, doors left out."""
        at, points = np.array(self._on_map(here)), self._wall_points(self._floor(here))
        near = points[np.abs(points - at).max(axis=1, initial=0.0) < _NEAR_M]
        return np.array([self._frame.to_robot(x, y) for x, y in near.tolist()]).reshape(-1, 2)

    def _wall_points(self, floor: str) -> NDArray[np.float64]:
        if floor not in self._walls:
            self._walls[floor] = _sampled(self._building.floors[floor].wall_segments)
        return self._walls[floor]

    def _along_lanes(self, floor: str, start: Point, goal: Point) -> list[Point]:
        """From the place that is nearest to the start to the one nearest to the goal."""
        graph = self._graphs[floor]
        first, last = (self._nearest(floor, each) for each in (start, goal))
        path = graph.quickest_path(first, last, self._speed_m_s)
        if not path:
            names = graph.places[first].name, graph.places[last].name
            raise CommandError(f"no lane leads from {names[0]} to {names[1]}")
        places = [graph.places[number] for number, _ in path]
        return [(each.x_m, each.y_m) for each in places]

    def _nearest(self, floor: str, point: Point) -> int:
        """The nearest place that no wall is before. Raises `CommandError`."""
        places, walls = self._graphs[floor].places, self._building.floors[floor].wall_segments
        for number in sorted(range(len(places)), key=lambda each: _away_m(places[each], point)):
            way = np.array([*point, places[number].x_m, places[number].y_m])
            if not len(crossed_by(way, walls)):
                return number
        raise CommandError(f"there are walls all round ({point[0]:.2f}, {point[1]:.2f}) on {floor}")

    def _is_wide(self, floor: str, a: Point, b: Point) -> bool:
        """Whether the straight way is wide enough to leave the lanes for."""
        walls = self._building.floors[floor].wall_segments
        return clearance_m(a, b, walls) >= self._needs_m

    def _floor(self, pose: BasePose) -> str:
        floor = self._building.floor_at(pose.z)
        if floor is None:
            raise CommandError(f"no floor is {pose.z:g} m high")
        return floor

    def _on_map(self, pose: BasePose) -> Point:
        return self._frame.to_scene(pose.x, pose.y)


def _lanes_of(building: Building, floor: str) -> NavigationGraph:
    """The places and lanes of one floor, as if no door were ever locked."""
    prefix = f"{floor}/"
    places = [each for each in building.graph.places if each.name.startswith(prefix)]
    lanes = [
        replace(each, open_s=(), closed=False)
        for each in building.graph.ways
        if each.kind is not WayKind.ELEVATOR and each.a.startswith(prefix)
    ]
    return NavigationGraph(places, lanes)


def _sampled(segments: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points (n, 2) along segments, so close that no base gets through between two."""
    points = [np.zeros((0, 2))]
    for x0, y0, x1, y1 in segments.tolist():
        shares = np.linspace(0.0, 1.0, 2 + int(math.hypot(x1 - x0, y1 - y0) / _SAMPLE_M))
        points.append(np.column_stack([x0 + shares * (x1 - x0), y0 + shares * (y1 - y0)]))
    return np.vstack(points)


def _away_m(place: Place, point: Point) -> float:
    return math.hypot(place.x_m - point[0], place.y_m - point[1])
