"""The search from outside: how time is shared out, where it starts, and the schedule at the end."""

from collections.abc import Callable
from functools import cache
from math import inf, isfinite

import numpy as np

from mend.fleet.scheduling.checker import require_valid
from mend.fleet.scheduling.dice import Dice, dice_from
from mend.fleet.scheduling.itinerary import itineraries
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit
from mend.fleet.scheduling.routing.arrays import unsupported
from mend.fleet.scheduling.routing.solve import prepare as prepare_alns
from mend.fleet.scheduling.routing.solve import solve_alns
from mend.fleet.scheduling.schedule import Schedule
from mend.fleet.scheduling.solution import Progress, Solution, Status, UnsupportedError
from mend.fleet.scheduling.timing import Untimeable, earliest_schedule
from mend.fleet.scheduling.travel import Travel
from mend.fleet.scheduling.vlns.annealing import Search, anneal, search_for
from mend.fleet.scheduling.vlns.arrays import (
    BANKED,
    TOTAL,
    Plan,
    ProblemArrays,
    copy_plan,
    empty_plan,
    problem_arrays,
)
from mend.fleet.scheduling.vlns.insertion import refresh
from mend.fleet.scheduling.vlns.routes import plan_of, routes_in

CHAIN = 3
"""The most transfers of one item, unless the start already has more."""
ALONE = 0.2
"""The share of the time for the plan without transfers."""
WARM, COOL = 0.3, 0.002
"""The temperatures of a round, in units of what an item costs on average."""
ROUND_STEPS = 3000
"""How many steps per item a round of cooling should have."""
SLICE_S = 0.1
"""How long the kernels run before the clock is looked at (seconds)."""


