"""The way round what the laser shows: the shortest on a grid around the base.

A dynamic window alone stays in the first pocket; what it steers for is therefore found by a search
of the free space around it (Brock & Khatib 1999, "High-speed navigation using the global dynamic
window approach"), by A*. What was not seen counts as free.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mend.maps.compiled import compiled

Points = NDArray[np.float64]
"""(n, 2), metres."""

CELL_M = 0.05
HALF_M = 4.0
"""The grid reaches so far from the base: beams a degree apart leave no holes in walls that near."""
SPARE_M, TIGHT_M = 0.05, 0.035
"""It keeps so far from everything, more than the window does as cells are imprecise; and no nearer
where there is no other way, or on one that it has taken: noise is not to close that again."""
_SIDE = 2 * round(HALF_M / CELL_M) + 1
_FREE, _CLOSE = 8, 24
"""The weights of a cell in the open and of one beside what it must not touch: thrice as long."""
_ON_WAY = (5, 8)
"""The way that it was given is shorter than any beside it: it is left for a reason only."""
_KEPT = (4, 5)
"""So is the route that it took before: it does not waver between two sides."""
_ON_IT_M = 0.2
"""So near to either it still is on it."""
_STRAIGHT, _DIAGONAL = 5, 7
"""The steps to the next cells, by about a hundredth of a metre."""
_ROOMY = 30
"""Where there is so much room more (in such steps, 0.3 m) it costs nothing more to pass."""
_BUCKETS = 256
"""More than any step makes a way longer."""
_LEAST = _FREE * _ON_WAY[0] * _KEPT[0] // (_ON_WAY[1] * _KEPT[1])
_COST_PER_M = _FREE * _ON_WAY[0] / _ON_WAY[1] * _STRAIGHT / CELL_M
_NEVER = int(np.iinfo(np.int32).max)


@dataclass(frozen=True, slots=True)
class LocalRoute:
    """How far it leads.

    `reached`: which of the targets is the farthest that can be reached, None if none can.
    `carrot`: the point to steer for, straight from here; `way` (k, 2): all of it. `cost_m`: how
    long it is, beside the given way and where there is little room as much longer as that counts.
    """

    reached: int | None
    carrot: tuple[float, float]
    way: Points
    cost_m: float


@dataclass(frozen=True, slots=True, eq=False)
class Ends:
    """Where a route may lead: `targets` (k, 2), to the last rather than to any before it.

    `longest_m` (k,) is how long the routes there may be.
    """

    targets: Points
    longest_m: NDArray[np.float64]


NO_WAY = np.zeros((0, 2))


def find_route(
    here: tuple[float, float],
    points: Points,
    ends: Ends,
    radius_m: float,
    carrot_m: float,
    before: Points,
    spare_m: float = SPARE_M,
) -> LocalRoute:
    """The way to the last of the ends that can be reached by a base of `radius_m`.

    `points` (n, 2) is what is to be kept clear of by `spare_m`; the carrot is at most `carrot_m`
    off. `before` (k, 2) is the way that was found a cycle ago: it is kept unless another is a good
    deal shorter.
    """
    corner = (np.round(np.array(here) / CELL_M) - _SIDE // 2) * CELL_M
    reach_m = HALF_M + radius_m
    near = np.abs(points[:, 0] - here[0]) < reach_m
    near &= np.abs(points[:, 1] - here[1]) < reach_m
    weights = np.empty((_SIDE, _SIDE), np.uint8)
    kept = _marked(before - corner)
    _spread(weights, points[near] - corner, radius_m + spare_m, radius_m + TIGHT_M, kept)
    _prefer(weights, _marked(ends.targets - corner), *_ON_WAY)
    _prefer(weights, kept, *_KEPT)
    cells = np.round((ends.targets - corner) / CELL_M).astype(np.int64)
    passed = np.empty((_SIDE * _SIDE, 2), np.int64)
    found = np.zeros(4, np.int64)
    longest = ends.longest_m * _STRAIGHT / CELL_M
    _search(weights, cells, longest, carrot_m / CELL_M, passed, found)
    reached, count, chosen, cost = (int(each) for each in found)
    if reached < 0:
        return LocalRoute(None, here, NO_WAY, math.inf)
    way = corner + passed[:count] * CELL_M
    way[0] = ends.targets[reached]
    carrot = float(way[chosen, 0]), float(way[chosen, 1])
    return LocalRoute(reached, carrot, way, cost / _COST_PER_M)


@compiled
def _marked(way: Any) -> Any:
    """Which cells lie on a way, or near it."""
    marked = np.zeros((_SIDE, _SIDE), np.uint8)
    reach = int(_ON_IT_M / CELL_M)
    for number in range(way.shape[0]):
        column, row = round(way[number, 0] / CELL_M), round(way[number, 1] / CELL_M)
        for to_row in range(max(0, row - reach), min(_SIDE, row + reach + 1)):
            for to_column in range(max(0, column - reach), min(_SIDE, column + reach + 1)):
                marked[to_row, to_column] = 1
    return marked


@compiled
def _prefer(weights: Any, marked: Any, of: int, parts: int) -> None:
    """Make marked cells shorter, `of` so many `parts` what they were."""
    for row in range(_SIDE):
        for column in range(_SIDE):
            if marked[row, column] != 0:
                weights[row, column] = weights[row, column] * of // parts


@compiled
def _spread(weights: Any, points: Any, blocked_m: float, tight_m: float, kept: Any) -> None:
    """Write how near each cell is to what is blocked, 0 where it is blocked itself."""
    weights[:] = _ROOMY
    _block(weights, points, blocked_m, tight_m, kept)
    _measure_distances(weights)
    by_room = np.empty(_ROOMY + 1, np.uint8)
    by_room[0] = 0
    for away in range(1, _ROOMY + 1):
        by_room[away] = _CLOSE - (_CLOSE - _FREE) * (away - _STRAIGHT) // (_ROOMY - _STRAIGHT)
    for row in range(_SIDE):
        for column in range(_SIDE):
            weights[row, column] = by_room[weights[row, column]]


@compiled
def _block(weights: Any, points: Any, blocked_m: float, tight_m: float, kept: Any) -> None:
    """Write 0 for each cell that is nearer than `blocked_m` to a point.

    Where the base is stays free: what is nearer already it may leave. Cells that are `kept` are
    blocked by what is nearer than `tight_m`.
    """
    middle = (_SIDE // 2) * CELL_M
    begins, ends = _kept_in_rows(kept)
    for number in range(points.shape[0]):
        x, y = points[number, 0], points[number, 1]
        needed = min(blocked_m * blocked_m, (x - middle) ** 2 + (y - middle) ** 2 - 1e-6)
        needed_m = math.sqrt(max(0.0, needed))
        low = max(0, math.ceil((y - needed_m) / CELL_M))
        high = min(_SIDE - 1, math.floor((y + needed_m) / CELL_M))
        for row in range(low, high + 1):
            half_m = math.sqrt(max(0.0, needed - (row * CELL_M - y) ** 2))
            first = max(0, math.ceil((x - half_m) / CELL_M))
            last = min(_SIDE - 1, math.floor((x + half_m) / CELL_M))
            if first > last:
                continue
            if last < begins[row] or first > ends[row]:
                weights[row, first : last + 1] = 0
                continue
            for column in range(first, last + 1):
                if kept[row, column] != 0:
                    square = (column * CELL_M - x) ** 2 + (row * CELL_M - y) ** 2
                    if square >= tight_m * tight_m:
                        continue
                weights[row, column] = 0


@compiled
def _kept_in_rows(kept: Any) -> Any:
    """The first and the last column of each row that is kept; of no column, _SIDE and -1."""
    begins, ends = np.full(_SIDE, _SIDE), np.full(_SIDE, -1)
    for row in range(_SIDE):
        for column in range(_SIDE):
            if kept[row, column] != 0:
                begins[row], ends[row] = min(begins[row], column), column
    return begins, ends


@compiled
def _measure_distances(cells: Any) -> None:
    """The chamfer distance of each cell to the nearest that is 0 (Borgefors 1986)."""
    side = cells.shape[0]
    for row in range(side):
        if row > 0:
            _measure_from(cells[row], cells[row - 1])
        for column in range(1, side):
            cells[row, column] = min(cells[row, column], cells[row, column - 1] + _STRAIGHT)
    for row in range(side - 1, -1, -1):
        if row < side - 1:
            _measure_from(cells[row], cells[row + 1])
        for column in range(side - 2, -1, -1):
            cells[row, column] = min(cells[row, column], cells[row, column + 1] + _STRAIGHT)


@compiled
def _measure_from(cells: Any, beside: Any) -> None:
    """The distances in a row by those in the row beside it: cell by cell, whatever their order."""
    last = cells.shape[0] - 1
    cells[0] = min(cells[0], beside[0] + _STRAIGHT, beside[1] + _DIAGONAL)
    for column in range(1, last):
        diagonal = min(beside[column - 1], beside[column + 1]) + _DIAGONAL
        cells[column] = min(cells[column], beside[column] + _STRAIGHT, diagonal)
    cells[last] = min(cells[last], beside[last] + _STRAIGHT, beside[last - 1] + _DIAGONAL)


@compiled
def _line_cost(weights: Any, column: int, row: int) -> float:
    """What the straight line from the middle to a cell costs; -1 where it is blocked."""
    middle = weights.shape[0] // 2
    across, along = column - middle, row - middle
    steps = 2 * max(abs(across), abs(along))
    total = 0.0
    for number in range(1, steps + 1):
        share = number / steps
        weight = weights[round(middle + share * along), round(middle + share * across)]
        if weight == 0:
            return -1.0
        total += weight
    length = math.sqrt(float(across * across + along * along))
    costs: float = total / max(steps, 1) * length * _STRAIGHT
    return costs


@compiled
def _least_cost(rows: int, columns: int) -> int:
    """What the way between two cells costs in the open."""
    far, near = max(abs(rows), abs(columns)), min(abs(rows), abs(columns))
    return _LEAST * (_STRAIGHT * (far - near) + _DIAGONAL * near)


@compiled
def _settle(weights: Any, wanted: int, costs: Any, lengths: Any, parents: Any) -> None:
    """A* from the middle, until `wanted` is settled; costs of what is not are _NEVER.

    What waits is in buckets by what the whole way costs at least.
    """
    side = weights.shape[0]
    size = side * side
    heads = np.full(_BUCKETS, -1, np.int32)
    following, cells = np.empty(8 * size + 1, np.int32), np.empty(8 * size + 1, np.int32)
    tentative = np.full(size, _NEVER, np.int32)
    flat = weights.ravel()
    wanted_row, wanted_column = wanted // side, wanted % side
    start = (side // 2) * side + side // 2
    tentative[start], cells[0], following[0] = 0, start, -1
    lengths[start] = 0
    least = _least_cost(side // 2 - wanted_row, side // 2 - wanted_column)
    heads[least % _BUCKETS] = 0
    entries, waiting = 1, 1
    while waiting > 0:
        entry = heads[least % _BUCKETS]
        if entry < 0:
            least += 1
            continue
        heads[least % _BUCKETS] = following[entry]
        waiting -= 1
        cell = cells[entry]
        if costs[cell] != _NEVER:
            continue
        cost = tentative[cell]
        costs[cell] = cost
        if cell == wanted:
            return
        row, column = cell // side, cell % side
        for down in range(-1, 2):
            for right in range(-1, 2):
                to_row, to_column = row + down, column + right
                if to_row < 0 or to_row >= side or to_column < 0 or to_column >= side:
                    continue
                to = to_row * side + to_column
                if flat[to] == 0 or costs[to] != _NEVER:
                    continue
                step = _DIAGONAL if down != 0 and right != 0 else _STRAIGHT
                passed = cost + step * flat[to]
                if passed < tentative[to]:
                    tentative[to], parents[to] = passed, cell
                    lengths[to] = lengths[cell] + step
                    whole = passed + _least_cost(to_row - wanted_row, to_column - wanted_column)
                    cells[entries], following[entries] = to, heads[whole % _BUCKETS]
                    heads[whole % _BUCKETS] = entries
                    entries += 1
                    waiting += 1


@compiled
def _search(
    weights: Any, targets: Any, longest: Any, carrot: float, passed: Any, found: Any
) -> None:
    """The kernel of `find_route`: the cells of the way go to `passed`, from its end.

    To `found`: the target, how many cells, which of them to steer for, and what the way costs.
    """
    side = weights.shape[0]
    wanted = -1
    for number in range(targets.shape[0]):
        column, row = targets[number, 0], targets[number, 1]
        inside = column >= 0 and column < side and row >= 0 and row < side
        if inside and weights[row, column] != 0:
            wanted = row * side + column
    costs = np.full(side * side, _NEVER, np.int32)
    parents = np.full(side * side, -1, np.int32)
    lengths = np.zeros(side * side, np.int32)
    if wanted >= 0:
        _settle(weights, wanted, costs, lengths, parents)
    found[0], found[2] = -1, -1
    cell = -1
    for number in range(targets.shape[0]):
        column, row = targets[number, 0], targets[number, 1]
        inside = column >= 0 and column < side and row >= 0 and row < side
        if not inside:
            continue
        at = row * side + column
        if costs[at] != _NEVER and lengths[at] <= longest[number]:
            cell = at
            found[0], found[3] = number, costs[cell]
    middle = side // 2
    count = 0
    while cell >= 0:
        column, row = cell % side, cell // side
        passed[count, 0], passed[count, 1] = column, row
        away = math.sqrt(float((column - middle) ** 2 + (row - middle) ** 2))
        if found[2] < 0 and away <= carrot:
            straight = _line_cost(weights, column, row)
            if straight >= 0.0 and straight <= costs[cell] + _FREE * _STRAIGHT:
                found[2] = count
        count += 1
        cell = parents[cell]
    found[1] = count
