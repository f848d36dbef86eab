"""The optimal schedule: by way of routes, else by constraints alone, with a bound from flows."""

from collections.abc import Callable
from dataclasses import replace
from math import inf, isfinite

from mend.fleet.scheduling.exact.constraint_search import Effort, search
from mend.fleet.scheduling.exact.flow_bound import flow_bound, windows_are_wide
from mend.fleet.scheduling.exact.model import Rounding
from mend.fleet.scheduling.exact.route_search import at_least, solve_by_routes
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Schedule
from mend.fleet.scheduling.solution import Progress, Solution, Status, UnsupportedError
from mend.fleet.scheduling.tolerance import error, proves

CONSTRAINTS_SHARE = 0.65
"""The share of the time for constraint programming where flows may give a better bound."""
SETTLED = (Status.OPTIMAL, Status.INFEASIBLE)


def solve_exactly(
    problem: Problem,
    *,
    seconds: float,
    seed: int = 0,
    workers: int = 2,
    start: Schedule | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    clock: Callable[[], float],
) -> Solution:
    """The optimal schedule, or the best within `seconds` of the clock with a bound.

    `start` is where the search begins; the result is never worse. What is infeasible is proved so
    with times rounded down, apart from a doubt that is smaller than a thousandth of a second.
    What routes do not settle is left to constraint programming alone; where windows are wide and
    that has proved nothing in the most of the time, the rest goes to a bound from flows.
    Raises `UnsupportedError` where doors open and close: the model's travel times are fixed.
    """
    if problem.travel.epochs:
        raise UnsupportedError(
            "the exact method cannot plan with doors that open and close; another method can"
        )
    began_s = clock()
    effort = Effort(seconds, seed, workers, on_progress)
    routed = solve_by_routes(problem, effort, start, clock)
    if routed.status is Status.INFEASIBLE and start is None:
        return routed
    best = _not_worse(problem, routed, start)
    if best.status is Status.OPTIMAL:
        return best
    left_s = max(0.1, seconds - (clock() - began_s))
    if best.bound is not None:
        effort = replace(effort, on_progress=at_least(best.bound, on_progress))
    found = _by_constraints(problem, replace(effort, seconds=left_s), best.schedule)
    return replace(_with_bound(found, best.bound), seconds=clock() - began_s)


def _by_constraints(problem: Problem, effort: Effort, start: Schedule | None) -> Solution:
    """By constraint programming, and where windows are wide by flows after it."""
    wide = windows_are_wide(problem)
    most_s = CONSTRAINTS_SHARE * effort.seconds if wide else effort.seconds
    solution = search(problem, Rounding.UP, replace(effort, seconds=most_s), start)
    if solution.status is Status.INFEASIBLE and start is None:
        left = replace(effort, seconds=max(1.0, effort.seconds - solution.seconds))
        return search(problem, Rounding.DOWN, replace(left, on_progress=None))
    solution = _not_worse(problem, solution, start)
    if wide and solution.status is not Status.OPTIMAL:
        return _with_flow_bound(problem, solution, effort.seconds, effort.on_progress)
    return solution


def _with_bound(solution: Solution, bound: float | None) -> Solution:
    """The solution with a bound that was proved before, if that is better."""
    if bound is None or solution.status in SETTLED or bound <= (solution.bound or -inf):
        return solution
    if solution.cost is not None and proves(bound, solution.cost.total):
        return replace(solution, status=Status.OPTIMAL, bound=solution.cost.total)
    return replace(solution, bound=bound)


def _not_worse(problem: Problem, solution: Solution, start: Schedule | None) -> Solution:
    if start is None:
        return solution
    begun = cost(problem, start)
    # What is as good is left as it is: another schedule may change robots more often for nothing.
    if solution.cost is not None and solution.cost.total < begun.total - error(begun.total):
        return solution
    status = Status.OPTIMAL if solution.status is Status.OPTIMAL else Status.FEASIBLE
    bound = None if solution.bound is None else min(solution.bound, begun.total)
    return Solution(status, start, begun, bound, solution.seconds)


def _with_flow_bound(
    problem: Problem,
    solution: Solution,
    seconds: float,
    on_progress: Callable[[Progress], None] | None,
) -> Solution:
    """The solution with the better bound: its own, or that from flows in the time left."""
    proved = flow_bound(problem, max(0.1, seconds - solution.seconds))
    if proved is not None and isfinite(proved):
        solution = _with_bound(solution, proved)
        if on_progress is not None:
            incumbent = None if solution.cost is None else solution.cost.total
            on_progress(Progress(incumbent, solution.bound, seconds))
    return replace(solution, seconds=seconds)
