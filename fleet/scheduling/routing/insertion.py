"""How items are put in again: in some order each where it costs least, or the most urgent first."""

from math import inf

from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.dice import Dice, shuffle, throw
from mend.fleet.scheduling.routing.arrays import NOBODY, Flags, Integers, RoutingArrays
from mend.fleet.scheduling.routing.places import CHEAP, Places, extra_cost, find_place
from mend.fleet.scheduling.routing.plan import Plan, Undo, changed_by, put, remember

INSERTIONS = 5
BLINK = 0.02
"""How often a robot is overlooked, so that not every item goes where it costs least."""


@compiled
def insert_items(
    arrays: RoutingArrays, plan: Plan, undo: Undo, places: Places, dice: Dice, way: int,
    shut: Flags, chosen: Integers, count: int, limit: float,
) -> int:  # fmt: skip
    """Put the chosen items in, in one of the ways; how many are left, at the front of `chosen`.

    Robots that are `shut` take nothing. Gives up where the changes cost `limit` or more.
    """
    if way in (2, 3):
        return _by_regret(arrays, plan, undo, places, dice, way, shut, chosen, count, limit)
    shuffle(dice, chosen, count)
    if way == 1:
        _last_first(arrays, plan, chosen, count)
    while count > 0:
        item = chosen[count - 1]
        best, robot = inf, NOBODY
        for k in range(arrays.capacity.size):
            if not shut[k] and throw(dice) >= BLINK:
                if way == 4:
                    extra = find_place(arrays, plan, places, dice, item, k, k, CHEAP)
                else:
                    extra = extra_cost(arrays, plan, places, dice, item, k)
                if extra < best:
                    best, robot = extra, k
        if robot == NOBODY:
            return count
        _put(arrays, plan, undo, places, item, robot)
        count -= 1
        if changed_by(plan, undo) >= limit:
            return count
    return 0


@compiled
def _put(
    arrays: RoutingArrays, plan: Plan, undo: Undo, places: Places, item: int, robot: int
) -> None:
    remember(plan, undo, robot)
    pick, drop = places.pick[item, robot], places.drop[item, robot]
    put(arrays, plan, item, robot, robot, pick, drop)


@compiled
def _last_first(arrays: RoutingArrays, plan: Plan, chosen: Integers, count: int) -> None:
    """Order by what is least free: the item with the shortest time is the last one."""
    items = plan.robot.size
    for at in range(1, count):
        item = chosen[at]
        spare_s = arrays.latest_s[items + item] - arrays.earliest_s[item]
        before = at - 1
        while before >= 0:
            other = chosen[before]
            if arrays.latest_s[items + other] - arrays.earliest_s[other] >= spare_s:
                break
            chosen[before + 1] = other
            before -= 1
        chosen[before + 1] = item


@compiled
def _by_regret(
    arrays: RoutingArrays, plan: Plan, undo: Undo, places: Places, dice: Dice, depth: int,
    shut: Flags, chosen: Integers, count: int, limit: float,
) -> int:  # fmt: skip
    """First the item that loses most when the best robots (`depth` of them) are gone."""
    while count > 0:
        first, target, most, least = NOBODY, NOBODY, -1.0, inf
        for number in range(count):
            best = second = third = inf
            robot = NOBODY
            for k in range(arrays.capacity.size):
                if shut[k]:
                    continue
                extra = extra_cost(arrays, plan, places, dice, chosen[number], k)
                if extra < best:
                    best, second, third, robot = extra, best, second, k
                elif extra < second:
                    second, third = extra, second
                elif extra < third:
                    third = extra
            if robot == NOBODY:
                return count
            regret = min(second, 1e9) - best
            if depth > 2:
                regret += min(third, 1e9) - best
            regret *= 0.9 + 0.2 * throw(dice)
            if regret > most or (regret == most and best < least):
                first, target, most, least = number, robot, regret, best
        item = chosen[first]
        _put(arrays, plan, undo, places, item, target)
        count -= 1
        chosen[first] = chosen[count]
        chosen[count] = item
        if changed_by(plan, undo) >= limit:
            return count
    return 0
