"""From the visits that a public solver plans to a solution that has passed the checker."""

from collections.abc import Callable, Sequence

from mend.fleet.scheduling.checker import check
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Action, Route, Schedule, Task
from mend.fleet.scheduling.solution import Progress, Solution, Status
from mend.fleet.scheduling.timing import Untimeable, earliest_schedule

Visits = Sequence[Sequence[tuple[int, Action]]]
"""By robot: item and PICK or DROP, in order."""


def answer(
    problem: Problem,
    visits: Visits | None,
    seconds: float,
    start: Schedule | None,
    on_progress: Callable[[Progress], None] | None,
) -> Solution:
    """The better of the solver's schedule and `start`; `UNKNOWN` where neither is valid."""
    found = None if visits is None else _schedule(problem, visits)
    candidates = [each for each in (found, start) if each is not None]
    if not candidates:
        return Solution(Status.UNKNOWN, None, None, None, seconds)
    best = min(candidates, key=lambda each: cost(problem, each).total)
    best_cost = cost(problem, best)
    if on_progress is not None:
        on_progress(Progress(best_cost.total, None, seconds))
    return Solution(Status.FEASIBLE, best, best_cost, None, seconds)


def _schedule(problem: Problem, visits: Visits) -> Schedule | None:
    planned = [sorted(item for item, action in each if action is Action.DROP) for each in visits]
    if sorted(item for each in planned for item in each) != list(range(len(problem.items))):
        return None
    routes = [_route(problem, each) for each in visits]
    timed = earliest_schedule(problem.without_transfers(), routes)
    if isinstance(timed, Untimeable) or check(problem, timed):
        return None
    return timed


def _route(problem: Problem, visits: Sequence[tuple[int, Action]]) -> Route:
    return tuple(
        Task(
            problem.items[item].pickup.place
            if action is Action.PICK
            else problem.items[item].delivery.place,
            action,
            item,
        )
        for item, action in visits
    )
