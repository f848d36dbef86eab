"""Ways through a building: along its lanes, and in its elevators, by what the robot's map says."""

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from mend.maps.building.building import Building
from mend.maps.building.cabin import CABIN_M, cabin_walls, elevator_around, stop_of
from mend.maps.building.clearance import clearance_m
from mend.maps.building.crossing import crossed_by
from mend.maps.navigation import NavigationGraph, Place, Way, WayKind
from mend.robots.base.body import BasePose
from mend.robots.base.closed_ways import NO_WAYS, Closed, Lane
from mend.robots.base.elevator_rides import ElevatorRides
from mend.robots.base.floor_room import FloorRoom
from mend.robots.base.lane_access import LaneAccess, lane_access
from mend.robots.base.motion.surroundings import NOTHING, Points
from mend.robots.base.open_door import Posts
from mend.robots.base.ways import NO_WAITS, Ride
from mend.robots.execution.command_error import CommandError
from mend.tasks.frames import Frame

Point = tuple[float, float]

_AROUND_M, _EVERY_M = 6.0, 0.15
_ROUNDING_M = 1e-6
_ON_LANE_M = 0.6
"""Who is farther from a lane is not on it."""
_CLOSED_S = 1e5
"""No way leads by what is closed where there is any other."""
_THROUGH_CABIN_S = 1e10
"""No way leads through a cabin where there is any other, whatever else is closed."""


