"""Where in a route an item can go in: every pair of positions, each judged in constant time."""

from math import inf
from typing import NamedTuple, cast

import numpy as np

from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.dice import Dice, throw
from mend.fleet.scheduling.routing.arrays import NOBODY, Floats, Integers, RoutingArrays
from mend.fleet.scheduling.routing.plan import Plan

CHEAPEST, ANY, FIRST, CHEAP = (cast(int, np.int64(wanted)) for wanted in range(4))
"""Which place is wanted: the cheapest, one by chance, the first that is found, or the cheapest of
those that were not overlooked.

No plain numbers, as a kernel would be compiled once more for every one."""

TOLERANCE = 1e-8
OVERLOOKED = 0.1
"""The share of places that is overlooked where any is."""


class Places(NamedTuple):
    """By item and row: what the best place costs more, and where it is, for a version of the row.

    What is known is kept until the row is another one.
    """

    version: Integers
    extra: Floats
    pick: Integers
    drop: Integers


def places_for(arrays: RoutingArrays) -> Places:
    """Nothing is known yet."""
    shape = (arrays.near.shape[0], arrays.capacity.size + 1)
    return Places(
        np.full(shape, -1, np.int64), np.zeros(shape), np.zeros(shape, np.int64),
        np.zeros(shape, np.int64),
    )  # fmt: skip


@compiled
def extra_cost(
    arrays: RoutingArrays, plan: Plan, places: Places, dice: Dice, item: int, robot: int
) -> float:
    """What the cheapest place of an item in a robot's route costs more; infinite without one."""
    if places.version[item, robot] != plan.version[robot]:
        if _useless(arrays, plan, robot):
            return inf
        find_place(arrays, plan, places, dice, item, robot, robot, CHEAPEST)
        places.version[item, robot] = plan.version[robot]
    return float(places.extra[item, robot])


@compiled
def _useless(arrays: RoutingArrays, plan: Plan, robot: int) -> bool:
    """Whether a robot need not be looked at: its twin is as free as it is."""
    twin = arrays.twin[robot]
    return bool(twin != NOBODY and plan.length[robot] == 2 and plan.length[twin] == 2)


@compiled
def find_place(
    arrays: RoutingArrays, plan: Plan, places: Places, dice: Dice,
    item: int, row: int, robot: int, wanted: int,
) -> float:  # fmt: skip
    """Write a place of an item in a row into `places`; returns what it costs more.

    Costs and times are taken to obey the triangle inequality: where they do not, some places are
    missed, but none is wrong.
    """
    cost, time_s, service_s = arrays.cost, arrays.time_s, arrays.service_s
    pace, capacity = arrays.pace[robot], arrays.capacity[robot] + TOLERANCE
    drop = plan.robot.size + item
    last = plan.length[row] - 1
    opening = arrays.robot_cost if last == 1 else 0.0
    load = arrays.load[item]
    by_cost = wanted in (CHEAPEST, CHEAP)
    best = best_rank = inf
    for at in range(last):
        before, after = plan.node[row, at], plan.node[row, at + 1]
        free_s = plan.begin_s[row, at] + service_s[before]
        if free_s > arrays.latest_s[item] + TOLERANCE:
            break
        if plan.load[row, at] + load > capacity:
            continue
        detour = cost[before, item] - cost[before, after]
        if by_cost and detour + cost[item, after] >= best:
            continue
        begin_s = max(free_s + time_s[before, item] * pace, arrays.earliest_s[item])
        if begin_s > arrays.latest_s[item] + TOLERANCE:
            continue
        picked_s = begin_s + service_s[item]
        arrival_s = max(picked_s + time_s[item, drop] * pace, arrays.earliest_s[drop])
        if arrival_s > arrays.latest_s[drop] + TOLERANCE:
            continue
        dropped_s = arrival_s + service_s[drop]
        if dropped_s + time_s[drop, after] * pace <= plan.latest_s[row, at + 1] + TOLERANCE:
            extra = detour + cost[item, drop] + cost[drop, after]
            rank = extra if by_cost else throw(dice)
            if wanted == CHEAP and throw(dice) < OVERLOOKED:
                rank = inf
            if rank < best_rank:
                best, best_rank = extra, rank
                places.pick[item, row], places.drop[item, row] = at, at
                if wanted == FIRST:
                    break
        detour += cost[item, after]
        node = after
        begin_s = max(picked_s + time_s[item, after] * pace, arrays.earliest_s[after])
        for later in range(at + 1, last):
            if begin_s > plan.latest_s[row, later] + TOLERANCE:
                break
            if plan.load[row, later] + load > capacity:
                break
            follower = plan.node[row, later + 1]
            free_s = begin_s + service_s[node]
            arrival_s = max(free_s + time_s[node, drop] * pace, arrays.earliest_s[drop])
            if free_s > arrays.latest_s[drop] + TOLERANCE:
                break
            if arrival_s <= arrays.latest_s[drop] + TOLERANCE:
                dropped_s = arrival_s + service_s[drop]
                onward_s = dropped_s + time_s[drop, follower] * pace
                if onward_s <= plan.latest_s[row, later + 1] + TOLERANCE:
                    extra = detour + cost[node, drop] + cost[drop, follower] - cost[node, follower]
                    rank = extra if by_cost else throw(dice)
                    if wanted == CHEAP and throw(dice) < OVERLOOKED:
                        rank = inf
                    if rank < best_rank:
                        best, best_rank = extra, rank
                        places.pick[item, row], places.drop[item, row] = at, later
                        if wanted == FIRST:
                            break
            begin_s = max(free_s + time_s[node, follower] * pace, arrays.earliest_s[follower])
            node = follower
        if wanted == FIRST and best < inf:
            break
    places.extra[item, row] = best + opening
    places.version[item, row] = -1
    return float(best + opening)
