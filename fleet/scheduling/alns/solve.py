"""The search from outside: how time is shared out, where it starts, and the schedule at the end."""

from collections.abc import Callable
from functools import cache
from itertools import count
from math import inf

from mend.fleet.scheduling.alns.problem_arrays import problem_arrays
from mend.fleet.scheduling.alns.routes import CHAIN, longest_chain, plan_of, routes_in
from mend.fleet.scheduling.alns.search import Search
from mend.fleet.scheduling.checker import require_valid
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Weights
from mend.fleet.scheduling.schedule import Schedule
from mend.fleet.scheduling.solution import Progress, Solution, unproved
from mend.fleet.scheduling.timing import Untimeable, earliest_schedule
from mend.fleet.scheduling.travel import Travel

ALONE_SHARE = 0.2
"""The share of the time for the plan without transfers."""


def solve_alns(
    problem: Problem,
    *,
    seconds: float,
    seed: int = 0,
    start: Schedule | None = None,
    transfers: bool = True,
    on_progress: Callable[[Progress], None] | None = None,
    clock: Callable[[], float],
) -> Solution:
    """The best schedule that was found within `seconds` of the clock; never worse than `start`.

    It first plans without transfers and goes on from there, so that it is never worse than that.
    The time to compile is not counted. The status is unknown where not every item could be
    delivered. Raises `ScheduleError` or `BrokenItineraryError` for a `start` that is not valid.
    """
    prepare()
    if start is not None:
        require_valid(problem, start)
    begun_s = clock()

    def tell(value: float) -> None:
        if on_progress is not None:
            on_progress(Progress(value, None, clock() - begun_s))

    arrays = problem_arrays(problem, CHAIN if start is None else longest_chain(start.routes))
    search = Search(arrays, seed, clock, tell)
    shared = transfers and len(problem.robots) > 1 and bool(problem.transfers.places)
    given = None if start is None else plan_of(arrays, problem, start.routes)
    if given is not None and not given.handed[0]:
        search.begin_with(given)
    search.run(seconds * ALONE_SHARE if shared else seconds, 0)
    if given is not None and given.handed[0]:
        search.begin_with(given)
    if shared:
        search.run(seconds - (clock() - begun_s), arrays.chain)
    return _solution(problem, search, start, clock() - begun_s)


@cache
def prepare() -> None:
    """Compile the kernels, or load them from the disk; once in a process."""
    travel = Travel.euclidean(((0.0, 0.0), (1.0, 0.0)))
    robots = (Robot("a", 0, 0, 1.0), Robot("b", 1, 1, 1.0))
    items = tuple(Item(f"at {place}", 1.0, Visit(place), Visit(place)) for place in (0, 1))
    # Two robots cost less than the way that they save, so that there is one to be freed.
    small = Problem(
        "warm-up", ("a", "b"), travel, robots, items, Transfers((0, 1)), Weights(robots=0.5)
    )
    ticks = count()
    search = Search(problem_arrays(small, CHAIN), 0, lambda: float(next(ticks)))
    search.place(inf)
    search.free_robots(3.0)
    search.take_steps(2, 0, (0.0, 1.0))
    search.take_steps(2, CHAIN, (0.0, 1.0))


def _solution(problem: Problem, search: Search, start: Schedule | None, seconds: float) -> Solution:
    """The best plan as a checked schedule, or the start where that is better."""
    candidates = [] if start is None else [start]
    if search.best is not None:
        schedule = earliest_schedule(problem, routes_in(search.problem, search.best))
        assert not isinstance(schedule, Untimeable), "the kernels' own times fit"
        candidates.append(require_valid(problem, schedule))
    best = min(candidates, key=lambda each: cost(problem, each).total, default=None)
    return unproved(problem, best, seconds)
