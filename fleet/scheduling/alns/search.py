"""How a search goes on in time: everything placed, robots freed, rounds of cooling."""

from collections.abc import Callable
from math import inf, log
from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.alns.annealing import Operators, anneal, equal_operators
from mend.fleet.scheduling.alns.ejection import Ejection, ejection_for, empty_route, place_all
from mend.fleet.scheduling.alns.itineraries import Allowed
from mend.fleet.scheduling.alns.plan import BANKED, Plan, copy_plan, plan_value
from mend.fleet.scheduling.alns.problem_arrays import ProblemArrays
from mend.fleet.scheduling.alns.propagation import update
from mend.fleet.scheduling.alns.repair import Repair, repair
from mend.fleet.scheduling.alns.state import BEST, CURRENT, State, state_for
from mend.fleet.scheduling.rng import Rng, rng_from

SLICE_S = 0.1
"""How long the kernels run before the clock is looked at (seconds)."""
FREEING = 0.15
"""The share of all the time, and of each round, in which robots are to be freed."""
TRIES = 2000
"""How many sets of items, per item, one attempt to free a robot may try to eject."""


WORSE = 0.05
"""A round begins so warm that a plan which is worse by this share is accepted every other time
(Ropke and Pisinger 2006, as is the next)."""
COOLED = 0.99975**25000
"""The last temperature of a round, as a share of the first."""


class Rounds(NamedTuple):
    """How many steps per item a round should have; every how many begin with the best plan."""

    steps: int
    restart: int


ALONE = Rounds(1500, 1)
SHARED = Rounds(3000, 2)
"""While no item may change robots, and while items may."""


