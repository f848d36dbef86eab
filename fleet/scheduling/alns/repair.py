"""How items are inserted again: greedily in some order, or by regret, the most urgent first."""

from enum import IntEnum
from math import inf

from mend.fleet.scheduling.alns.itineraries import (
    Allowed,
    direct_slot,
    find_itineraries,
    follow,
    look_up,
    unroll,
)
from mend.fleet.scheduling.alns.legs import open_home
from mend.fleet.scheduling.alns.plan import copy_plan, plan_value
from mend.fleet.scheduling.alns.problem_arrays import NOBODY, ProblemArrays
from mend.fleet.scheduling.alns.propagation import update
from mend.fleet.scheduling.alns.state import State
from mend.fleet.scheduling.compiled import compiled, inlined
from mend.fleet.scheduling.rng import Rng, shuffle, uniform


class Repair(IntEnum):
    """The repair operators."""

    GREEDY = 0
    DEADLINE = 1
    REGRET_2 = 2
    REGRET_3 = 3


@compiled
def insert(problem: ProblemArrays, state: State, rng: Rng, item: int, allowed: Allowed) -> bool:
    """Insert an item into the trial plan by the cheapest of its itineraries, if any is possible."""
    plan, found = state.trial, state.found
    find_itineraries(problem, plan, found, rng, item, allowed)
    copied, best, chosen = False, inf, NOBODY
    for number in range(found.known[0]):
        alone = plan.handed[0] == 0 and problem.spans == 0 and problem.timeless
        transfers = unroll(found, number)
        if not (alone and transfers == 0) and not copied:
            copy_plan(plan, state.kept)
            copied = True
        if not follow(problem, plan, found, item, transfers):
            continue
        if update(problem, plan, state.sweep):
            if problem.timeless:
                return True
            value = plan_value(problem, plan)
            if value < best:
                best, chosen = value, number
        copy_plan(state.kept, plan)
    if chosen == NOBODY:
        return False
    follow(problem, plan, found, item, unroll(found, chosen))
    return update(problem, plan, state.sweep)


@compiled
def repair(
    problem: ProblemArrays, state: State, rng: Rng, operator: int, allowed: Allowed,
    todo: tuple[int, float],
) -> None:  # fmt: skip
    """Insert so many of the chosen items into the trial plan; stops at a cost above the limit."""
    count, limit = todo
    shuffle(rng, state.chosen, count)
    if operator == Repair.DEADLINE:
        _by_deadline(problem, state, count)
    for turn in range(count):
        if operator in (Repair.REGRET_2, Repair.REGRET_3):
            _most_regretted(problem, state, rng, turn, count, operator == Repair.REGRET_3)
        item = state.chosen[turn]
        must = allowed.must and turn == 0
        done = insert(problem, state, rng, item, Allowed(allowed.transfers, must, allowed.blink))
        if must and not done:
            insert(problem, state, rng, item, Allowed(allowed.transfers, not must, 0.0))
        # What is still to be inserted is in the bank as well.
        if plan_value(problem, state.trial) - (count - turn - 1) * problem.penalty > limit:
            return


@compiled
def _by_deadline(problem: ProblemArrays, state: State, count: int) -> None:
    """Order by what is least free: the item with the shortest time first."""
    chosen, items = state.chosen, problem.items.size
    for at in range(1, count):
        item = chosen[at]
        spare_s = problem.nodes[items + item].latest_s - problem.nodes[item].earliest_s
        before = at - 1
        while before >= 0:
            other = chosen[before]
            if problem.nodes[items + other].latest_s - problem.nodes[other].earliest_s <= spare_s:
                break
            chosen[before + 1] = other
            before -= 1
        chosen[before + 1] = item


@compiled
def _most_regretted(
    problem: ProblemArrays, state: State, rng: Rng, turn: int, count: int, deep: bool
) -> None:
    """Swap the item to its turn that would lose most if its best robot, or the best two, were gone;
    transfers aside."""
    most, first, least, chosen = -1.0, turn, inf, state.chosen
    for number in range(turn, count):
        best, second, third = _best_robots(problem, state, chosen[number])
        regret = min(second, problem.penalty) - min(best, problem.penalty)
        if deep:
            regret += min(third, problem.penalty) - min(best, problem.penalty)
        if best == inf:
            regret = 2 * problem.penalty
        regret *= 0.9 + 0.2 * uniform(rng)
        if regret > most or (regret == most and best < least):
            most, first, least = regret, number, best
    chosen[turn], chosen[first] = chosen[first], chosen[turn]


@inlined
def _best_robots(problem: ProblemArrays, state: State, item: int) -> tuple[float, float, float]:
    """What the item costs with the three robots that would bring it cheapest alone."""
    plan, found = state.trial, state.found
    best = second = third = inf
    open_home(problem, found.ends, item)
    for row in range(problem.robots.size):
        if found.shut[row] or problem.items[item].carrier not in (NOBODY, row):
            continue
        twin = problem.robots[row].twin
        if twin != NOBODY and plan.rows[row].length == 2 and plan.rows[twin].length == 2:
            continue
        look_up(problem, plan, found, item, row)
        slot = direct_slot(plan, item, row)
        if found.legs.slots[slot].known == 0:
            continue
        extra = found.legs.ranked[slot, 0].extra
        if extra < best:
            best, second, third = extra, best, second
        elif extra < second:
            second, third = extra, second
        elif extra < third:
            third = extra
    return best, second, third
