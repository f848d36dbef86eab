"""How people get round what stands between them and where they want to be."""

import math

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.clearance import is_clear
from mend.maps.building.floor_grid import FloorGrid, straightened
from mend.sim.building.bystander import RADIUS_M
from mend.sim.building.social_force import KEEP_M

Matrix = NDArray[np.float64]
Point = tuple[float, float]


def may_walk(start: Point, goal: Point, segments: Matrix) -> bool:
    """Whether somebody gets straight to a goal, past what nobody walks through (n, 4)."""
    return is_clear(start, goal, segments, RADIUS_M)


def way_on_foot(start: Point, goal: Point, segments: Matrix) -> list[Point]:
    """The shortest way to a goal on the same floor, without its start; empty where there is none.

    Found in cells (Dijkstra 1959) within `floor_grid.HALF_M` of the start.
    """
    grid = FloorGrid(start)
    reach = grid.reach(start, grid.away_from_segments(segments) >= RADIUS_M + KEEP_M)
    if not grid.is_inside(goal) or not math.isfinite(grid.at(reach.metres, goal)):
        return []
    way = grid.way(reach, grid.cell(goal))
    return straightened(start, way, segments, RADIUS_M + KEEP_M / 2)
