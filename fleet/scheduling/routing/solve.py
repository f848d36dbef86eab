"""The search from outside: a problem in, a checked schedule out."""

from collections.abc import Callable
from functools import cache
from math import inf

from mend.fleet.scheduling.checker import require_valid
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.problem import Item, Problem, Robot, Visit, Weights
from mend.fleet.scheduling.routing.arrays import routing_arrays
from mend.fleet.scheduling.routing.plan import Plan, refresh
from mend.fleet.scheduling.routing.rounds import Rounds
from mend.fleet.scheduling.schedule import Action, Route, Schedule, Task
from mend.fleet.scheduling.solution import Progress, Solution, Status
from mend.fleet.scheduling.timing import Untimeable, earliest_schedule
from mend.fleet.scheduling.travel import Travel


def solve_alns(
    problem: Problem,
    *,
    seconds: float,
    seed: int = 0,
    start: Schedule | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    clock: Callable[[], float],
) -> Solution:
    """The best schedule without transfers found within `seconds`; never worse than `start`.

    The time to compile is not counted. The status is unknown where not every item could be
    delivered. Raises `UnsupportedError` for what `arrays.unsupported` names, and `ScheduleError` or
    `BrokenItineraryError` for a `start` that is not valid.
    """
    arrays = routing_arrays(problem)
    prepare()
    if start is not None:
        require_valid(problem, start)
    begun_s = clock()

    def tell(value: float) -> None:
        if on_progress is not None:
            on_progress(Progress(value, None, clock() - begun_s))

    rounds = Rounds(arrays, seed, clock, tell)
    if start is not None and not start.transfers:
        begin_with(rounds, start)
    rounds.run(seconds)
    return _solution(problem, rounds, start, clock() - begun_s)


@cache
def prepare() -> None:
    """Compile the kernels, or load them from the disk; once in a process."""
    travel = Travel.euclidean(((0.0, 0.0), (1.0, 0.0)))
    items = tuple(Item(name, 1.0, Visit(0), Visit(1)) for name in ("one", "two"))
    robots = tuple(Robot(name, 0, None, 1.0) for name in ("a", "b"))
    # Two robots cost less than the way that they save, so that there is one to be freed.
    small = Problem("warm-up", ("a", "b"), travel, robots, items, weights=Weights(robots=0.5))
    rounds = Rounds(routing_arrays(small), 0, lambda: 0.0)
    rounds.place(inf)
    rounds.free_robots(inf)
    rounds.take_steps(2, 1.0, 1.0)


def begin_with(rounds: Rounds, start: Schedule) -> None:
    """Let a search stand at a schedule without transfers."""
    arrays, plan = rounds.arrays, rounds.search.current
    items = plan.robot.size
    for robot, route in enumerate(start.routes):
        ends = plan.node[robot, :2].copy()
        visits = [task.item + (0 if task.action is Action.PICK else items) for task in route]
        plan.node[robot, 1 : len(visits) + 1] = visits
        plan.node[robot, len(visits) + 1] = ends[1]
        plan.length[robot] = len(visits) + 2
        plan.robot[[task.item for task in route]] = robot
        refresh(arrays, plan, robot, robot)
    rounds.keep()


def routes_in(problem: Problem, plan: Plan) -> tuple[Route, ...]:
    """The routes of a plan in which every item has a place."""
    return tuple(
        tuple(_task(problem, int(node)) for node in plan.node[robot, 1 : plan.length[robot] - 1])
        for robot in range(len(problem.robots))
    )


def _task(problem: Problem, node: int) -> Task:
    item = node % len(problem.items)
    if node < len(problem.items):
        return Task(problem.items[item].pickup.place, Action.PICK, item)
    return Task(problem.items[item].delivery.place, Action.DROP, item)


def _solution(problem: Problem, rounds: Rounds, start: Schedule | None, seconds: float) -> Solution:
    """The best plan as a checked schedule, or the start where that is better."""
    candidates = [] if start is None else [start]
    if rounds.best is not None:
        schedule = earliest_schedule(problem, routes_in(problem, rounds.best))
        assert not isinstance(schedule, Untimeable), "the kernels' own times fit"
        candidates.append(require_valid(problem, schedule))
    if not candidates:
        return Solution(Status.UNKNOWN, None, None, None, seconds)
    best = min(candidates, key=lambda each: cost(problem, each).total)
    return Solution(Status.FEASIBLE, best, cost(problem, best), None, seconds)
