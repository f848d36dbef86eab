"""How one gets from anywhere on a floor to its lanes."""

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from mend.maps.building.cabin import CABIN_M, cabin_walls
from mend.maps.building.clearance import distances_m, is_clear
from mend.maps.building.crossing import crossed_by
from mend.maps.building.floor_grid import (
    CELL_M,
    FloorGrid,
    Matrix,
    Point,
    Reach,
    sampled,
    straightened,
)
from mend.maps.navigation import NavigationGraph, Place
from mend.robots.base.floor_room import FloorRoom
from mend.robots.execution.command_error import CommandError

_LEAST_M = 2 * CELL_M
"""Nearer to a wall cells do not tell on which side of it they are."""
_ROUNDING_M = 1e-6
_EVERY_M = 0.15


@dataclass(frozen=True, slots=True)
class LaneAccess:
    """A place of the graph, and the corners of the way to it: none where that is straight."""

    place: Place
    corners: Sequence[Point] = ()


def lane_access(
    graph: NavigationGraph, room: FloorRoom, point: Point, other: Point | None = None
) -> LaneAccess:
    """How one gets to the lanes of a floor, and to the cabin that either end of a way is in.

    Round corners it is by a lane of the place that is found, from where there is room straight on.
    Raises `CommandError` where no way leads to them.
    """
    cabins = room.cabins_of_others(*([point] if other is None else [point, other]))
    found = nearest_access(point, graph.places, room.walls, cabins, room.needs_m)
    if not found.corners:
        return found
    at = found.place.x_m, found.place.y_m
    onto = [
        each
        for each in _on_lanes(graph, found.place)
        if all(math.dist(each, cabin) >= CABIN_M for cabin in cabins) and room.is_wide(point, each)
    ]
    shortest = min(onto, key=lambda e: math.dist(e, at) + math.dist(e, point), default=None)
    return found if shortest is None else LaneAccess(found.place, (shortest,))


def nearest_access(
    point: Point, places: Collection[Place], walls: Matrix, stops: Sequence[Point], needs_m: float
) -> LaneAccess:
    """The nearest place to which there is room straight on, else the one with the shortest way.

    There is room where all walls (n, 4) and cabins at `stops` keep `needs_m` off, or as much as of
    the point. Ways are found in cells (Dijkstra 1959), within `floor_grid.HALF_M`. Where none is, a
    place will do that no wall is before, also one in a cabin: what is seen there will tell. Raises
    `CommandError` where there is none either.
    """
    outside = [each for each in places if not _is_in_cabin(each, stops)]
    barred = np.concatenate([walls.reshape(-1, 4), *map(cabin_walls, stops)])
    found = (
        _straight_on(point, outside, barred, needs_m)
        or _round_walls(point, outside, barred, needs_m)
        or _straight_on(point, places, walls, 0.0)
    )
    if found is None:
        raise CommandError(f"no way leads from ({point[0]:.2f}, {point[1]:.2f}) to a lane")
    return found


def _on_lanes(graph: NavigationGraph, place: Place) -> Iterator[Point]:
    """Points on the lanes of a place by which one may come to it."""
    for way in graph.ways:
        if place.name in (way.a, way.b) and not way.one_way:
            other = graph.place(way.b if way.a == place.name else way.a)
            ends = [(place.x_m, place.y_m), (other.x_m, other.y_m)]
            yield from ((x, y) for x, y in sampled(ends, _EVERY_M)[1:].tolist())


def _is_in_cabin(place: Place, stops: Sequence[Point]) -> bool:
    return any(math.dist((place.x_m, place.y_m), stop) < CABIN_M for stop in stops)


def _straight_on(
    point: Point, places: Collection[Place], barred: Matrix, needs_m: float
) -> LaneAccess | None:
    keeps_m = min(needs_m, float(distances_m(np.array([point]), barred)[0]))
    for place in sorted(places, key=lambda each: math.dist((each.x_m, each.y_m), point)):
        to = place.x_m, place.y_m
        if not len(crossed_by(np.array([*point, *to]), barred)) and (
            needs_m == 0.0 or is_clear(point, to, barred, keeps_m - _ROUNDING_M)
        ):
            return LaneAccess(place)
    return None


def _round_walls(
    point: Point, places: Collection[Place], barred: Matrix, needs_m: float
) -> LaneAccess | None:
    grid = FloorGrid(point)
    barred_m = grid.away_from_segments(barred)
    keeps_m = min(needs_m, max(_LEAST_M, grid.at(barred_m, point)))
    # What is in a cell may be half of one nearer to a wall: so much farther off, if there is room.
    for needed_m in (keeps_m + CELL_M / 2, keeps_m):
        reach = grid.reach(point, barred_m >= needed_m)
        nearest = _nearest(places, grid, reach)
        if nearest is not None:
            way = grid.way(reach, grid.cell((nearest.x_m, nearest.y_m)))
            corners = straightened(point, way, barred, needed_m - CELL_M / 2)[:-1]
            return LaneAccess(nearest, corners)
    return None


def _nearest(places: Collection[Place], grid: FloorGrid, reach: Reach) -> Place | None:
    """The place with the shortest way; None where none is reached."""

    def far_m(place: Place) -> float:
        at = place.x_m, place.y_m
        return grid.at(reach.metres, at) if grid.is_inside(at) else math.inf

    nearest = min(places, key=far_m, default=None)
    return None if nearest is None or math.isinf(far_m(nearest)) else nearest
