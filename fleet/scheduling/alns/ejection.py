"""Fewer robots: an item without a place ejects others, the ones that are easy to place.

Guided ejection search (Nagata and Kobayashi 2010): what is often without a place becomes costly to
eject. It knows no transfers and no spans of time.
"""

from math import inf
from typing import NamedTuple, cast

import numpy as np

from mend.fleet.scheduling.alns.itineraries import direct_slot, look_up
from mend.fleet.scheduling.alns.legs import Wanted, find_legs, open_home
from mend.fleet.scheduling.alns.plan import BANKED, Plan, copy_route, put, take_out
from mend.fleet.scheduling.alns.problem_arrays import NOBODY, ProblemArrays
from mend.fleet.scheduling.alns.propagation import update, update_row
from mend.fleet.scheduling.alns.records import Flags, Integers
from mend.fleet.scheduling.alns.state import State
from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.rng import Rng, below, shuffle

HARDEST = cast(int, np.int64(1 << 60))
"""More than any items are hard to place."""
EJECTED = 3
"""How many items at most are ejected for one."""
TRIPLES = 14
"""The longest route (in items) of which three are ejected."""
MOVES = 40
"""How many items are moved by chance after each ejection."""


class Ejection(NamedTuple):
    """Items without a place (the first `known` of `pool`), how hard each is, who may take any."""

    pool: Integers
    known: Integers
    hardness: Integers
    allowed: Flags
    ejected: Integers
    on_board: Integers
    tried: Integers
    """How many sets of items were tried to be ejected."""


def ejection_for(problem: ProblemArrays) -> Ejection:
    """Nothing is without a place, and every robot may take items."""
    items, robots = problem.items.size, problem.robots.size
    return Ejection(
        pool=np.zeros(items + 1, np.int64),
        known=np.zeros(1, np.int64),
        hardness=np.ones(items, np.int64),
        allowed=np.ones(robots, np.bool_),
        ejected=np.full(EJECTED, NOBODY, np.int64),
        on_board=np.zeros(items + 1, np.int64),
        tried=np.zeros(1, np.int64),
    )


@compiled
def empty_route(problem: ProblemArrays, state: State, ejection: Ejection, robot: int) -> None:
    """Take everything from a robot, which may take nothing again; only used robots may."""
    plan, items = state.current, problem.items.size
    ejection.known[0] = 0
    for item in range(items):
        ejection.hardness[item] = 1
        if plan.transfers[item] != BANKED and plan.tasks[items + item].row == robot:
            ejection.pool[ejection.known[0]] = item
            ejection.known[0] += 1
    for number in range(ejection.known[0]):
        take_out(problem, plan, ejection.pool[number])
    update(problem, plan, state.sweep)
    for row in range(problem.robots.size):
        ejection.allowed[row] = plan.rows[row].length > 2


@compiled
def place_all(
    problem: ProblemArrays, state: State, rng: Rng, ejection: Ejection, most: int
) -> bool:
    """Go on until every item has a place, or about so many sets of items were tried to be ejected;
    whether every item has a place."""
    ejection.tried[0] = 0
    while ejection.known[0] > 0 and ejection.tried[0] < most:
        ejection.tried[0] += 1
        ejection.known[0] -= 1
        item = ejection.pool[ejection.known[0]]
        if _place(problem, state, rng, ejection, item):
            continue
        ejection.hardness[item] += 1
        if not _eject_for(problem, state, rng, ejection, item):
            ejection.pool[ejection.known[0]] = item
            ejection.known[0] += 1
            shuffle(rng, ejection.pool, ejection.known[0])
        for _ in range(MOVES):
            _move_one(problem, state, rng, ejection)
    return bool(ejection.known[0] == 0)


@compiled
def _place(problem: ProblemArrays, state: State, rng: Rng, ejection: Ejection, item: int) -> bool:
    """Put an item into some route where it has a place."""
    robots = problem.robots.size
    first = below(rng, robots)
    for number in range(robots):
        row = (first + number) % robots
        if ejection.allowed[row] and _has_place(problem, state, item, row):
            _put(problem, state, rng, item, row)
            return True
    return False


@compiled
def _has_place(problem: ProblemArrays, state: State, item: int, row: int) -> bool:
    open_home(problem, state.found.ends, item)
    look_up(problem, state.current, state.found, item, row)
    return state.found.legs.slots[direct_slot(state.current, item, row)].known > 0  # type: ignore[no-any-return]


