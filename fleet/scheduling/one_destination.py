"""Everything to one destination, no times: a route that drives at most twice what it must.

Whoever carries what: until the last item is there, the ways of the robots together join all pickups
to the destination and to where a robot starts. One robot that walks around such a tree drives it at
most twice. Up to `EXACT_PLACES` pickups its shortest walk is found, so that this holds wherever
items change robots; of more the walk goes around a minimum spanning tree, and it holds where they
change robots only at pickups and at the destination.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from math import inf

import numpy as np

from mend.fleet.scheduling.auction import solve_by_auction
from mend.fleet.scheduling.checker import require_valid
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.problem import Problem, Robot, Window
from mend.fleet.scheduling.schedule import Action, Route, Schedule, Task
from mend.fleet.scheduling.solution import Progress, Solution, Status, UnsupportedError
from mend.fleet.scheduling.timing import Untimeable, earliest_schedule
from mend.fleet.scheduling.tolerance import LENGTH_M, proves
from mend.fleet.scheduling.travel import Matrix

EXACT_PLACES = 10
"""Up to this many different pickups the shortest walk is found."""


def solve_to_one_destination(
    problem: Problem,
    *,
    seconds: float,
    seed: int = 0,
    start: Schedule | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    clock: Callable[[], float],
) -> Solution:
    """One robot's walk around everything, then auctions to share it; never worse than `start`.

    At most twice the optimum; the bound says so. Raises `UnsupportedError` with a sentence where
    the method does not apply.
    """
    why = next(_why_not(problem), None)
    if why is not None:
        raise UnsupportedError(f"the method for one destination does not apply: {why}")
    began_s = clock()
    walk, bound = _walked(problem)
    if start is None or cost(problem, walk).total < cost(problem, start).total:
        start = walk
    if on_progress is not None:
        on_progress(Progress(cost(problem, start).total, bound, clock() - began_s))
    shared = solve_by_auction(
        problem, seconds=seconds - (clock() - began_s), seed=seed, start=start, clock=clock
    )
    assert shared.cost is not None, "it began with a schedule"
    proved = bound is not None and proves(bound, shared.cost.total)
    status = Status.OPTIMAL if proved else Status.FEASIBLE
    return Solution(status, shared.schedule, shared.cost, bound, clock() - began_s)


def _why_not(problem: Problem) -> Iterator[str]:
    """What the method does not know, a sentence each."""
    items = problem.items
    if not items:
        yield "there is no item"
        return
    other = next((i for i in items if i.delivery.place != items[0].delivery.place), None)
    if other is not None:
        yield f"items '{items[0].name}' and '{other.name}' have different destinations"
    for item in items:
        ends = (item.pickup, item.delivery)
        timed = any(end.window != Window() or end.due_s < inf for end in ends)
        if timed or item.max_on_board_s < inf:
            yield f"item '{item.name}' has time constraints"
        if item.aboard is not None:
            yield f"item '{item.name}' is aboard a robot already"
    load = sum(item.load for item in items)
    for robot in problem.robots:
        if robot.shift.latest_s < inf or robot.max_duration_s < inf:
            yield f"robot '{robot.name}' has a shift that ends or a longest duration"
        if robot.end not in (None, robot.start):
            yield f"robot '{robot.name}' must end elsewhere than where it starts"
    if max(robot.capacity for robot in problem.robots) < load:
        yield f"no robot carries everything at once, which is a load of {load:g}"
    if problem.weights.makespan or problem.weights.completion:
        yield "the objective weighs times, not only distance and robots"
    yield from _why_no_metric(problem)


def _why_no_metric(problem: Problem) -> Iterator[str]:
    if problem.travel.epochs:
        yield "doors open and close"
        return
    apart_m = problem.travel.distance_m
    if not np.isfinite(apart_m).all():
        yield "there is no way between some places"
    elif not np.allclose(apart_m, apart_m.T):
        yield "some ways are longer in one direction than in the other"
    else:
        for via in range(len(apart_m)):
            over_m = apart_m[:, via, None] + apart_m[None, via]
            if (apart_m > over_m + LENGTH_M).any():
                place = problem.places[via]
                yield f"some way is longer than the detour over '{place}'"
                return


def _walked(problem: Problem) -> tuple[Schedule, float | None]:
    """The best walk of a single robot, and what no schedule can cost less than (None: unknown)."""
    load = sum(item.load for item in problem.items)
    pickups = sorted({item.pickup.place for item in problem.items})
    goal = problem.items[0].delivery.place
    exact = len(pickups) <= EXACT_PLACES
    orders = _shortest_orders(problem, pickups, goal) if exact else {}
    shortest_m, best, best_cost = inf, None, inf
    for number, robot in enumerate(problem.robots):
        order = orders.get(robot.start) or _around_tree(problem, robot, pickups, goal)
        shortest_m = min(shortest_m, _length_m(problem, robot, [*order, goal]))
        if robot.capacity < load:
            continue
        routes: list[Route] = [()] * len(problem.robots)
        routes[number] = tuple(_tasks(problem, order, goal))
        schedule = earliest_schedule(problem, routes)
        assert not isinstance(schedule, Untimeable), "nothing constrains the times"
        price = cost(problem, require_valid(problem, schedule)).total
        if price < best_cost:
            best, best_cost = schedule, price
    assert best is not None, "some robot carries everything"
    if not exact:
        return best, None
    return best, problem.weights.distance * shortest_m / 2 + problem.weights.robots


def _tasks(problem: Problem, order: Sequence[int], goal: int) -> Iterator[Task]:
    for place in order:
        for number, item in enumerate(problem.items):
            if item.pickup.place == place:
                yield Task(place, Action.PICK, number)
    for number in range(len(problem.items)):
        yield Task(goal, Action.DROP, number)


def _length_m(problem: Problem, robot: Robot, places: Sequence[int]) -> float:
    apart_m = problem.travel.distance_m
    stops = [robot.start, *places] if robot.end is None else [robot.start, *places, robot.end]
    return float(sum(apart_m[a, b] for a, b in pairwise(stops)))


def _shortest_orders(
    problem: Problem, pickups: Sequence[int], goal: int
) -> dict[int, tuple[int, ...]]:
    """By start, the order of the pickups on the shortest walk to the goal (Held and Karp 1962)."""
    apart_m = problem.travel.distance_m
    last = len(pickups)
    rest: list[dict[int, tuple[float, tuple[int, ...]]]] = [{} for _ in range(1 << last)]
    for visited in range(1, 1 << last):
        for first in range(last):
            if not visited >> first & 1:
                continue
            place, others = pickups[first], visited & ~(1 << first)
            if others:
                rest[visited][first] = min(
                    (float(apart_m[place, pickups[after]]) + metres, (place, *order))
                    for after, (metres, order) in rest[others].items()
                )
            else:
                rest[visited][first] = float(apart_m[place, goal]), (place,)
    return {
        robot.start: min(
            (float(apart_m[robot.start, order[0]]) + metres, order)
            for metres, order in rest[-1].values()
        )[1]
        for robot in problem.robots
    }


def _around_tree(
    problem: Problem, robot: Robot, pickups: Sequence[int], goal: int
) -> tuple[int, ...]:
    """The pickups in the order of a walk around a minimum spanning tree that ends at the goal."""
    nodes = [robot.start, *pickups, goal]
    parent = _spanning_tree(problem.travel.distance_m[np.ix_(nodes, nodes)])
    children: dict[int, list[int]] = {}
    for node, above in enumerate(parent[1:], start=1):
        children.setdefault(above, []).append(node)
    to_goal, node = set(), len(nodes) - 1
    while node:
        to_goal.add(node)
        node = parent[node]
    order, waiting = list[int](), [0]
    while waiting:
        node = waiting.pop()
        order.append(node)
        # The branch with the goal comes last: what is pushed first is walked last.
        waiting.extend(sorted(children.get(node, []), key=lambda child: child not in to_goal))
    return tuple(nodes[node] for node in order if 0 < node < len(nodes) - 1)


def _spanning_tree(apart_m: Matrix) -> list[int]:
    """By node its parent in a minimum spanning tree from node 0 (Prim 1957)."""
    count = len(apart_m)
    parent, nearest_m = [0] * count, apart_m[0].copy()
    left = set(range(1, count))
    while left:
        node = min(left, key=lambda each: (nearest_m[each], each))
        left.remove(node)
        for other in left:
            if apart_m[node, other] < nearest_m[other]:
                nearest_m[other], parent[other] = apart_m[node, other], node
    return parent
