"""Which items are taken out: five ways to choose, each good where others are not."""

from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.dice import Dice, one_of, throw
from mend.fleet.scheduling.routing.arrays import NOBODY, Integers, RoutingArrays
from mend.fleet.scheduling.routing.plan import Plan, Undo, remember, take_out

REMOVALS = 5
STRING = 10
"""How many items in a row are taken from one route at most."""


@compiled
def remove_items(
    arrays: RoutingArrays, plan: Plan, undo: Undo, dice: Dice, way: int, wanted: int,
    chosen: Integers,
) -> int:  # fmt: skip
    """Take out about `wanted` items in one of the ways; how many are in `chosen` then."""
    if way == 0:
        return _by_chance(arrays, plan, undo, dice, wanted, chosen)
    if way == 1:
        return _related(arrays, plan, undo, dice, wanted, chosen)
    if way == 2:
        return _strings(arrays, plan, undo, dice, wanted, chosen)
    if way == 3:
        return _costly(arrays, plan, undo, dice, wanted, chosen)
    return _whole_route(arrays, plan, undo, dice, wanted, chosen)


@compiled
def _out(
    arrays: RoutingArrays, plan: Plan, undo: Undo, item: int, chosen: Integers, count: int
) -> int:
    """Take an item out, unless it is; how many are out then."""
    if plan.robot[item] == NOBODY:
        return count
    remember(plan, undo, plan.robot[item])
    take_out(arrays, plan, item)
    chosen[count] = item
    return count + 1


@compiled
def _by_chance(
    arrays: RoutingArrays, plan: Plan, undo: Undo, dice: Dice, wanted: int, chosen: Integers
) -> int:
    count = 0
    for _ in range(wanted):
        count = _out(arrays, plan, undo, one_of(dice, plan.robot.size), chosen, count)
    return count


@compiled
def _related(
    arrays: RoutingArrays, plan: Plan, undo: Undo, dice: Dice, wanted: int, chosen: Integers
) -> int:
    """Items that are near one that is out already, the nearest most likely (Shaw 1998)."""
    others = plan.robot.size - 1
    count = _out(arrays, plan, undo, one_of(dice, plan.robot.size), chosen, 0)
    for _ in range(4 * wanted):
        if count >= wanted or others == 0:
            break
        seed = chosen[one_of(dice, count)]
        rank = int(throw(dice) ** 5 * others)
        count = _out(arrays, plan, undo, arrays.near[seed, rank], chosen, count)
    return count


@compiled
def _strings(
    arrays: RoutingArrays, plan: Plan, undo: Undo, dice: Dice, wanted: int, chosen: Integers
) -> int:
    """Neighbours in a route, from one route after the other near some item (SISR)."""
    longest = 1 + one_of(dice, STRING)
    seed = one_of(dice, plan.robot.size)
    count = _string(arrays, plan, undo, dice, seed, longest, chosen, 0)
    for rank in range(plan.robot.size - 1):
        if count >= wanted:
            break
        item = arrays.near[seed, rank]
        robot = plan.robot[item]
        if robot != NOBODY and not undo.marked[robot]:
            count = _string(arrays, plan, undo, dice, item, longest, chosen, count)
    return count


@compiled
def _string(
    arrays: RoutingArrays, plan: Plan, undo: Undo, dice: Dice, item: int, longest: int,
    chosen: Integers, count: int,
) -> int:  # fmt: skip
    """Take out the item and others that are visited right before or after one of its ends."""
    robot, items = plan.robot[item], plan.robot.size
    node = item if throw(dice) < 0.5 else items + item
    at = 0
    while plan.node[robot, at] != node:
        at += 1
    length = 1 + one_of(dice, longest)
    first = max(1, at - one_of(dice, length))
    beyond = min(plan.length[robot] - 1, first + length)
    remember(plan, undo, robot)
    out = count
    for position in range(first, beyond):
        node = plan.node[robot, position]
        other = node if node < items else node - items
        known = False
        for number in range(count, out):
            known = known or chosen[number] == other
        if not known:
            chosen[out] = other
            out += 1
    for number in range(count, out):
        take_out(arrays, plan, chosen[number])
    return out


@compiled
def _costly(
    arrays: RoutingArrays, plan: Plan, undo: Undo, dice: Dice, wanted: int, chosen: Integers
) -> int:
    """Items whose detours cost much, each the worst of some that are drawn."""
    count = 0
    for _ in range(wanted):
        worst, most = NOBODY, -1.0
        for _ in range(1 + plan.robot.size // 8):
            item = one_of(dice, plan.robot.size)
            if plan.robot[item] != NOBODY:
                saved = _saved(arrays, plan, item)
                if saved > most:
                    worst, most = item, saved
        if worst != NOBODY:
            count = _out(arrays, plan, undo, worst, chosen, count)
    return count


@compiled
def _saved(arrays: RoutingArrays, plan: Plan, item: int) -> float:
    """What the route would cost less without an item."""
    robot, items = plan.robot[item], plan.robot.size
    saved = 0.0
    kept = plan.node[robot, 0]
    for at in range(1, plan.length[robot]):
        node = plan.node[robot, at]
        saved += arrays.cost[plan.node[robot, at - 1], node]
        if node not in (item, items + item):
            saved -= arrays.cost[kept, node]
            kept = node
    return saved


@compiled
def _whole_route(
    arrays: RoutingArrays, plan: Plan, undo: Undo, dice: Dice, wanted: int, chosen: Integers
) -> int:
    """A route and what is near it; of a long one only so much."""
    seed = one_of(dice, plan.robot.size)
    robot, items = plan.robot[seed], plan.robot.size
    remember(plan, undo, robot)
    count = 0
    for at in range(1, plan.length[robot] - 1):
        if plan.node[robot, at] < items and count < wanted:
            chosen[count] = plan.node[robot, at]
            count += 1
    for number in range(count):
        take_out(arrays, plan, chosen[number])
    for rank in range(min(plan.robot.size - 1, max(0, wanted - count))):
        if throw(dice) < 0.7:
            count = _out(arrays, plan, undo, arrays.near[seed, rank], chosen, count)
    return count
