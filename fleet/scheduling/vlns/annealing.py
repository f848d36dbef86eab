"""Simulated annealing: remove items, insert them again, keep the better, at times the worse."""

from math import inf, log
from typing import NamedTuple

from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.dice import Dice, one_of, throw
from mend.fleet.scheduling.vlns.arrays import (
    BANKED,
    TOTAL,
    Integers,
    Plan,
    ProblemArrays,
    copy_plan,
    empty_plan,
    take_out,
)
from mend.fleet.scheduling.vlns.insertion import Manner, insert_all, items_room, refresh
from mend.fleet.scheduling.vlns.removal import choose_items
from mend.fleet.scheduling.vlns.times import Times, times_for
from mend.fleet.scheduling.vlns.ways import Ways, lift_bars, ways_for

TRIED = 12
"""How many items of the bank are tried in one step."""


class Search(NamedTuple):
    """Where a search stands: plans (`value` with the penalty of the bank) and room to work in."""

    current: Plan
    trial: Plan
    best: Plan
    times: Times
    ways: Ways
    chosen: Integers


def search_for(problem: ProblemArrays) -> Search:
    """A search that stands at the empty plan, everything in the bank."""
    search = Search(
        empty_plan(problem), empty_plan(problem), empty_plan(problem),
        times_for(problem), ways_for(problem), items_room(problem),
    )  # fmt: skip
    search.current.value[TOTAL] = search.best.value[TOTAL] = inf
    return search


@compiled
def anneal(
    problem: ProblemArrays, search: Search, dice: Dice, steps: int, most: int,
    warm: float, cool: float,
) -> None:  # fmt: skip
    """Take steps while the temperature falls from `warm` to `cool` (in units of cost).

    `most`: how often one item may change robots.
    """
    for step in range(steps):
        heat = warm * (cool / warm) ** (step / steps)
        take_step(problem, search, dice, most, heat)


@compiled
def take_step(
    problem: ProblemArrays, search: Search, dice: Dice, most: int, heat: float
) -> bool:  # fmt: skip
    """Remove and insert once; whether the current plan became another one."""
    current, trial, times, chosen = search.current, search.trial, search.times, search.chosen
    limit = current.value[TOTAL] - heat * log(1.0 - throw(dice))
    copy_plan(current, trial)
    if not refresh(problem, trial, times):
        return False
    count = choose_items(problem, trial, times, dice, chosen, search.ways.barred)
    for at in range(count):
        take_out(problem, trial, chosen[at])
    if not refresh(problem, trial, times):
        lift_bars(search.ways)
        return False
    banked = 0
    for item in range(trial.transfers.size):
        if current.transfers[item] == BANKED:
            banked += 1
            if banked <= TRIED:
                chosen[count] = item
                count += 1
            else:
                other = one_of(dice, banked)
                if other < TRIED:
                    chosen[count - 1 - other] = item
    if count == 0:
        return False
    manner = _manner(dice, most)
    left = insert_all(
        problem, trial, times, search.ways, dice, chosen, count, manner,
        limit - max(0, banked - TRIED) * problem.penalty,
    )  # fmt: skip
    lift_bars(search.ways)
    left += max(0, banked - TRIED)
    trial.value[TOTAL] += left * problem.penalty
    if not trial.value[TOTAL] < limit:
        return False
    copy_plan(trial, current)
    if trial.value[TOTAL] < search.best.value[TOTAL]:
        copy_plan(trial, search.best)
    return True


@compiled
def _manner(dice: Dice, most: int) -> Manner:
    """How the next items are inserted: mostly plainly, at times with chains of transfers."""
    bold = throw(dice)
    allowed = 0
    if most > 0 and bold >= 0.2:
        allowed = 1 if bold < 0.8 else most
    shared = allowed > 0 and throw(dice) < 0.12
    regret = throw(dice) < 0.2
    blink = 0.0 if throw(dice) < 0.5 else 0.05
    return Manner(allowed, shared, regret, blink)