class FloorWays:
    """`Ways` of one robot, whose base frame is `frame` in the building's; poses are in it.

    `speed_m_s`: as fast as the robot is where nothing says less; `needs_m`: so far from its middle
    a wall has to be where it leaves the lanes; `turn`: which of those who wait for an elevator it
    is. Doors are taken to be open: the robot will see.
    """

    has_places = True

    def __init__(
        self, building: Building, frame: Frame, speed_m_s: float, needs_m: float, turn: int = 0
    ) -> None:
        self._building = building
        self._frame = frame
        self._speed_m_s = speed_m_s
        self._needs_m = needs_m
        self._elevators = ElevatorRides(building, frame, needs_m, turn)
        self._stops = self._elevators.at
        self._walls: dict[str, Points] = {}
        self._all = _without_hours(building, self._stops, lambda _: True)
        self._places = {each.name: each for each in self._all.places}
        self._graphs = {
            floor: _without_hours(building, self._stops, _is_on(floor)) for floor in building.floors
        }

    def path(self, here: BasePose, to: BasePose, closed: Closed = NO_WAYS) -> Sequence[Point]:
        """The points to pass, the last one the goal's.

        Raises `CommandError` for a goal on another floor, or that no lane leads to.
        """
        floor, start, goal = self._on_one_floor(here, to)
        first, last = self._first(floor, start, closed, goal), self._nearest(floor, goal, start)
        places = self._along_lanes(floor, first, last, closed)
        lanes: Sequence[Point] = [(each.x_m, each.y_m) for each in places]
        room = self._room(floor)
        if len(lanes) == 1 and room.is_wide(start, goal):
            return [self._frame.to_robot(*goal)]
        lanes = _onwards(first.corners, lanes)
        lanes = _onwards(last.corners, lanes[::-1])[::-1]
        points = [start, *first.corners, *lanes, *last.corners[::-1], goal]
        if room.is_wide(points[0], points[2]):
            del points[1]
        if len(points) > 2 and room.is_wide(points[-3], points[-1]):
            del points[-2]
        return [self._frame.to_robot(*each) for each in points[1:]]

    def leads_round(self, here: BasePose, to: BasePose, closed: Closed) -> bool:
        """Whether a way leads to a pose on the same floor by nothing that is closed.

        Raises `CommandError` as `path` does.
        """
        floor, start, goal = self._on_one_floor(here, to)
        first, last = self._first(floor, start, closed, goal), self._nearest(floor, goal, start)
        lanes = self._along_lanes(floor, first, last, closed)
        return not any(frozenset((a.name, b.name)) in closed for a, b in pairwise(lanes))

    def rides(
        self,
        here: BasePose,
        to: BasePose,
        closed: Closed = NO_WAYS,
        waits_s: Mapping[str, float] = NO_WAITS,
    ) -> Sequence[Ride]:
        """The rides between two poses, in the order in which they are taken.

        Nobody is asked to call an elevator only because another one takes longer now. Raises
        `CommandError` where there is no way.
        """
        quickest = self._rides(here, to, closed, waits_s)
        if any(waits_s.values()) and not all(each.called for each in quickest):
            return self._rides(here, to, closed, NO_WAITS)
        return quickest

    def _rides(
        self, here: BasePose, to: BasePose, closed: Closed, waits_s: Mapping[str, float]
    ) -> Sequence[Ride]:
        floor, goal_floor = self._floor(here), self._floor(to)
        if floor == goal_floor:
            return ()
        start, goal = self._on_map(here), self._on_map(to)
        if self._elevators.cabin_around(floor, start) is not None:
            waits_s = NO_WAITS
        # Who stands before one elevator may take another.
        begin = self._first(floor, start, closed)
        end = self._nearest(goal_floor, goal)
        graph = self._later(_kept_off(self._all, closed), waits_s)
        path = _named_path(graph, begin.place, end.place, self._speed_m_s)
        rides = []
        for number, (a, b) in enumerate(pairwise(path)):
            if a.floor != b.floor:
                after = path[number + 2] if number + 2 < len(path) else None
                rides.append(self._elevators.ride(a.name, b.name, after))
        first = rides[0]
        inside = math.dist(start, self._frame.to_scene(first.inside.x, first.inside.y))
        return [replace(first, wait_at=None) if inside < CABIN_M else first, *rides[1:]]

    def way_out(self, here: BasePose) -> BasePose | None:
        """Where to get out of the cabin that a pose is in; None where that is in none."""
        floor = self._building.floor_at(here.z)
        if floor is None:
            return None
        stop = self._elevators.cabin_around(floor, self._on_map(here))
        return None if stop is None else self._elevators.way_out(floor, stop)

    def elevator_at(self, pose: BasePose) -> str | None:
        """The elevator in whose cabin a pose of any floor is; None where it is in none."""
        return elevator_around(self._building, *self._on_map(pose), pose.z)

    def floor(self, pose: BasePose) -> str | None:
        """What the floor of a pose is called; None between floors."""
        return self._building.floor_at(pose.z)

    def walls(self, here: BasePose) -> Points:
        """Points of the walls of the floor around a pose, closer together than a base is wide."""
        floor = self._building.floor_at(here.z)
        if floor is None:
            return NOTHING
        if floor not in self._walls:
            self._walls[floor] = _sampled(self._building.floors[floor].wall_segments, self._frame)
        points = self._walls[floor]
        near = np.abs(points[:, 0] - here.x) < _AROUND_M
        return np.asarray(points[near & (np.abs(points[:, 1] - here.y) < _AROUND_M)])

    def door_at(self, here: BasePose, ahead: Point) -> str | None:
        """The door, or the elevator, between a pose and a point ahead."""
        name = self._floor(here)
        floor = self._building.floors[name]
        way = np.array([*self._on_map(here), *self._frame.to_scene(*ahead)])
        for door_name, door in floor.doors.items():
            if len(crossed_by(way, np.array([[*door.posts[0], *door.posts[1]]]))):
                return door_name
        for stop, elevator in self._stops.items():
            if stop.startswith(f"{name}/") and len(
                crossed_by(way, cabin_walls(stop_of(self._building, elevator, name)))
            ):
                return elevator
        return None

    def posts(self, door: str, here: BasePose) -> Posts | None:
        """Where a door of the floor of a pose hangs: of an elevator right across its cabin.

        None for who is in that cabin.
        """
        name = self._floor(here)
        found = self._building.floors[name].doors.get(door)
        posts = self._across_cabin(door, name, here) if found is None else found.posts
        if posts is None:
            return None
        (ax, ay), (bx, by) = posts
        return self._frame.to_robot(ax, ay), self._frame.to_robot(bx, by)

    def _across_cabin(self, elevator: str, floor: str, here: BasePose) -> Posts | None:
        """From side to side of a cabin, through its middle, as who is outside sees it."""
        (x, y), (at_x, at_y) = stop_of(self._building, elevator, floor), self._on_map(here)
        away_m = math.hypot(x - at_x, y - at_y)
        if away_m < CABIN_M:
            return None
        off = CABIN_M * (at_y - y) / away_m, CABIN_M * (x - at_x) / away_m
        return (x - off[0], y - off[1]), (x + off[0], y + off[1])

    def lane_at(self, here: BasePose, ahead: Point) -> tuple[str, str] | None:
        """The ends of the lane that a pose and a point ahead are on, the one behind first."""
        graph = self._graphs[self._floor(here)]
        start, goal = self._on_map(here), self._frame.to_scene(*ahead)
        nearest_m, found = _ON_LANE_M, None
        for way in graph.ways:
            a, b = (graph.places[graph.index(each)] for each in (way.a, way.b))
            ends = (a.x_m, a.y_m), (b.x_m, b.y_m)
            lane = np.array([[*ends[0], *ends[1]]])
            off_m = max(clearance_m(each, each, lane) for each in (start, goal))
            if off_m < nearest_m:
                along = math.dist(ends[0], start) - math.dist(ends[0], goal)
                nearest_m, found = off_m, (way.a, way.b) if along < 0.0 else (way.b, way.a)
        return found

    def together(self, between: tuple[str, str]) -> Collection[Lane]:
        """The ways that are closed with one: of an elevator all its rides."""
        return self._all.together(between)

    def along(self, lane: Lane, here: BasePose) -> Mapping[str, float] | None:
        """How far a pose on a lane is from each of its ends (m); None beside it."""
        floor = self.floor(here)
        if floor is None or not all(each.startswith(f"{floor}/") for each in lane):
            return None
        return self._ends_m(lane, self._on_map(here))

    # --- Within -------------------------------------------------------------------------------

    def _later(self, graph: NavigationGraph, waits_s: Mapping[str, float]) -> NavigationGraph:
        """A graph in which elevators take so much longer."""
        if not any(waits_s.values()):
            return graph

        def now(way: Way) -> Way:
            if way.kind is not WayKind.ELEVATOR:
                return way
            return replace(way, delay_s=way.delay_s + waits_s.get(self._stops[way.a], 0.0))

        return NavigationGraph(graph.places, map(now, graph.ways))

    def _on_one_floor(self, here: BasePose, to: BasePose) -> tuple[str, Point, Point]:
        """The floor, and where both are on it. Raises `CommandError` where it is not one."""
        floor, goal_floor = self._floor(here), self._floor(to)
        if floor != goal_floor:
            raise CommandError(f"the way from {floor} to {goal_floor} needs an elevator")
        return floor, self._on_map(here), self._on_map(to)

    def _along_lanes(
        self, floor: str, first: LaneAccess, last: LaneAccess, closed: Closed
    ) -> Sequence[Place]:
        """The quickest way between two places. Raises `CommandError`."""
        graph = _kept_off(self._graphs[floor], closed)
        places = _named_path(graph, first.place, last.place, self._speed_m_s)
        through = [each.name for each in places[1:-1] if each.name in self._stops]
        if through:
            ends = f"from {first.place.name} to {last.place.name}"
            raise CommandError(f"no lane leads {ends} but through {through[0]}")
        return places

    def _first(
        self, floor: str, start: Point, closed: Closed, goal: Point | None = None
    ) -> LaneAccess:
        """The place that a way begins with: of a lane that was found barred, the one before that.

        Raises `CommandError`.
        """
        for lane, origin in closed.items():
            if origin is not None and origin.startswith(f"{floor}/"):
                ends = self._ends_m(lane, start)
                beyond = next(iter(lane - {origin}), origin)
                if ends is not None and ends[beyond] > _ON_LANE_M:
                    return LaneAccess(self._places[origin])
        return self._nearest(floor, start, goal)

    def _ends_m(self, lane: Lane, point: Point) -> Mapping[str, float] | None:
        """How far a point on a lane is from each of its ends; None beside it."""
        places = [self._places[each] for each in lane if each in self._places]
        if len(places) != 2:
            return None
        (x0, y0), (x1, y1) = ((each.x_m, each.y_m) for each in places)
        if clearance_m(point, point, np.array([[x0, y0, x1, y1]])) >= _ON_LANE_M:
            return None
        return {each.name: _away_m(each, point) for each in places}

    def _nearest(self, floor: str, point: Point, other: Point | None = None) -> LaneAccess:
        """How one gets to the lanes of a floor, and to the cabin that either end of a way is in.

        Raises `CommandError`.
        """
        return lane_access(self._graphs[floor], self._room(floor), point, other)

    def _room(self, floor: str) -> FloorRoom:
        cabins = tuple(self._elevators.cabins_on(floor))
        return FloorRoom(self._building.floors[floor].wall_segments, cabins, self._needs_m)

    def _floor(self, pose: BasePose) -> str:
        floor = self._building.floor_at(pose.z)
        if floor is None:
            raise CommandError(f"no floor is {pose.z:g} m high")
        return floor

    def _on_map(self, pose: BasePose) -> Point:
        return self._frame.to_scene(pose.x, pose.y)