def solve_vlns(
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
    delivered. Raises `ScheduleError` or `BrokenItineraryError` for a `start` that is not valid, and
    `UnsupportedError` where doors open and close: its travel times are fixed.
    """
    if problem.travel.epochs:
        raise UnsupportedError("the compiled search does not know doors that open and close")
    prepare()
    if start is not None:
        require_valid(problem, start)
    begun_s = clock()
    search = _Planner(problem, seed, start, clock, on_progress)
    search.run(seconds, transfers and len(problem.robots) > 1)
    return _solution(problem, search, start, clock() - begun_s)


@cache
def prepare() -> None:
    """Compile the kernels, or load them from the disk; once in a process."""
    prepare_alns()
    travel = Travel.euclidean(((0.0, 0.0), (1.0, 0.0)))
    robots = (Robot("a", 0, 0, 1.0), Robot("b", 1, 1, 1.0))
    item = Item("parcel", 1.0, Visit(0), Visit(1))
    small = Problem("warm-up", ("a", "b"), travel, robots, (item,), Transfers((0, 1)))
    arrays = problem_arrays(small, CHAIN)
    anneal(arrays, search_for(arrays), dice_from(np.random.default_rng(0)), 2, CHAIN, 1.0, 0.1)


class _Planner:
    """One search with its clock."""

    def __init__(
        self,
        problem: Problem,
        seed: int,
        start: Schedule | None,
        clock: Callable[[], float],
        tell: Callable[[Progress], None] | None,
    ) -> None:
        chain = CHAIN if start is None else max(CHAIN, _longest_chain(problem, start))
        self.arrays: ProblemArrays = problem_arrays(problem, chain)
        self.search: Search = search_for(self.arrays)
        self._problem = problem
        self._seed = seed
        self._dice: Dice = dice_from(np.random.default_rng(seed))
        self._clock = clock
        self._begun_s = clock()
        self._tell = tell
        self._told = inf
        self._start = None if start is None else plan_of(self.arrays, problem, start.routes)

    def run(self, seconds: float, transfers: bool) -> None:
        """Search until the time is over: first without transfers, then with them."""
        if not self.arrays.load.size:
            self._take_over(empty_plan(self.arrays))
            return
        if transfers and unsupported(self._problem) is None:
            self._plan_routes(seconds * ALONE)
        else:
            self._search_for(seconds * ALONE if transfers else seconds, 0)
        if self._start is not None:
            self._take_over(self._start)
        if transfers:
            self._search_for(seconds - self._elapsed_s(), self.arrays.chain)
        elif self._start is not None:
            self._search_for(seconds - self._elapsed_s(), 0)

    def _plan_routes(self, seconds: float) -> None:
        """Begin with what the search that knows no transfers finds: it is the better one at that,
        above all where few plans are possible."""
        alone = solve_alns(
            self._problem.without_transfers(),
            seconds=seconds,
            seed=self._seed,
            clock=self._clock,
        )
        if alone.schedule is not None:
            self._take_over(plan_of(self.arrays, self._problem, alone.schedule.routes))
            self._report()

    def _elapsed_s(self) -> float:
        return self._clock() - self._begun_s

    def _take_over(self, plan: Plan) -> None:
        """Go on from another plan where it is better than the best."""
        if refresh(self.arrays, plan, self.search.times) and (
            plan.value[TOTAL] < self.search.best.value[TOTAL]
        ):
            copy_plan(plan, self.search.best)
            copy_plan(plan, self.search.current)

    def _search_for(self, seconds: float, most: int) -> None:
        """Rounds of cooling, every other one from the best; more and shorter ones for few items."""
        items = self.arrays.load.size
        begun_s = self._clock()
        steps = 10
        self._slice(steps, most, 1.0, 1.0)
        left_s = seconds - (self._clock() - begun_s)
        pace = steps / max(self._clock() - begun_s, 1e-6)
        rounds = max(1, round(pace * left_s / (ROUND_STEPS * items)))
        for number in range(rounds):
            ends_s = begun_s + seconds - left_s * (rounds - number - 1) / rounds
            if number % 2:
                copy_plan(self.search.best, self.search.current)
            pace = self._round(ends_s, most, pace)

    def _round(self, ends_s: float, most: int, pace: float) -> float:
        """Cool down until a time of the clock; `pace` and what is returned: steps a second."""
        begun_s = now_s = self._clock()
        length_s = ends_s - begun_s
        while now_s < ends_s:
            steps = max(1, int(pace * min(SLICE_S, ends_s - now_s)))
            spent = (now_s - begun_s) / length_s
            share = min(1.0, (now_s - begun_s + SLICE_S) / length_s)
            self._slice(steps, most, (COOL / WARM) ** spent, (COOL / WARM) ** share)
            before_s, now_s = now_s, self._clock()
            pace = 0.5 * (pace + min(4 * pace, steps / max(now_s - before_s, 1e-6)))
        return pace

    def _slice(self, steps: int, most: int, warm: float, cool: float) -> None:
        unit = self._unit() * WARM
        anneal(self.arrays, self.search, self._dice, steps, most, unit * warm, unit * cool)
        self._report()

    def _unit(self) -> float:
        """What one item costs on average, undelivered ones aside."""
        plan, arrays = self.search.best, self.arrays
        banked = int((plan.transfers == BANKED).sum())
        delivered = max(1, plan.transfers.size - banked)
        value = float(plan.value[TOTAL])
        if not isfinite(value):
            return arrays.penalty
        robots = arrays.weight_robots * float((plan.length > 0).sum())
        return max((value - banked * arrays.penalty - robots) / delivered, 1e-6)

    def _report(self) -> None:
        plan = self.search.best
        value = float(plan.value[TOTAL])
        if self._tell is None or value >= self._told or (plan.transfers == BANKED).any():
            return
        self._told = value
        self._tell(Progress(value, None, self._elapsed_s()))


def _longest_chain(problem: Problem, schedule: Schedule) -> int:
    ways = itineraries(problem, schedule.routes)
    return max((len(legs) - 1 for legs in ways.values()), default=0)


def _solution(
    problem: Problem, planner: _Planner, start: Schedule | None, seconds: float
) -> Solution:
    """The best plan as a checked schedule, or the start where that is better."""
    found = _schedule(problem, planner)
    candidates = [each for each in (start, found) if each is not None]
    if not candidates:
        return Solution(Status.UNKNOWN, None, None, None, seconds)
    best = min(candidates, key=lambda each: cost(problem, each).total)
    return Solution(Status.FEASIBLE, best, cost(problem, best), None, seconds)


def _schedule(problem: Problem, planner: _Planner) -> Schedule | None:
    plan = planner.search.best
    if not isfinite(plan.value[TOTAL]) or (plan.transfers == BANKED).any():
        return None
    schedule = earliest_schedule(problem, routes_in(planner.arrays, plan))
    assert not isinstance(schedule, Untimeable), "the kernels' own times fit"
    return require_valid(problem, schedule)
