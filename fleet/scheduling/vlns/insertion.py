"""Inserting items into a plan: one by its cheapest way that the times allow, or several in turn."""

from math import inf
from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.dice import Dice, shuffle, throw
from mend.fleet.scheduling.vlns.arrays import HOME, TOTAL, Integers, Plan, ProblemArrays, take_out
from mend.fleet.scheduling.vlns.times import Times, find_latest, find_times, find_value
from mend.fleet.scheduling.vlns.ways import Ways, find_ways, follow

NONE = -1


class Manner(NamedTuple):
    """How items are inserted.

    `most`: transfers of one item; `shared`: the first item must change robots; `regret`: first the
    item that would lose most by waiting; `blink`: the share of places that are overlooked.
    """

    most: int
    shared: bool
    regret: bool
    blink: float


@compiled
def refresh(problem: ProblemArrays, plan: Plan, times: Times) -> bool:
    """Times, latest times and value of a plan; False where it cannot be carried out."""
    if not find_times(problem, plan, times):
        return False
    find_latest(problem, plan, times)
    find_value(problem, plan, times)
    return True


@compiled
def insert(
    problem: ProblemArrays, plan: Plan, times: Times, ways: Ways, dice: Dice,
    item: int, fewest: int, most: int, blink: float,
) -> bool:  # fmt: skip
    """Insert an item by the cheapest of its ways, if any is possible.

    Times must be those of the plan, and are so again afterwards.
    """
    find_ways(problem, plan, times, ways, dice, item, fewest, most, blink)
    if ways.known[1] == 0:
        return False
    best, chosen = inf, NONE
    for number in range(ways.known[1]):
        if follow(problem, plan, ways, item, number):
            possible = find_times(problem, plan, times)
            if possible:
                find_value(problem, plan, times)
                if plan.value[TOTAL] < best:
                    best, chosen = plan.value[TOTAL], number
            if possible and problem.timeless:
                find_latest(problem, plan, times)
                return True
            take_out(problem, plan, item)
    if chosen != NONE:
        follow(problem, plan, ways, item, chosen)
    refresh(problem, plan, times)
    return chosen != NONE


@compiled
def insert_all(
    problem: ProblemArrays, plan: Plan, times: Times, ways: Ways, dice: Dice,
    items: Integers, count: int, manner: Manner, limit: float,
) -> int:  # fmt: skip
    """Insert items one by one; how many stay in the bank. Stops at a cost above `limit`."""
    shuffle(dice, items, count)
    banked = 0
    for turn in range(count):
        if manner.regret:
            _most_urgent_first(problem, plan, times, ways, dice, items, turn, count, manner)
        fewest = 1 if turn == 0 and manner.shared else 0
        item = items[turn]
        done = insert(
            problem, plan, times, ways, dice, item, fewest, manner.most, manner.blink
        )  # fmt: skip
        if not done and fewest > 0:
            done = insert(
                problem, plan, times, ways, dice, item, HOME, manner.most, 0.0
            )  # fmt: skip
        if not done:
            banked += 1
        if plan.value[TOTAL] + banked * problem.penalty > limit:
            return banked + count - turn - 1
    return banked


@compiled
def _most_urgent_first(
    problem: ProblemArrays, plan: Plan, times: Times, ways: Ways, dice: Dice,
    items: Integers, turn: int, count: int, manner: Manner,
) -> None:  # fmt: skip
    """Swap the item whose second best way costs most more than its best to its turn."""
    best, chosen = -inf, turn
    for other in range(turn, count):
        find_ways(
            problem, plan, times, ways, dice, items[other], HOME, manner.most, manner.blink
        )  # fmt: skip
        regret = problem.penalty
        if ways.known[1] > 0:
            for number in range(1, ways.known[1]):
                if ways.last[number, 1] != ways.last[0, 1]:
                    regret = ways.extra[number] - ways.extra[0]
                    break
        regret *= 0.5 + throw(dice)
        if regret > best:
            best, chosen = regret, other
    items[turn], items[chosen] = items[chosen], items[turn]


def items_room(problem: ProblemArrays) -> Integers:
    """Room for the numbers of all items."""
    return np.zeros(problem.load.size, np.int64)
