"""Fewer robots: an item without a place throws others out, the ones that are easy to place.

Guided ejection search (Nagata and Kobayashi 2010): what is often without a place becomes costly to
throw out.
"""

from math import inf
from typing import NamedTuple, cast

import numpy as np

from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.dice import Dice, one_of, shuffle
from mend.fleet.scheduling.routing.arrays import NOBODY, Flags, Integers, RoutingArrays
from mend.fleet.scheduling.routing.places import ANY, FIRST, Places, find_place
from mend.fleet.scheduling.routing.plan import Plan, put, refresh, take_out

HARDEST = cast(int, np.int64(1 << 60))
"""More than any items are hard to place."""
THROWN = 3
"""How many items at most are thrown out for one."""
TRIPLES = 14
"""The longest route (in items) of which three are thrown out."""
MOVES = 40
"""How many items are moved by chance after each ejection."""


class Ejection(NamedTuple):
    """Items without a place (the first `known` of `pool`), how hard each is, who may take any."""

    pool: Integers
    known: Integers
    hardness: Integers
    allowed: Flags
    thrown: Integers
    on_board: Integers


def ejection_for(arrays: RoutingArrays) -> Ejection:
    """Nothing is without a place, and every robot may take items."""
    items, robots = arrays.near.shape[0], arrays.capacity.size
    return Ejection(
        pool=np.zeros(items + 1, np.int64),
        known=np.zeros(1, np.int64),
        hardness=np.ones(items, np.int64),
        allowed=np.ones(robots, np.bool_),
        thrown=np.full(THROWN, NOBODY, np.int64),
        on_board=np.zeros(items + 1, np.int64),
    )


@compiled
def empty_route(arrays: RoutingArrays, plan: Plan, ejection: Ejection, robot: int) -> None:
    """Take everything from a robot, which may take nothing again; only used robots may."""
    ejection.known[0] = 0
    for item in range(plan.robot.size):
        ejection.hardness[item] = 1
        if plan.robot[item] == robot:
            ejection.pool[ejection.known[0]] = item
            ejection.known[0] += 1
    for number in range(ejection.known[0]):
        take_out(arrays, plan, ejection.pool[number])
    for k in range(arrays.capacity.size):
        ejection.allowed[k] = plan.length[k] > 2


@compiled
def place_all(
    arrays: RoutingArrays, plan: Plan, places: Places, dice: Dice, ejection: Ejection, steps: int
) -> bool:
    """Take steps until every item has a place; whether that has come about."""
    for _ in range(steps):
        if ejection.known[0] == 0:
            return True
        ejection.known[0] -= 1
        item = ejection.pool[ejection.known[0]]
        if _place(arrays, plan, places, dice, ejection, item):
            continue
        ejection.hardness[item] += 1
        if not _throw_out_for(arrays, plan, places, dice, ejection, item):
            ejection.pool[ejection.known[0]] = item
            ejection.known[0] += 1
            shuffle(dice, ejection.pool, ejection.known[0])
        for _ in range(MOVES):
            _move_one(arrays, plan, places, dice, ejection)
    return bool(ejection.known[0] == 0)


@compiled
def _place(
    arrays: RoutingArrays, plan: Plan, places: Places, dice: Dice, ejection: Ejection, item: int
) -> bool:
    """Put an item into some route where it has a place."""
    robots = arrays.capacity.size
    first = one_of(dice, robots)
    for number in range(robots):
        robot = (first + number) % robots
        if ejection.allowed[robot] and _put(arrays, plan, places, dice, item, robot):
            return True
    return False


@compiled
def _put(
    arrays: RoutingArrays, plan: Plan, places: Places, dice: Dice, item: int, robot: int
) -> bool:
    if find_place(arrays, plan, places, dice, item, robot, robot, ANY) == inf:
        return False
    pick, drop = places.pick[item, robot], places.drop[item, robot]
    put(arrays, plan, item, robot, robot, pick, drop)
    return True