@compiled
def _put(problem: ProblemArrays, state: State, rng: Rng, item: int, row: int) -> None:
    """Put an item at one of its places in a route."""
    plan, legs = state.current, state.found.legs
    slot = direct_slot(plan, item, row)
    rank, drop = below(rng, legs.slots[slot].known), problem.items.size + item
    put(plan, row, legs.ranked[slot, rank].unload_at, drop, problem.nodes[drop].place)
    put(plan, row, legs.ranked[slot, rank].load_at, item, problem.nodes[item].place)
    plan.transfers[item] = 0
    update(problem, plan, state.sweep)


@compiled
def _move_one(problem: ProblemArrays, state: State, rng: Rng, ejection: Ejection) -> None:
    """Move some item into some other route, if it has a place there."""
    plan = state.current
    item, target = below(rng, problem.items.size), below(rng, problem.robots.size)
    if plan.transfers[item] == BANKED or plan.tasks[problem.items.size + item].row == target:
        return
    if ejection.allowed[target] and _has_place(problem, state, item, target):
        take_out(problem, plan, item)
        _put(problem, state, rng, item, target)


@compiled
def _eject_for(
    problem: ProblemArrays, state: State, rng: Rng, ejection: Ejection, item: int
) -> bool:
    """Eject the least hard items so that one has a place, and put it there."""
    robots = problem.robots.size
    target, least = NOBODY, HARDEST
    first = below(rng, robots)
    for number in range(robots):
        row = (first + number) % robots
        if ejection.allowed[row] and state.current.rows[row].length > 2:
            found = _easiest(problem, state, rng, ejection, (item, row, least))
            if found < least:
                target, least = row, found
    if target == NOBODY:
        return False
    for number in range(EJECTED):
        out = ejection.ejected[number]
        if out != NOBODY:
            take_out(problem, state.current, out)
            ejection.pool[ejection.known[0]] = out
            ejection.known[0] += 1
    update(problem, state.current, state.sweep)
    if not _has_place(problem, state, item, target):
        return False
    _put(problem, state, rng, item, target)
    return True


@compiled
def _easiest(
    problem: ProblemArrays, state: State, rng: Rng, ejection: Ejection, case: tuple[int, int, int]
) -> int:
    """How hard the easiest items are that can be ejected for an item, if below `least`.

    Those items are in `ejection.ejected` then.
    """
    (item, row, least), hardness = case, ejection.hardness
    count, items, plan = 0, problem.items.size, state.current
    for at in range(1, plan.rows[row].length - 1):
        if plan.stops[row, at].node < items:
            ejection.on_board[count] = plan.stops[row, at].node
            count += 1
    shuffle(rng, ejection.on_board, count)
    for a in range(count):
        one = ejection.on_board[a]
        if hardness[one] >= least:
            continue
        ejection.tried[0] += 1
        if _fits_without(problem, state, item, row, (one, NOBODY, NOBODY)):
            least = hardness[one]
            _note(ejection, one, NOBODY, NOBODY)
            continue
        for b in range(a + 1, count):
            two = ejection.on_board[b]
            pair = hardness[one] + hardness[two]
            if pair >= least:
                continue
            ejection.tried[0] += 1
            if _fits_without(problem, state, item, row, (one, two, NOBODY)):
                least = pair
                _note(ejection, one, two, NOBODY)
                continue
            if count > TRIPLES:
                continue
            for c in range(b + 1, count):
                three = ejection.on_board[c]
                if pair + hardness[three] >= least:
                    continue
                ejection.tried[0] += 1
                if _fits_without(problem, state, item, row, (one, two, three)):
                    least = pair + hardness[three]
                    _note(ejection, one, two, three)
    return int(least)


@compiled
def _note(ejection: Ejection, one: int, two: int, three: int) -> None:
    ejection.ejected[0], ejection.ejected[1], ejection.ejected[2] = one, two, three


@compiled
def _fits_without(
    problem: ProblemArrays, state: State, item: int, row: int, out: tuple[int, int, int]
) -> bool:
    """Whether an item has a place in a route without some others."""
    plan, found, spare = state.current, state.found, problem.robots.size
    copy_route(plan, row, spare)
    _leave_out(problem, plan, spare, out)
    update_row(problem, plan, state.sweep, spare)
    open_home(problem, found.ends, item)
    slot = direct_slot(plan, item, spare)
    find_legs(problem, plan, found.ends, found.legs, Wanted(slot, spare, item, 0, 0, inf, 1, True))
    return found.legs.slots[slot].known > 0  # type: ignore[no-any-return]


@compiled
def _leave_out(problem: ProblemArrays, plan: Plan, row: int, out: tuple[int, int, int]) -> None:
    kept = 0
    for at in range(plan.rows[row].length):
        node = plan.stops[row, at].node
        if problem.nodes[node].item_of == NOBODY or problem.nodes[node].item_of not in out:
            plan.stops[row, kept].node = node
            kept += 1
    plan.rows[row].length = kept
