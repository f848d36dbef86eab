"""Solving the constraint model: incumbents and bounds as they come, and the schedule at the end."""

from collections.abc import Callable
from dataclasses import replace
from math import isfinite

from ortools.sat.python import cp_model

from fleet.scheduling.checker import require_valid
from fleet.scheduling.exact.flow_bound import flow_bound, windows_are_wide
from fleet.scheduling.exact.hint import hint_from
from fleet.scheduling.exact.model import SCALE, ExactModel, Rounding
from fleet.scheduling.exact.routes import routes_in
from fleet.scheduling.objective import cost
from fleet.scheduling.problem import Problem
from fleet.scheduling.schedule import Schedule
from fleet.scheduling.solution import Progress, Solution, Status, UnsupportedError
from fleet.scheduling.timing import Untimeable, earliest_schedule

CONSTRAINTS_SHARE = 0.65
"""The share of the time for constraint programming where flows may give a better bound."""
SAME = 1e-6
"""A cost and a bound that differ by less than this share are the same."""


def solve_exactly(
    problem: Problem,
    *,
    seconds: float,
    seed: int = 0,
    workers: int = 2,
    start: Schedule | None = None,
    on_progress: Callable[[Progress], None] | None = None,
) -> Solution:
    """The optimal schedule, or the best within `seconds` with a bound.

    `start` is where the search begins; the result is never worse. What is infeasible is proved so
    with times rounded down, apart from a doubt that is smaller than a thousandth of a second.
    Where windows are wide and constraint programming has proved nothing in the most of the time,
    the rest goes to a bound from flows.
    Raises `UnsupportedError` where doors open and close: the model's travel times are fixed.
    """
    if problem.travel.epochs:
        raise UnsupportedError(
            "the exact method cannot plan with doors that open and close; another method can"
        )
    wide = windows_are_wide(problem)
    most = CONSTRAINTS_SHARE * seconds if wide else seconds
    solution = _solve(problem, Rounding.UP, most, seed, workers, start, on_progress)
    if solution.status is not Status.INFEASIBLE:
        solution = _not_worse(problem, solution, start)
        if wide and solution.status is not Status.OPTIMAL:
            return _with_flow_bound(problem, solution, seconds, on_progress)
        return solution
    left = max(1.0, seconds - solution.seconds)
    again = _solve(problem, Rounding.DOWN, left, seed, workers, start, None)
    proved = again.status is Status.INFEASIBLE
    status = Status.INFEASIBLE if proved else Status.UNKNOWN
    return Solution(status, None, None, None, solution.seconds + again.seconds)


def _solve(
    problem: Problem,
    rounding: Rounding,
    seconds: float,
    seed: int,
    workers: int,
    start: Schedule | None,
    on_progress: Callable[[Progress], None] | None,
) -> Solution:
    exact = ExactModel(problem, rounding)
    if start is not None:
        hint_from(exact, start)
    solver = cp_model.CpSolver()
    solver.parameters.max_time_in_seconds = seconds
    solver.parameters.num_workers = workers
    solver.parameters.random_seed = seed
    reporter = _Reporter(on_progress) if on_progress else None
    if reporter is not None:
        solver.best_bound_callback = reporter.take_bound
    code = solver.solve(exact.model, reporter)
    status = {
        cp_model.OPTIMAL: Status.OPTIMAL,
        cp_model.FEASIBLE: Status.FEASIBLE,
        cp_model.INFEASIBLE: Status.INFEASIBLE,
    }.get(code, Status.UNKNOWN)
    if status in (Status.INFEASIBLE, Status.UNKNOWN):
        bound = solver.best_objective_bound / SCALE if status is Status.UNKNOWN else None
        return Solution(status, None, None, bound, solver.wall_time)
    if rounding is Rounding.DOWN:
        return Solution(Status.UNKNOWN, None, None, None, solver.wall_time)
    schedule = earliest_schedule(problem, routes_in(exact, solver))
    assert not isinstance(schedule, Untimeable), "the model's own times fit"
    require_valid(problem, schedule)
    found = cost(problem, schedule)
    bound = found.total if status is Status.OPTIMAL else solver.best_objective_bound / SCALE
    return Solution(status, schedule, found, bound, solver.wall_time)


def _not_worse(problem: Problem, solution: Solution, start: Schedule | None) -> Solution:
    if start is None:
        return solution
    begun = cost(problem, start)
    # What is as good is left as it is: another schedule may change robots more often for nothing.
    if solution.cost is not None and solution.cost.total < begun.total * (1 - SAME):
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
    if proved is None or not isfinite(proved):
        return replace(solution, seconds=seconds)
    bound, status = max(proved, solution.bound or 0.0), solution.status
    if solution.cost is not None and bound >= solution.cost.total * (1 - SAME):
        bound, status = solution.cost.total, Status.OPTIMAL
    if on_progress is not None:
        incumbent = None if solution.cost is None else solution.cost.total
        on_progress(Progress(incumbent, bound, seconds))
    return replace(solution, status=status, bound=bound, seconds=seconds)


class _Reporter(cp_model.CpSolverSolutionCallback):
    """Tells of better incumbents and bounds."""

    def __init__(self, tell: Callable[[Progress], None]) -> None:
        super().__init__()
        self._tell = tell
        self._incumbent: float | None = None
        self._bound: float | None = None

    def on_solution_callback(self) -> None:
        self._incumbent = self.objective_value / SCALE
        self._bound = self.best_objective_bound / SCALE
        self._tell(Progress(self._incumbent, self._bound, self.wall_time))

    def take_bound(self, bound: float) -> None:
        """CP-SAT's own callback for bounds."""
        self._bound = bound / SCALE
        self._tell(Progress(self._incumbent, self._bound, 0.0))
