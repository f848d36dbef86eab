"""Cheapest insertion: item after item, its whole trajectory where it costs least."""

from collections.abc import Callable, Sequence
from math import inf
from random import Random

from mend.fleet.scheduling.growing_routes import GrowingRoutes
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.partial_routes import part_schedule
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Route, Schedule
from mend.fleet.scheduling.solution import Progress, Solution, unproved

ORDERS = 12
"""In how many orders the items are put in; the best schedule counts."""


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
    return unproved(problem, best, clock() - began_s)


def insert_items(
    problem: Problem,
    routes: Sequence[Route],
    items: Sequence[int],
    goes_on: Callable[[], bool],
) -> tuple[tuple[Route, ...] | None, int | None]:
    """The routes with more items in them, or None and the item that has no place.

    `routes` hold all items but these.
    """
    growing = GrowingRoutes(problem, routes)
    if growing.conflict is not None:
        return None, items[0] if items else None
    for item in items:
        bid = growing.bid(item) if goes_on() else None
        if bid is None:
            return None, item
        growing.award(item, bid)
    return growing.routes, None


def _insert_in_order(
    problem: Problem, order: Sequence[int], goes_on: Callable[[], bool]
) -> tuple[Schedule | None, int | None]:
    routes, failed = insert_items(problem, [()] * len(problem.robots), order, goes_on)
    if routes is None:
        return None, failed
    timed = part_schedule(problem, routes)
    return (None if timed is None else timed[1]), None


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
