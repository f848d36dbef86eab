"""The optimum by way of routes: a bound, the few routes below it and the best schedule, and which
of them go together. Where windows leave few states this is over long before constraints alone.
"""

from collections.abc import Callable
from dataclasses import replace
from math import inf, isfinite

from mend.fleet.scheduling.exact.constraint_search import Effort, search
from mend.fleet.scheduling.exact.model import SCALE, Rounding
from mend.fleet.scheduling.exact.route_bound import RobotRoute, RouteBound, route_bound
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Schedule
from mend.fleet.scheduling.solution import Progress, Solution, Status

BOUND_SHARE = 0.3
"""The share of the time for the bound, at most."""
SEARCH_SHARE = 0.7
"""The share of what is left for choosing among the routes."""
MOST_ROUTES = 20_000
"""Beyond this many the choice among them takes longer than the search without them."""
NARROWER = (1.0, 0.5, 0.25, 0.125)
"""Shares of the gap between bound and start: schedules up to there are looked at in one go."""


def solve_by_routes(
    problem: Problem, effort: Effort, start: Schedule | None, clock: Callable[[], float]
) -> Solution:
    """The optimum if it can be proved so; else the best schedule found this way and a bound.

    Unknown without a bound where routes do not suit the problem.
    """
    began_s = clock()
    known = None if start is None else cost(problem, start)
    nothing = Solution(Status.UNKNOWN, None, None, None, 0.0)
    routes = route_bound(problem)
    if routes is None:
        return nothing
    routes.prove(BOUND_SHARE * effort.seconds, clock)
    if routes.bound == inf and start is None:
        return replace(nothing, status=Status.INFEASIBLE, seconds=clock() - began_s)
    if not isfinite(routes.bound):
        return nothing
    if effort.on_progress is not None:
        incumbent = None if known is None else known.total
        effort.on_progress(Progress(incumbent, routes.bound, clock() - began_s))
    ceiling, choices = _affordable(routes, routes.dearest if known is None else known.total)
    if choices is None:
        return replace(nothing, bound=routes.bound, seconds=clock() - began_s)
    left_s = SEARCH_SHARE * max(0.1, effort.seconds - (clock() - began_s))
    tell = at_least(routes.bound, effort.on_progress)
    found = _choose(problem, replace(effort, seconds=left_s, on_progress=tell), start, choices)
    return replace(_proved(found, routes, ceiling), seconds=clock() - began_s)


def at_least(
    bound: float, tell: Callable[[Progress], None] | None
) -> Callable[[Progress], None] | None:
    """Tell of no bound below one that is proved."""
    if tell is None:
        return None
    return lambda each: tell(replace(each, bound=max(bound, each.bound or bound)))


def _affordable(routes: RouteBound, dearest: float) -> tuple[float, list[list[RobotRoute]] | None]:
    """The routes of all schedules up to a cost, and that cost: as much as is not too many."""
    for share in NARROWER:
        ceiling = routes.bound + share * (dearest - routes.bound)
        choices = routes.routes(ceiling, MOST_ROUTES)
        if choices is not None:
            return ceiling, choices
    return routes.bound, None


def _choose(
    problem: Problem,
    effort: Effort,
    start: Schedule | None,
    choices: list[list[RobotRoute]],
) -> Solution:
    found = search(problem, Rounding.UP, effort, start, choices)
    if found.status is not Status.INFEASIBLE:
        return found
    left_s = max(0.1, effort.seconds - found.seconds)
    return search(problem, Rounding.DOWN, replace(effort, seconds=left_s), None, choices)


def _proved(found: Solution, routes: RouteBound, ceiling: float) -> Solution:
    """What the best choice among the routes up to a cost says about all schedules."""
    everything = ceiling >= routes.dearest
    if found.status is Status.INFEASIBLE:
        status = Status.INFEASIBLE if everything else Status.UNKNOWN
        return replace(found, status=status, bound=None if everything else ceiling)
    bound = max(routes.bound, min(found.bound or -inf, ceiling))
    if found.cost is None:
        return replace(found, bound=bound)
    best = found.status is Status.OPTIMAL and found.cost.total <= ceiling + 1.0 / SCALE
    status = Status.OPTIMAL if best else Status.FEASIBLE
    return replace(found, status=status, bound=found.cost.total if best else bound)