def _sampled(walls: Points, frame: Frame) -> Points:
    """Points of walls (n, 4) of the building, in a robot's frame."""
    points = [np.zeros((0, 2))]
    for x0, y0, x1, y1 in walls:
        count = 2 + int(math.hypot(x1 - x0, y1 - y0) / _EVERY_M)
        points.append(np.linspace((x0, y0), (x1, y1), count))
    placed = [frame.to_robot(x, y) for x, y in np.concatenate(points)]
    return np.array(placed).reshape(-1, 2)


def _is_on(floor: str) -> Callable[[str], bool]:
    return lambda name: name.startswith(f"{floor}/")


def _without_hours(
    building: Building, stops: dict[str, str], among: Callable[[str], bool]
) -> NavigationGraph:
    """The places among some and the ways between them, as if no door were ever locked."""

    def plain(way: Way) -> Way:
        through = way.kind is not WayKind.ELEVATOR and (way.a in stops or way.b in stops)
        delay_s = way.delay_s + (_THROUGH_CABIN_S if through else 0.0)
        return replace(way, open_s=(), closed=False, delay_s=delay_s)

    graph = building.graph
    ways = [plain(each) for each in graph.ways if among(each.a) and among(each.b)]
    return NavigationGraph([each for each in graph.places if among(each.name)], ways)


