"""How a search goes on in time: everything placed, robots freed, rounds of cooling."""

from collections.abc import Callable
from math import inf

import numpy as np

from mend.fleet.scheduling.dice import Dice, dice_from
from mend.fleet.scheduling.routing.annealing import BEST, CURRENT, Search, anneal, search_for
from mend.fleet.scheduling.routing.arrays import RoutingArrays
from mend.fleet.scheduling.routing.ejection import Ejection, ejection_for, empty_route, place_all
from mend.fleet.scheduling.routing.insertion import insert_items
from mend.fleet.scheduling.routing.plan import Plan, copy_plan, plan_cost, settle

WARM, COOL = 0.5, 0.005
"""The temperatures of a round, in units of what an item costs on average."""
ROUND_STEPS = 1500
"""How many steps per item a round of cooling should have."""
FIRST_FEWER, FEWER = 0.15, 0.15
"""The share of all the time, and of each round, in which robots are to be freed."""
TRIES = 50
"""How many ejections per item one attempt to free a robot may take."""
FEW_STEPS = 50
SLICE_S = 0.1
"""How long the kernels run before the clock is looked at (seconds)."""
REGRET = 2
"""The way of insertion that builds the first plan."""


class Rounds:
    """One search with its clock, and `tell` for every better cost."""

    def __init__(
        self,
        arrays: RoutingArrays,
        seed: int,
        clock: Callable[[], float],
        tell: Callable[[float], None] | None = None,
    ) -> None:
        self.arrays = arrays
        self.search: Search = search_for(arrays)
        self._ejection: Ejection = ejection_for(arrays)
        self._generator = np.random.default_rng(seed)
        self._dice: Dice = dice_from(self._generator)
        self._clock = clock
        self._tell = tell
        self._told = inf
        self._steps_a_s = 100.0
        self._ejections_a_s = 100.0

    @property
    def best(self) -> Plan | None:
        """The cheapest plan; None as long as not every item has a place."""
        return self.search.best if self.search.value[BEST] < inf else None

    def run(self, seconds: float) -> None:
        """Search until the time is over."""
        ends_s = self._clock() + seconds
        if self.best is None and not self.place(ends_s):
            return
        items = self.search.current.robot.size
        if not items:
            return
        self.free_robots(min(ends_s, self._clock() + FIRST_FEWER * seconds))
        self._find_pace()
        while (left_s := ends_s - self._clock()) > 0:
            rounds = max(1, round(self._steps_a_s * left_s / (ROUND_STEPS * items)))
            begun_s = self._clock()
            copy_plan(self.search.best, self.search.current)
            self.free_robots(begun_s + FEWER * left_s / rounds)
            self._cool_until(begun_s + left_s / rounds)

    def place(self, ends_s: float) -> bool:
        """Give every item a place; whether that came about in time."""
        search, ejection = self.search, self._ejection
        plan, items = search.current, search.current.robot.size
        ejection.pool[:items] = np.arange(items)
        ejection.known[0] = insert_items(
            self.arrays, plan, search.undo, search.places, self._dice, REGRET, search.shut,
            ejection.pool, items, inf,
        )  # fmt: skip
        settle(search.undo)
        ejection.allowed[:] = True
        if self._eject_until(ends_s, None):
            self.keep()
            return True
        return False

    def keep(self) -> None:
        """Make the current plan, which is complete, the best where it is cheaper."""
        search = self.search
        search.value[CURRENT] = plan_cost(search.current)
        if search.value[CURRENT] < search.value[BEST]:
            search.value[BEST] = search.value[CURRENT]
            copy_plan(search.current, search.best)
        self._report()

    def free_robots(self, ends_s: float) -> None:
        """Bring what one robot does to the others, and another one's, as long as there is time."""
        search, arrays = self.search, self.arrays
        while arrays.robot_cost > 0 and self._clock() < ends_s:
            used = np.flatnonzero(search.current.length[:-1] > 2)
            if used.size < 2:
                return
            lengths = search.current.length[used]
            likely = 1.0 / (lengths - 1.0)
            robot = self._generator.choice(used, p=likely / likely.sum())
            empty_route(arrays, search.current, self._ejection, robot)
            if self._eject_until(ends_s, TRIES * search.current.robot.size):
                self.keep()
            else:
                copy_plan(search.best, search.current)

    def _eject_until(self, ends_s: float, most: int | None) -> bool:
        """Place what has no place, with `most` ejections; whether that came about."""
        search, taken = self.search, 0
        while True:
            now_s = self._clock()
            steps = max(1, int(self._ejections_a_s * min(SLICE_S, ends_s - now_s)))
            if place_all(
                self.arrays, search.current, search.places, self._dice, self._ejection, steps
            ):
                return True
            taken += steps
            after_s = self._clock()
            self._ejections_a_s = _pace(self._ejections_a_s, steps, after_s - now_s)
            if after_s >= ends_s or (most is not None and taken >= most):
                return False

    def _find_pace(self) -> None:
        """How many steps a second there are, from a few of them."""
        begun_s = self._clock()
        self.take_steps(FEW_STEPS, 1.0, 1.0)
        self._steps_a_s = FEW_STEPS / max(self._clock() - begun_s, 1e-3)

    def _cool_until(self, ends_s: float) -> None:
        """One round: the temperature falls until a time of the clock."""
        begun_s = now_s = self._clock()
        length_s = ends_s - begun_s
        while now_s < ends_s:
            slice_s = min(SLICE_S, ends_s - now_s)
            steps = max(1, int(self._steps_a_s * slice_s))
            spent, share = (now_s - begun_s) / length_s, (now_s + slice_s - begun_s) / length_s
            self.take_steps(steps, (COOL / WARM) ** spent, (COOL / WARM) ** share)
            before_s, now_s = now_s, self._clock()
            self._steps_a_s = _pace(self._steps_a_s, steps, now_s - before_s)

    def take_steps(self, steps: int, warm: float, cool: float) -> None:
        """Anneal; the temperatures are shares of `WARM`."""
        unit = self._unit() * WARM
        anneal(self.arrays, self.search, self._dice, steps, unit * warm, unit * cool)
        self._report()

    def _unit(self) -> float:
        """What an item costs on average, robots aside."""
        plan = self.search.best
        robots = self.arrays.robot_cost * float((plan.length[:-1] > 2).sum())
        return max((float(self.search.value[BEST]) - robots) / plan.robot.size, 1e-6)

    def _report(self) -> None:
        value = float(self.search.value[BEST])
        if value < self._told:
            self._told = value
            if self._tell is not None:
                self._tell(value)


def _pace(before: float, steps: int, lasted_s: float) -> float:
    """Steps a second, from what was known and what was just seen."""
    return 0.5 * (before + min(4 * before, steps / max(lasted_s, 1e-6)))
