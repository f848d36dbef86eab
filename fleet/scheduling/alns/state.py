"""Where a search stands: its plans, and room to work in."""

from math import inf
from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.alns.itineraries import Itineraries, itineraries_for
from mend.fleet.scheduling.alns.plan import Plan, copy_plan, empty_plan
from mend.fleet.scheduling.alns.problem_arrays import ProblemArrays
from mend.fleet.scheduling.alns.propagation import Sweep, sweep_for, update
from mend.fleet.scheduling.alns.records import Flags, Floats, Integers

CURRENT, BEST = 0, 1
"""Where `value` has what the plans cost, with the penalty for what is not delivered."""


class State(NamedTuple):
    """The current plan, the one that a step tries, the best, and one to go back to."""

    current: Plan
    trial: Plan
    best: Plan
    kept: Plan
    value: Floats
    sweep: Sweep
    found: Itineraries
    chosen: Integers
    """Items that are to be inserted."""
    picked: Flags
    """By item: whether it is among those that are removed."""


def state_for(problem: ProblemArrays) -> State:
    """A search at the empty plan, everything in the bank."""
    current, *plans = [empty_plan(problem) for _ in range(4)]
    state = State(
        current, plans[0], plans[1], plans[2], np.full(2, inf), sweep_for(problem),
        itineraries_for(problem),
        np.zeros(problem.items.size + 1, np.int64), np.zeros(problem.items.size, np.bool_),
    )  # fmt: skip
    update(problem, current, state.sweep)
    for plan in plans:
        copy_plan(current, plan)
    return state
