"""Where on a vector map a robot can drive, and shortest ways through it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt, label
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from mend.errors import WrongInputError
from mend.maps.ray_cast import cast
from mend.maps.vector_map import VectorMap

CELL_M = 0.15
_MARGIN_M = 1.0
_WALL_COST = 4.0
"""How many times dearer driving at the least clearance is than driving in the open."""
_WALL_COST_DECAY_M = 0.3
_FARTHEST_WALL_M = 3.5
"""Robots of buildings do not drive where nothing is near: a laser would see nothing there."""
_PROBE_EVERY_M = 0.9
_PROBE_RAYS = 24
_PROBE_REACH_M = 25.0
_INDOORS = 0.85
"""Inside a building is where this share of all directions ends at a wall."""


@dataclass(frozen=True, slots=True)
class FreeSpace:
    """The largest connected indoor area with enough clearance, as a graph of cells."""

    centers: NDArray[np.float64]
    """(n, 2) metres in the map's frame."""
    graph: csr_matrix

    def way(self, start: int, generator: np.random.Generator, tries: int = 30) -> NDArray[np.int64]:
        """Cells from one to a far one: the farthest of some drawn at random."""
        drawn = generator.integers(len(self.centers), size=tries)
        away = np.hypot(*(self.centers[drawn] - self.centers[start]).T)
        goal = int(drawn[away.argmax()])
        _, before = dijkstra(self.graph, indices=start, return_predecessors=True)
        cells = [goal]
        while cells[-1] != start:
            cells.append(int(before[cells[-1]]))
        return np.array(cells[::-1], dtype=np.int64)


def free_space(vector_map: VectorMap, clearance_m: float) -> FreeSpace:
    """Raises `WrongInputError` where no room is left on the map."""
    distance, origin = distance_grid(vector_map, CELL_M)
    free = (distance > clearance_m) & (distance < _FARTHEST_WALL_M)
    free &= _indoors(vector_map, free, origin)
    areas, _ = label(free, np.ones((3, 3)))
    sizes = np.bincount(areas.ravel())
    sizes[0] = 0
    if not sizes.max():
        raise WrongInputError(
            f"the vector map has no closed area with {clearance_m:g} m of clearance to drive in"
        )
    inside = areas == sizes.argmax()
    rows, columns = np.nonzero(inside)
    centers = np.column_stack((columns, rows)) * CELL_M + origin + CELL_M / 2.0
    return FreeSpace(centers, _graph(inside, distance - clearance_m))


def _indoors(
    vector_map: VectorMap, free: NDArray[np.bool_], origin: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Which cells have walls nearly all around; decided for blocks of cells."""
    block = round(_PROBE_EVERY_M / CELL_M)
    angles = np.linspace(0.0, 2.0 * np.pi, _PROBE_RAYS, endpoint=False)
    inside = np.zeros_like(free)
    for row in range(0, free.shape[0], block):
        for column in range(0, free.shape[1], block):
            cells = np.argwhere(free[row : row + block, column : column + block])
            if not len(cells):
                continue
            # A free cell in the middle stands for its block: its center may be within a wall.
            down, right = cells[len(cells) // 2]
            x, y = np.array([column + right, row + down]) * CELL_M + origin + CELL_M / 2.0
            _, hit = cast(vector_map.segments, float(x), float(y), angles, _PROBE_REACH_M)
            if np.mean(hit >= 0) >= _INDOORS:
                inside[row : row + block, column : column + block] = True
    return inside


def distance_grid(
    vector_map: VectorMap, cell_m: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Metres from each cell to the nearest segment, and the corner (x, y) of the first cell."""
    x_min, y_min, x_max, y_max = vector_map.bounds
    origin = np.array([x_min, y_min]) - _MARGIN_M
    width = int(np.ceil((x_max - x_min + 2 * _MARGIN_M) / cell_m)) + 1
    height = int(np.ceil((y_max - y_min + 2 * _MARGIN_M) / cell_m)) + 1
    taken = np.zeros((height, width), dtype=bool)
    for (x0, y0, x1, y1), length in zip(vector_map.segments, vector_map.lengths, strict=True):
        along = np.linspace(0.0, 1.0, int(length / cell_m * 3) + 2)
        columns = ((x0 + along * (x1 - x0) - origin[0]) / cell_m).astype(int)
        rows = ((y0 + along * (y1 - y0) - origin[1]) / cell_m).astype(int)
        taken[rows, columns] = True
    distance: NDArray[np.float64] = distance_transform_edt(~taken) * cell_m
    return distance, origin


def _graph(inside: NDArray[np.bool_], spare_m: NDArray[np.float64]) -> csr_matrix:
    """Cells joined to their eight neighbours; near walls a metre costs more."""
    number = np.full(inside.shape, -1)
    number[inside] = np.arange(inside.sum())
    cost = 1.0 + _WALL_COST * np.exp(-np.maximum(spare_m, 0.0) / _WALL_COST_DECAY_M)
    height, width = inside.shape
    starts, ends, costs = [], [], []
    for down, right in ((0, 1), (1, 0), (1, 1), (1, -1)):
        left = max(-right, 0)
        here = (slice(0, height - down), slice(left, width - max(right, 0)))
        there = (slice(down, height), slice(left + right, width - max(right, 0) + right))
        joined = inside[here] & inside[there]
        starts.append(number[here][joined])
        ends.append(number[there][joined])
        length = CELL_M * np.hypot(down, right)
        costs.append(length * 0.5 * (cost[here][joined] + cost[there][joined]))
    a, b, c = np.concatenate(starts), np.concatenate(ends), np.concatenate(costs)
    count = int(inside.sum())
    return csr_matrix((np.r_[c, c], (np.r_[a, b], np.r_[b, a])), shape=(count, count))
