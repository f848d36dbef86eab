"""One search of the constraint model: incumbents and bounds as they come, a schedule at the end."""

from collections.abc import Callable
from dataclasses import dataclass

from ortools.sat.python import cp_model

from mend.fleet.scheduling.checker import require_valid
from mend.fleet.scheduling.exact.hint import hint_from
from mend.fleet.scheduling.exact.model import SCALE, ExactModel, Rounding
from mend.fleet.scheduling.exact.route_bound import RobotRoute
from mend.fleet.scheduling.exact.route_choice import choose_routes
from mend.fleet.scheduling.exact.routes import routes_in
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Schedule
from mend.fleet.scheduling.solution import Progress, Solution, Status
from mend.fleet.scheduling.timing import Untimeable, earliest_schedule


@dataclass(frozen=True, slots=True)
class Effort:
    """What a search may take, and whom it tells how far it is."""

    seconds: float
    seed: int
    workers: int
    on_progress: Callable[[Progress], None] | None = None


def search(
    problem: Problem,
    rounding: Rounding,
    effort: Effort,
    start: Schedule | None = None,
    routes: list[list[RobotRoute]] | None = None,
) -> Solution:
    """The best schedule, made of certain routes where they are given.

    With times rounded down only whether there is one is told.
    """
    exact = ExactModel(problem, rounding)
    if routes is not None:
        choose_routes(exact, routes)
    if start is not None:
        hint_from(exact, start)
    solver = cp_model.CpSolver()
    solver.parameters.max_time_in_seconds = effort.seconds
    solver.parameters.num_workers = effort.workers
    solver.parameters.random_seed = effort.seed
    reporter = _Reporter(effort.on_progress) if effort.on_progress else None
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
