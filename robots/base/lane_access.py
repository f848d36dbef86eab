"""How one gets from anywhere on a floor to its lanes."""

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from mend.maps.building.cabin import CABIN_M, cabin_walls
from mend.maps.building.crossing import crossed_by
from mend.maps.building.floor_grid import CELL_M, FloorGrid, Matrix, Point, straightened
from mend.maps.navigation import Place
from mend.robots.execution.command_error import CommandError

_LEAST_M = 2 * CELL_M
"""Nearer to a wall cells do not tell on which side of it they are."""


@dataclass(frozen=True, slots=True)
class LaneAccess:
    """A place of the graph, and the corners of the way to it: none to one in straight sight."""

    place: Place
    corners: Sequence[Point] = ()


def nearest_access(
    point: Point, places: Collection[Place], walls: Matrix, stops: Sequence[Point], needs_m: float
) -> LaneAccess:
    """The nearest place that no wall (n, 4) is before, else the one with the shortest way there.

    That way keeps `needs_m` from walls, or as far as the point is from them, and leads through no
    cabin at `stops`; it is found in cells (Dijkstra 1959), within `floor_grid.HALF_M`. Raises
    `CommandError` where there is none.
    """
    for place in sorted(places, key=lambda each: math.dist((each.x_m, each.y_m), point)):
        if not len(crossed_by(np.array([*point, place.x_m, place.y_m]), walls)):
            return LaneAccess(place)
    found = _round_walls(point, places, _with_cabins(point, walls, stops), needs_m)
    if found is None:
        raise CommandError(f"no way leads from ({point[0]:.2f}, {point[1]:.2f}) to a lane")
    return found


def _with_cabins(point: Point, walls: Matrix, stops: Sequence[Point]) -> Matrix:
    cabins = [cabin_walls(stop) for stop in stops if math.dist(stop, point) >= CABIN_M]
    return np.concatenate([walls.reshape(-1, 4), *cabins])


def _round_walls(
    point: Point, places: Collection[Place], walls: Matrix, needs_m: float
) -> LaneAccess | None:
    grid = FloorGrid(point)
    walls_m = grid.away_from_segments(walls)
    keeps_m = min(needs_m, max(_LEAST_M, grid.at(walls_m, point)))
    reach = grid.reach(point, walls_m >= keeps_m)

    def far_m(place: Place) -> float:
        at = place.x_m, place.y_m
        return grid.at(reach.metres, at) if grid.is_inside(at) else math.inf

    nearest = min(places, key=far_m, default=None)
    if nearest is None or not math.isfinite(far_m(nearest)):
        return None
    way = grid.way(reach, grid.cell((nearest.x_m, nearest.y_m)))
    return LaneAccess(nearest, straightened(point, way, walls, keeps_m - CELL_M / 2)[:-1])
