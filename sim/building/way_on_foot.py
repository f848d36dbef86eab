"""How people get round what stands between them and where they want to be."""

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.clearance import is_clear
from mend.maps.building.floor_grid import CELL_M, FloorGrid
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
    free = grid.away_from_segments(segments) >= RADIUS_M + KEEP_M
    near_goal = grid.away_from_point(goal)
    reach = grid.reach(start, free)
    row, column = np.unravel_index(int(np.argmin(near_goal)), near_goal.shape)
    if near_goal[row, column] > CELL_M or not np.isfinite(reach.metres[row, column]):
        return []
    cells = grid.way(reach, (int(row), int(column)))
    way, here = list[Point](), start
    for number, cell in enumerate(cells):
        last = number + 1 == len(cells)
        if last or not is_clear(here, cells[number + 1], segments, RADIUS_M + KEEP_M / 2):
            way.append(cell)
            here = cell
    return way
