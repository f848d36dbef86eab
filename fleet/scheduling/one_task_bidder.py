"""The one-task bidder: how a dispatcher without batching, capacities or transfers shares out work.

One item at a time goes to the robot that would be done with it first, after all that it has been
given before; a robot brings one item before it goes for the next. A baseline to compare with.
"""

from collections.abc import Callable

from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.partial_routes import part_schedule
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.route_estimate import earliest_end_s
from mend.fleet.scheduling.schedule import Action, Route, Schedule, Task
from mend.fleet.scheduling.solution import Progress, Solution, unproved


def solve_one_task_each(
    problem: Problem,
    *,
    seconds: float,
    seed: int = 0,  # noqa: ARG001 - every solver takes one; nothing is drawn here
    start: Schedule | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    clock: Callable[[], float],
) -> Solution:
    """Items in the order of their release, each to the quickest robot; never worse than `start`.

    `clock` tells seconds; status `UNKNOWN` where an item has no bidder.
    """
    began_s = clock()
    found = _shared_out(problem, lambda: clock() - began_s < seconds)
    best = start
    if found is not None and (start is None or _total(problem, found) < _total(problem, start)):
        best = found
    solution = unproved(problem, best, clock() - began_s)
    if on_progress is not None and solution.cost is not None:
        on_progress(Progress(solution.cost.total, None, solution.seconds))
    return solution


def _shared_out(problem: Problem, goes_on: Callable[[], bool]) -> Schedule | None:
    routes: list[Route] = [()] * len(problem.robots)
    for item in sorted(range(len(problem.items)), key=lambda each: _released(problem, each)):
        if not goes_on() or not _give(problem, routes, item):
            return None
    timed = part_schedule(problem, routes)
    return None if timed is None else timed[1]


def _released(problem: Problem, item: int) -> tuple[bool, float, int]:
    """What is aboard comes first, then what can be picked up first."""
    described = problem.items[item]
    return described.aboard is None, described.pickup.window.earliest_s, item


def _give(problem: Problem, routes: list[Route], item: int) -> bool:
    """Append the item to the route of the robot that is done with it first."""
    described = problem.items[item]
    tasks: Route = (Task(described.delivery.place, Action.DROP, item),)
    if described.aboard is None:
        tasks = (Task(described.pickup.place, Action.PICK, item), *tasks)
    bidders = range(len(routes)) if described.aboard is None else (described.aboard,)
    bids = []
    for robot in bidders:
        ends_s = earliest_end_s(problem, robot, (*routes[robot], *tasks))
        if ends_s is not None:
            bids.append((ends_s, robot))
    if not bids:
        return False
    _, winner = min(bids)
    routes[winner] = (*routes[winner], *tasks)
    return True


def _total(problem: Problem, schedule: Schedule) -> float:
    return cost(problem, schedule).total
