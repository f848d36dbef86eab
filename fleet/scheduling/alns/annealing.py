"""Simulated annealing: remove items, insert them again, keep the better, at times the worse.

Operators that have helped are drawn more often (Ropke and Pisinger 2006).
"""

from math import log
from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.alns.itineraries import Allowed, lift_tabu
from mend.fleet.scheduling.alns.plan import BANKED, copy_plan, plan_value, take_out
from mend.fleet.scheduling.alns.problem_arrays import ProblemArrays
from mend.fleet.scheduling.alns.propagation import update
from mend.fleet.scheduling.alns.records import Floats
from mend.fleet.scheduling.alns.removal import Removal, choose_items
from mend.fleet.scheduling.alns.repair import Repair, repair
from mend.fleet.scheduling.alns.state import BEST, CURRENT, State
from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.rng import Rng, below, uniform
from mend.fleet.scheduling.tolerance import COST

FEW, MANY, MOST, SHARE = 8, 8, 30, 0.35
"""How many items are removed in one step at most: all of few; else `SHARE` of them, but `MANY` at
least and `MOST` at most."""
TRIED = 12
"""How many items of the bank are tried in one step."""
SHUT = 0.05
"""In which share of the steps some robots take nothing."""
DIRECT, CHAINS, MUST = 0.2, 0.2, 0.12
"""In which shares of the steps no item may change robots, or it may as often as allowed, and one
must."""
BLINKING, BLINK = 0.5, 0.05
"""In which share of the steps legs are overlooked, and which share of them."""
LEARNING, LEAST = 0.002, 0.02
"""How much of an operator's weight is new after each step, and the least weight."""


class Operators(NamedTuple):
    """What the operators have been worth lately."""

    removal: Floats
    repair: Floats


def equal_operators() -> Operators:
    """Operators of which nothing is known."""
    return Operators(np.ones(len(Removal)), np.ones(len(Repair)))


@compiled
def anneal(
    problem: ProblemArrays, state: State, operators: Operators, rng: Rng, transfers: int,
    cooling: tuple[int, float, float],
) -> None:  # fmt: skip
    """Take steps while the temperature falls; `transfers`: how often one item may change robots.

    `cooling`: how many steps, from which temperature to which (in units of cost).
    """
    steps, warm, cool = cooling
    for step in range(steps):
        heat = warm * (cool / warm) ** (step / steps)
        removal, repairing = _draw(operators.removal, rng), _draw(operators.repair, rng)
        gain = take_step(problem, state, rng, (removal, repairing), transfers, heat)
        _learn(operators.removal, removal, gain)
        _learn(operators.repair, repairing, gain)


@compiled
def take_step(
    problem: ProblemArrays, state: State, rng: Rng, operators: tuple[int, int], transfers: int,
    heat: float,
) -> float:  # fmt: skip
    """Remove and insert once; how much that has helped: 0 for nothing, 1 for a new best plan."""
    removal, repairing = operators
    trial, value = state.trial, state.value
    limit = value[CURRENT] - heat * log(1.0 - uniform(rng))
    copy_plan(state.current, trial)
    count = choose_items(problem, state, rng, removal, 1 + below(rng, _largest(problem)))
    for number in range(count):
        take_out(problem, trial, state.chosen[number])
    fits = update(problem, trial, state.sweep)
    count = _add_banked(state, rng, count)
    if fits and count > 0:
        _shut_some(state, rng)
        repair(problem, state, rng, repairing, _allowed(rng, transfers), (count, limit))
    lift_tabu(state.found)
    now = plan_value(problem, trial)
    if not fits or not now < limit:
        return 0.0
    gained = value[CURRENT] - now
    value[CURRENT] = now
    copy_plan(trial, state.current)
    if now < value[BEST] - COST:
        value[BEST] = now
        copy_plan(trial, state.best)
        return 1.0
    return 0.4 if gained > COST else 0.05


@compiled
def _largest(problem: ProblemArrays) -> int:
    items = problem.items.size
    return items if items <= FEW else min(items, max(MANY, min(MOST, int(SHARE * items))))


@compiled
def _add_banked(state: State, rng: Rng, count: int) -> int:
    """Choose items of the current plan's bank too, by chance where they are many."""
    first, banked = count, 0
    for item in range(state.picked.size):
        if state.current.transfers[item] != BANKED:
            continue
        banked += 1
        if banked <= TRIED:
            state.chosen[count] = item
            count += 1
        else:
            other = below(rng, banked)
            if other < TRIED:
                state.chosen[first + other] = item
    return count


@compiled
def _shut_some(state: State, rng: Rng) -> None:
    """Mostly nobody; at times half of the robots, so that work goes to others as a whole."""
    seldom = uniform(rng) < SHUT
    for robot in range(state.found.shut.size):
        state.found.shut[robot] = seldom and uniform(rng) < 0.5


@compiled
def _allowed(rng: Rng, transfers: int) -> Allowed:
    """How items are inserted: mostly plainly, at times with chains of transfers."""
    bold = uniform(rng)
    most = min(1, transfers)
    if bold < DIRECT:
        most = 0
    elif bold >= 1.0 - CHAINS:
        most = transfers
    must = most > 0 and uniform(rng) < MUST
    blink = BLINK if uniform(rng) < BLINKING else 0.0
    return Allowed(most, must, blink)


@compiled
def _draw(weights: Floats, rng: Rng) -> int:
    """One of the operators by chance, according to their weights."""
    total = 0.0
    for operator in range(weights.size):
        total += weights[operator]
    mark = uniform(rng) * total
    for operator in range(weights.size - 1):
        mark -= weights[operator]
        if mark < 0:
            return operator
    return int(weights.size - 1)


@compiled
def _learn(weights: Floats, operator: int, gain: float) -> None:
    weights[operator] = max(LEAST, (1 - LEARNING) * weights[operator] + LEARNING * gain)
