"""Adaptive large neighbourhood search: the ways that have helped are drawn more often."""

from math import inf, log
from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.dice import Dice, one_of, throw
from mend.fleet.scheduling.routing.arrays import Flags, Floats, Integers, RoutingArrays
from mend.fleet.scheduling.routing.insertion import INSERTIONS, insert_items
from mend.fleet.scheduling.routing.places import Places, places_for
from mend.fleet.scheduling.routing.plan import (
    Plan,
    Undo,
    changed_by,
    copy_plan,
    empty_plan,
    plan_cost,
    restore,
    settle,
    undo_for,
)
from mend.fleet.scheduling.routing.removal import REMOVALS, remove_items

FEWEST, MANY, MOST = 1, 8, 30
"""How many items are taken out in one step: from the first number to the second at least, and to
the third where that is not more than `SHARE` of all items."""
SHARE = 0.35
SHUT = 0.05
"""In which share of the steps some robots take nothing."""
LEARNING = 0.002
"""How much of a way's weight is new after each step."""
CURRENT, BEST = 0, 1
"""Where `value` has the costs of the plans."""


class Search(NamedTuple):
    """Where a search stands: plans, their costs, room to work in, and what has helped so far."""

    current: Plan
    best: Plan
    value: Floats
    undo: Undo
    places: Places
    chosen: Integers
    shut: Flags
    """By robot: whether it takes nothing in this step."""
    removal_weight: Floats
    insertion_weight: Floats


def search_for(arrays: RoutingArrays) -> Search:
    """A search that stands at the empty plan, and knows no complete one."""
    plan = empty_plan(arrays)
    return Search(
        current=plan,
        best=empty_plan(arrays),
        value=np.full(2, inf),
        undo=undo_for(plan),
        places=places_for(arrays),
        chosen=np.zeros(plan.robot.size + 1, np.int64),
        shut=np.zeros(arrays.capacity.size, np.bool_),
        removal_weight=np.ones(REMOVALS),
        insertion_weight=np.ones(INSERTIONS),
    )


@compiled
def anneal(
    arrays: RoutingArrays, search: Search, dice: Dice, steps: int, warm: float, cool: float
) -> None:
    """Take steps from a complete plan while the temperature falls from `warm` to `cool`."""
    search.value[CURRENT] = plan_cost(search.current)
    for step in range(steps):
        heat = warm * (cool / warm) ** (step / steps)
        removal = _drawn(search.removal_weight, dice)
        insertion = _drawn(search.insertion_weight, dice)
        gained = take_step(arrays, search, dice, removal, insertion, heat)
        _learn(search.removal_weight, removal, gained)
        _learn(search.insertion_weight, insertion, gained)


@compiled
def take_step(
    arrays: RoutingArrays, search: Search, dice: Dice, removal: int, insertion: int, heat: float
) -> float:
    """Take out and put in once; how much that has helped: 0 for nothing, up to 1 for a new best."""
    plan, undo, value = search.current, search.undo, search.value
    largest = min(plan.robot.size, max(MANY, min(MOST, int(SHARE * plan.robot.size))))
    wanted = FEWEST + one_of(dice, largest - FEWEST + 1)
    limit = -heat * log(1.0 - throw(dice))
    _shut_some(search.shut, dice)
    count = remove_items(arrays, plan, undo, dice, removal, wanted, search.chosen)
    left = insert_items(
        arrays, plan, undo, search.places, dice, insertion, search.shut, search.chosen, count, limit
    )
    change = changed_by(plan, undo)
    if left > 0 or change >= limit:
        restore(arrays, plan, undo)
        return 0.0
    settle(undo)
    value[CURRENT] += change
    if value[CURRENT] < value[BEST] - 1e-9:
        value[CURRENT] = value[BEST] = plan_cost(plan)
        copy_plan(plan, search.best)
        return 1.0
    return 0.4 if change < -1e-9 else 0.05


@compiled
def _shut_some(shut: Flags, dice: Dice) -> None:
    """Mostly nobody; at times half of the robots, so that work goes to others as a whole."""
    seldom = throw(dice) < SHUT
    for robot in range(shut.size):
        shut[robot] = seldom and throw(dice) < 0.5


@compiled
def _drawn(weights: Floats, dice: Dice) -> int:
    """One of the ways by chance, according to the weights."""
    total = 0.0
    for way in range(weights.size):
        total += weights[way]
    mark = throw(dice) * total
    for way in range(weights.size - 1):
        mark -= weights[way]
        if mark < 0:
            return way
    return int(weights.size - 1)


@compiled
def _learn(weights: Floats, way: int, gained: float) -> None:
    weights[way] = max(0.02, (1 - LEARNING) * weights[way] + LEARNING * gained)