def _kept_off(graph: NavigationGraph, closed: Closed) -> NavigationGraph:
    """A graph in which what is closed takes longer than all that is not."""
    if not closed:
        return graph

    def now(way: Way) -> Way:
        if frozenset((way.a, way.b)) not in closed:
            return way
        return replace(way, delay_s=way.delay_s + _CLOSED_S)

    return NavigationGraph(graph.places, map(now, graph.ways))


def _named_path(
    graph: NavigationGraph, first: Place, last: Place, speed_m_s: float
) -> Sequence[Place]:
    """The places on the quickest way. Raises `CommandError`."""
    begin, end = graph.index(first.name), graph.index(last.name)
    path = graph.quickest_path(begin, end, speed_m_s)
    if not path:
        raise CommandError(f"no lane leads from {first.name} to {last.name}")
    return [graph.places[number] for number, _ in path]


def _onwards(corners: Sequence[Point], lanes: Sequence[Point]) -> Sequence[Point]:
    """The ends of lanes to pass: who comes out onto the first of them does not go back on it."""
    if not corners or len(lanes) < 2:
        return lanes
    first = np.array([[*lanes[0], *lanes[1]]])
    return lanes[1:] if clearance_m(corners[-1], corners[-1], first) < _ROUNDING_M else lanes


def _away_m(place: Place, point: Point) -> float:
    return math.hypot(place.x_m - point[0], place.y_m - point[1])
