"""Cheapest insertion: item after item, each where it costs least, with at most one transfer."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import inf
from random import Random

from fleet.scheduling.checker import ScheduleError, require_valid
from fleet.scheduling.insertion_places import Insertion, insertions, routes_with
from fleet.scheduling.objective import cost
from fleet.scheduling.problem import Problem
from fleet.scheduling.route_estimate import estimate
from fleet.scheduling.schedule import Route, Schedule
from fleet.scheduling.solution import Progress, Solution, Status
from fleet.scheduling.timing import Untimeable, earliest_schedule

ORDERS = 12
"""In how many orders the items are put in; the best schedule counts."""
COMPARED = 6
"""How many possible insertions are compared where more than distance and robots counts."""


def solve_by_insertion(
    problem: Problem,
    *,
    seconds: float,
    seed: int = 0,
    start: Schedule | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    clock: Callable[[], float],
) -> Solution:
    """The best schedule of several orders of the items; never worse than `start`.

    `clock` tells seconds; status `UNKNOWN` where no order places every item in time.
    """
    chance, began_s = Random(seed), clock()
    best, best_cost = start, inf if start is None else cost(problem, start).total
    # What a transfer gains for one item may cost more for the next: both are tried.
    kinds = [problem.without_transfers(), problem] if problem.transfers.places else [problem]
    orders = [_urgent_first(problem)] * len(kinds)
    for attempt in range(ORDERS * len(kinds)):
        if clock() - began_s >= seconds:
            break
        kind = attempt % len(kinds)
        placed, failed = _insert_in_order(
            kinds[kind], orders[kind], lambda: clock() - began_s < seconds
        )
        if placed is not None and cost(problem, placed).total < best_cost:
            best, best_cost = placed, cost(problem, placed).total
            if on_progress is not None:
                on_progress(Progress(best_cost, None, clock() - began_s))
        orders[kind] = _next_order(problem, orders[kind], failed, chance)
    return _solution(problem, best, clock() - began_s)


def insert_items(
    problem: Problem, routes: Sequence[Route], items: Sequence[int], goes_on: Callable[[], bool]
) -> tuple[tuple[Route, ...] | None, int | None]:
    """The routes with more items in them, or None and the item that has no place.

    `routes` hold all items but these.
    """
    kept = sorted({task.item for route in routes for task in route})
    order = [*kept, *items]
    ordered = replace(problem, items=tuple(problem.items[item] for item in order))
    number = {item: position for position, item in enumerate(order)}
    current = _renumbered(routes, number)
    for position in range(len(kept), len(order)):
        part = replace(ordered, items=ordered.items[: position + 1])
        found = _insert(part, current, position) if goes_on() else None
        if found is None:
            return None, order[position]
        current = found
    return _renumbered(current, dict(enumerate(order))), None


def _insert_in_order(
    problem: Problem, order: Sequence[int], goes_on: Callable[[], bool]
) -> tuple[Schedule | None, int | None]:
    routes, failed = insert_items(problem, [()] * len(problem.robots), order, goes_on)
    if routes is None:
        return None, failed
    schedule = _timed(problem, routes)
    return schedule, None


def _insert(problem: Problem, routes: tuple[Route, ...], item: int) -> tuple[Route, ...] | None:
    """The routes with the item where it costs least; None where it has no place."""
    by_distance = _only_distance_and_robots_count(problem)
    possible: list[tuple[float, tuple[Route, ...]]] = []
    for insertion in insertions(problem, routes, item):
        changed = routes_with(problem, routes, item, insertion)
        if not _may_fit(problem, changed, insertion):
            continue
        schedule = _timed(problem, changed)
        if schedule is None:
            continue
        if by_distance:
            return changed
        possible.append((cost(problem, schedule).total, changed))
        if len(possible) == COMPARED:
            break
    return min(possible, key=lambda each: each[0])[1] if possible else None


def _only_distance_and_robots_count(problem: Problem) -> bool:
    weights = problem.weights
    if weights.makespan or weights.completion or problem.travel.epochs:
        return False
    due = any(min(item.pickup.due_s, item.delivery.due_s) < inf for item in problem.items)
    return not (weights.lateness and due)


def _may_fit(problem: Problem, routes: tuple[Route, ...], insertion: Insertion) -> bool:
    return all(
        estimate(problem, leg.robot, routes[leg.robot]) is not None for leg in insertion.legs
    )


def _timed(problem: Problem, routes: Sequence[Route]) -> Schedule | None:
    schedule = earliest_schedule(problem, routes)
    if isinstance(schedule, Untimeable):
        return None
    try:
        return require_valid(problem, schedule)
    except ScheduleError:
        # Robots that wait for each other in a circle that takes no time.
        return None


def _urgent_first(problem: Problem) -> list[int]:
    """What is aboard already, then by the end of the delivery's window, then what is due."""
    items = problem.items
    return sorted(
        range(len(items)),
        key=lambda item: (
            items[item].aboard is None,
            items[item].delivery.window.latest_s,
            items[item].delivery.due_s,
        ),
    )


def _next_order(
    problem: Problem, order: Sequence[int], failed: int | None, chance: Random
) -> list[int]:
    """What had no place comes first, else the order is shuffled; what is aboard stays first."""
    changed = list(order)
    if failed is None:
        chance.shuffle(changed)
    else:
        changed.remove(failed)
        changed.insert(0, failed)
    return sorted(changed, key=lambda item: problem.items[item].aboard is None)


def _renumbered(routes: Sequence[Route], number: dict[int, int]) -> tuple[Route, ...]:
    return tuple(tuple(replace(task, item=number[task.item]) for task in route) for route in routes)


def _solution(problem: Problem, best: Schedule | None, seconds: float) -> Solution:
    if best is None:
        return Solution(Status.UNKNOWN, None, None, None, seconds)
    return Solution(Status.FEASIBLE, best, cost(problem, best), None, seconds)
