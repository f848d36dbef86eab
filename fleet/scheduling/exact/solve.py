"""Solving the constraint model: incumbents and bounds as they come, and the schedule at the end."""

from collections.abc import Callable

from ortools.sat.python import cp_model

from fleet.scheduling.checker import require_valid
from fleet.scheduling.exact.hint import hint_from
from fleet.scheduling.exact.model import SCALE, ExactModel, Rounding
from fleet.scheduling.exact.routes import routes_in
from fleet.scheduling.objective import cost
from fleet.scheduling.problem import Problem
from fleet.scheduling.schedule import Schedule
from fleet.scheduling.solution import Progress, Solution, Status, UnsupportedError
from fleet.scheduling.timing import Untimeable, earliest_schedule


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
    Raises `UnsupportedError` where doors open and close: the model's travel times are fixed.
    """
    if problem.travel.epochs:
        raise UnsupportedError(
            "the exact method cannot plan with doors that open and close; another method can"
        )
    solution = _solve(problem, Rounding.UP, seconds, seed, workers, start, on_progress)
    if solution.status is not Status.INFEASIBLE:
        return _not_worse(problem, solution, start)
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
    if solution.cost is not None and solution.cost.total <= begun.total:
        return solution
    status = Status.OPTIMAL if solution.status is Status.OPTIMAL else Status.FEASIBLE
    return Solution(status, start, begun, solution.bound, solution.seconds)


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