class Search:
    """One search with its clock, and `tell` for every better cost of a complete plan."""

    def __init__(
        self,
        problem: ProblemArrays,
        seed: int,
        clock: Callable[[], float],
        tell: Callable[[float], None] | None = None,
    ) -> None:
        self.problem = problem
        self.state: State = state_for(problem)
        self._operators: Operators = equal_operators()
        self._ejection: Ejection = ejection_for(problem)
        self._generator = np.random.default_rng(seed)
        self._rng: Rng = rng_from(self._generator)
        self._clock = clock
        self._tell = tell
        self._told = inf
        self._tries_a_s = 1e5
        # Ejection moves items by their own routes alone, without a look at what that costs.
        self._ejects = problem.timeless and not problem.spans and (problem.items.carrier < 0).all()

    @property
    def best(self) -> Plan | None:
        """The cheapest complete plan; None as long as not every item has a place."""
        best = self.state.best
        known = self.state.value[BEST] < inf and not (best.transfers == BANKED).any()
        return best if known else None

    def run(self, seconds: float, transfers: int) -> None:
        """Search for so long; `transfers`: how often one item may change robots."""
        ends_s = self._clock() + seconds
        if self.state.value[BEST] == inf:
            self.place(ends_s)
        if not self.problem.items.size:
            return
        if not transfers and self.best is not None:
            self.free_robots(min(ends_s, self._clock() + FREEING * seconds))
        each = SHARED if transfers else ALONE
        steps, begun_s = 10, self._clock()
        self.take_steps(steps, transfers, (0.0, 0.0))
        pace = steps / max(self._clock() - begun_s, 1e-6)
        left_s = ends_s - self._clock()
        rounds = max(1, round(pace * left_s / (each.steps * self.problem.items.size)))
        for number in range(rounds):
            until_s = ends_s - left_s * (rounds - number - 1) / rounds
            if number % each.restart == 0:
                self._go_back()
            if not transfers and self.best is not None:
                self.free_robots(self._clock() + FREEING * (until_s - self._clock()))
            pace = self._cool(until_s, transfers, pace)

    def begin_with(self, plan: Plan) -> None:
        """Go on from another plan where it is better than the best."""
        if update(self.problem, plan, self.state.sweep):
            self._keep(plan)

    def place(self, ends_s: float) -> None:
        """Give every item a place, as far as that comes about in time."""
        state, problem, items = self.state, self.problem, self.problem.items.size
        state.chosen[:items] = np.arange(items)
        direct = Allowed(0, False, 0.0)
        repair(problem, state, self._rng, int(Repair.REGRET_2), direct, (items, inf))
        copy_plan(state.trial, state.current)
        left = np.flatnonzero(state.current.transfers == BANKED)
        if left.size and self._ejects:
            self._ejection.pool[: left.size] = left
            self._ejection.known[0] = left.size
            self._ejection.allowed[:] = True
            if not self._eject_until(ends_s, None):
                copy_plan(state.trial, state.current)
        self._keep(state.current)

    def free_robots(self, ends_s: float) -> None:
        """Bring what one robot does to the others, and another one's, as long as there is time."""
        plan, robots = self.state.current, self.problem.robots.size
        while self._ejects and self.problem.weight_robots > 0 and self._clock() < ends_s:
            used = np.flatnonzero(plan.rows.length[:robots] > 2)
            if used.size < 2 or plan.handed[0] or (plan.transfers == BANKED).any():
                return
            likely = 1.0 / (plan.rows.length[used] - 1.0)
            robot = self._generator.choice(used, p=likely / likely.sum())
            empty_route(self.problem, self.state, self._ejection, robot)
            if self._eject_until(ends_s, TRIES * self.problem.items.size):
                self._keep(plan)
            else:
                self._go_back()

    def take_steps(self, steps: int, transfers: int, span: tuple[float, float]) -> None:
        """Anneal through a part of a round, which lasts from 0 to 1."""
        warm = self._warm()
        temperatures = (warm * COOLED ** span[0], warm * COOLED ** span[1])
        anneal(
            self.problem, self.state, self._operators, self._rng, transfers,
            (steps, *temperatures),
        )  # fmt: skip
        self._report()

    def _cool(self, ends_s: float, transfers: int, pace: float) -> float:
        """One round until a time of the clock; `pace` and what is returned: steps a second."""
        begun_s = now_s = self._clock()
        length_s = ends_s - begun_s
        while now_s < ends_s:
            slice_s = min(SLICE_S, ends_s - now_s)
            steps = max(1, int(pace * slice_s))
            spent = (now_s - begun_s) / length_s
            self.take_steps(steps, transfers, (spent, spent + slice_s / length_s))
            before_s, now_s = now_s, self._clock()
            pace = _pace(pace, steps, now_s - before_s)
        return pace

    def _eject_until(self, ends_s: float, most: int | None) -> bool:
        """Place what has no place, with about `most` tries; whether that came about."""
        taken = 0
        while True:
            now_s = self._clock()
            tries = max(1, int(self._tries_a_s * min(SLICE_S, ends_s - now_s)))
            if place_all(self.problem, self.state, self._rng, self._ejection, tries):
                return True
            tries = int(self._ejection.tried[0])
            taken += tries
            after_s = self._clock()
            self._tries_a_s = _pace(self._tries_a_s, tries, after_s - now_s)
            if after_s >= ends_s or (most is not None and taken >= most):
                return False

    def _keep(self, plan: Plan) -> None:
        """Make a plan the best where it is cheaper, and let the search stand at the best."""
        state = self.state
        value = plan_value(self.problem, plan)
        if value < state.value[BEST]:
            state.value[BEST] = value
            copy_plan(plan, state.best)
        self._go_back()
        self._report()

    def _go_back(self) -> None:
        """Let the search stand at the best plan."""
        self.state.value[CURRENT] = self.state.value[BEST]
        copy_plan(self.state.best, self.state.current)

    def _warm(self) -> float:
        """The temperature at which a round begins; undelivered items and robots aside."""
        problem, plan = self.problem, self.state.best
        banked = int((plan.transfers == BANKED).sum())
        robots = problem.weight_robots * float((plan.rows.length[:-1] > 2).sum())
        spent = float(self.state.value[BEST]) - banked * problem.penalty - robots
        return max(WORSE * spent / log(2), 1e-6)

    def _report(self) -> None:
        value = float(self.state.value[BEST])
        if self._tell is None or value >= self._told or self.best is None:
            return
        self._told = value
        self._tell(value)


def _pace(before: float, steps: int, lasted_s: float) -> float:
    """Steps a second, from what was known and what was just seen."""
    return 0.5 * (before + min(4 * before, steps / max(lasted_s, 1e-6)))