@compiled
def _move_one(
    arrays: RoutingArrays, plan: Plan, places: Places, dice: Dice, ejection: Ejection
) -> None:
    """Move some item into some other route, if it has a place there."""
    item = one_of(dice, plan.robot.size)
    source, target = plan.robot[item], one_of(dice, arrays.capacity.size)
    if source in (NOBODY, target) or not ejection.allowed[target]:
        return
    if find_place(arrays, plan, places, dice, item, target, target, ANY) < inf:
        take_out(arrays, plan, item)
        pick, drop = places.pick[item, target], places.drop[item, target]
        put(arrays, plan, item, target, target, pick, drop)


@compiled
def _throw_out_for(
    arrays: RoutingArrays, plan: Plan, places: Places, dice: Dice, ejection: Ejection, item: int
) -> bool:
    """Throw out the least hard items so that one has a place, and put it there."""
    robots = arrays.capacity.size
    target, least = NOBODY, HARDEST
    first = one_of(dice, robots)
    for number in range(robots):
        robot = (first + number) % robots
        if ejection.allowed[robot] and plan.length[robot] > 2:
            found = _easiest(arrays, plan, places, dice, ejection, item, robot, least)
            if found < least:
                target, least = robot, found
    if target == NOBODY:
        return False
    for number in range(THROWN):
        out = ejection.thrown[number]
        if out != NOBODY:
            take_out(arrays, plan, out)
            ejection.pool[ejection.known[0]] = out
            ejection.known[0] += 1
    return _put(arrays, plan, places, dice, item, target)


@compiled
def _easiest(
    arrays: RoutingArrays, plan: Plan, places: Places, dice: Dice, ejection: Ejection,
    item: int, robot: int, least: int,
) -> int:  # fmt: skip
    """How hard the easiest items are that can be thrown out of a route, if below `least`.

    Those items are in `ejection.thrown` then.
    """
    count, items, hardness = 0, plan.robot.size, ejection.hardness
    for at in range(1, plan.length[robot] - 1):
        if plan.node[robot, at] < items:
            ejection.on_board[count] = plan.node[robot, at]
            count += 1
    shuffle(dice, ejection.on_board, count)
    for a in range(count):
        one = ejection.on_board[a]
        if hardness[one] >= least:
            continue
        if _fits_without(arrays, plan, places, dice, item, robot, one, NOBODY, NOBODY):
            least = hardness[one]
            _note(ejection, one, NOBODY, NOBODY)
            continue
        for b in range(a + 1, count):
            two = ejection.on_board[b]
            pair = hardness[one] + hardness[two]
            if pair >= least:
                continue
            if _fits_without(arrays, plan, places, dice, item, robot, one, two, NOBODY):
                least = pair
                _note(ejection, one, two, NOBODY)
                continue
            if count > TRIPLES:
                continue
            for c in range(b + 1, count):
                three = ejection.on_board[c]
                if pair + hardness[three] < least and _fits_without(
                    arrays, plan, places, dice, item, robot, one, two, three
                ):
                    least = pair + hardness[three]
                    _note(ejection, one, two, three)
    return int(least)


@compiled
def _note(ejection: Ejection, one: int, two: int, three: int) -> None:
    ejection.thrown[0], ejection.thrown[1], ejection.thrown[2] = one, two, three


@compiled
def _fits_without(
    arrays: RoutingArrays, plan: Plan, places: Places, dice: Dice,
    item: int, robot: int, one: int, two: int, three: int,
) -> bool:  # fmt: skip
    """Whether an item has a place in a route without some others."""
    spare, items = arrays.capacity.size, plan.robot.size
    kept = 0
    for at in range(plan.length[robot]):
        node = plan.node[robot, at]
        who = node - items if items <= node < 2 * items else node
        if node >= 2 * items or who not in (one, two, three):
            plan.node[spare, kept] = node
            kept += 1
    plan.length[spare] = kept
    refresh(arrays, plan, spare, robot)
    return find_place(arrays, plan, places, dice, item, spare, robot, FIRST) < inf
