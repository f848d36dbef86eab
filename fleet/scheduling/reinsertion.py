"""Large neighbourhoods around doors: items are taken out of a schedule and inserted again.

Slower by far than the compiled searches, but it tries everything in the temporal network, which
knows when doors let a robot through.
"""

from collections.abc import Callable
from random import Random

from mend.fleet.scheduling.cheapest_insertion import insert_items, solve_by_insertion
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.partial_routes import part_schedule, without_items
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Schedule
from mend.fleet.scheduling.solution import Progress, Solution, Status

START_SHARE = 0.2
"""The share of the time for the schedule to begin with."""
MOST_SHARE = 0.3
"""The largest share of the items that is taken out at once, though two always may be."""
WORSE = 0.02
"""By which share of its cost a schedule may become worse at the beginning; by none at the end."""


def solve_by_reinsertion(
    problem: Problem,
    *,
    seconds: float,
    seed: int = 0,
    start: Schedule | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    clock: Callable[[], float],
) -> Solution:
    """The best schedule within `seconds` of the clock; never worse than `start`.

    Status `UNKNOWN` where insertion alone finds nothing to begin with.
    """
    began_s = clock()
    begun = solve_by_insertion(
        problem, seconds=START_SHARE * seconds, seed=seed, start=start, on_progress=on_progress,
        clock=clock,
    )  # fmt: skip
    if begun.schedule is None or begun.cost is None:
        return begun
    chance = Random(seed)
    best = current = begun.schedule
    best_cost = current_cost = begun.cost.total
    while (spent_s := clock() - began_s) < seconds:
        found = _other(problem, current, chance, lambda: clock() - began_s < seconds)
        if found is None:
            continue
        found_cost = cost(problem, found).total
        if found_cost < current_cost + WORSE * (1 - spent_s / seconds) * best_cost:
            current, current_cost = found, found_cost
        if found_cost < best_cost:
            best, best_cost = found, found_cost
            if on_progress is not None:
                on_progress(Progress(best_cost, None, clock() - began_s))
    return Solution(Status.FEASIBLE, best, cost(problem, best), None, clock() - began_s)


def _other(
    problem: Problem, schedule: Schedule, chance: Random, goes_on: Callable[[], bool]
) -> Schedule | None:
    """The schedule with some items taken out and inserted again; None where one has no place."""
    items = _together(problem, schedule, chance)
    kept = without_items(schedule.routes, items)
    transfers = chance.random() < 0.5
    # What is on board takes up room until it is in.
    order = sorted(items, key=lambda item: problem.items[item].aboard is None)
    routes, _ = insert_items(problem, kept, order, goes_on, transfers=transfers)
    timed = None if routes is None else part_schedule(problem, routes)
    return None if timed is None else timed[1]


def _together(problem: Problem, schedule: Schedule, chance: Random) -> list[int]:
    """Items in any order: by chance, or those that one robot deals with one after the other."""
    count = len(problem.items)
    wanted = chance.randint(1, min(count, max(2, round(MOST_SHARE * count))))
    routes = [route for route in schedule.routes if route]
    if chance.random() < 0.5 or not routes:
        return chance.sample(range(count), wanted)
    route = chance.choice(routes)
    first = chance.randrange(len(route))
    found = list(dict.fromkeys(task.item for task in (*route[first:], *route[:first])))[:wanted]
    chance.shuffle(found)
    return found
