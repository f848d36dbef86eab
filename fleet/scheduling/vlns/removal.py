"""Which items are removed from a plan together: by chance, or because they belong together."""

from math import inf

from fleet.scheduling.compiled import compiled
from fleet.scheduling.dice import Dice, one_of, throw
from fleet.scheduling.vlns.arrays import (
    BANKED,
    GIVE,
    NOWHERE,
    Integers,
    Plan,
    ProblemArrays,
)
from fleet.scheduling.vlns.times import Times, way_m

SMALL = 8
"""Up to so many items, all of them may be removed at once."""


@compiled
def choose_items(
    problem: ProblemArrays, plan: Plan, times: Times, dice: Dice, chosen: Integers
) -> int:
    """Write the items to remove to `chosen`, in one of several manners; how many they are.

    Those in the bank are not among them. `times` are those of the plan.
    """
    items = problem.load.size
    wanted = 1 + one_of(dice, items if items <= SMALL else min(items, 4 + items // 5))
    manner = throw(dice)
    if manner < 0.25:
        return _by_chance(plan, dice, chosen, 0, wanted)
    if manner < 0.5:
        return _related(problem, plan, times, dice, chosen, wanted)
    if manner < 0.75:
        return _strings(problem, plan, dice, chosen, wanted)
    if manner < 0.9:
        return _worst(problem, plan, dice, chosen, wanted)
    if manner < 0.95:
        return _with_same_transfer(problem, plan, dice, chosen, wanted)
    return _whole_robot(problem, plan, dice, chosen, wanted)


@compiled
def _has(chosen: Integers, count: int, item: int) -> bool:
    at = 0
    while at < count and chosen[at] != item:
        at += 1
    return at < count


@compiled
def _by_chance(plan: Plan, dice: Dice, chosen: Integers, count: int, wanted: int) -> int:
    """Add any items that are in the plan; gives up after some throws."""
    for _ in range(4 * wanted):
        if count >= wanted:
            break
        item = one_of(dice, plan.transfers.size)
        if plan.transfers[item] != BANKED and not _has(chosen, count, item):
            chosen[count] = item
            count += 1
    return count


@compiled
def _related(
    problem: ProblemArrays, plan: Plan, times: Times, dice: Dice, chosen: Integers, wanted: int
) -> int:
    """Items whose pickups and deliveries are near to each other, in place, time and robot."""
    count = _by_chance(plan, dice, chosen, 0, 1)
    if count == 0:
        return 0
    items = problem.load.size
    while count < wanted:
        seed = chosen[one_of(dice, count)]
        nearest, found = inf, NOWHERE
        for _ in range(1 + items // 2):
            item = one_of(dice, items)
            if plan.transfers[item] == BANKED or _has(chosen, count, item):
                continue
            apart = _apart(problem, plan, times, seed, item)
            if apart < nearest:
                nearest, found = apart, item
        if found == NOWHERE:
            break
        chosen[count] = found
        count += 1
    return count


@compiled
def _apart(problem: ProblemArrays, plan: Plan, times: Times, one: int, other: int) -> float:
    """How little two items have to do with each other (metres, roughly)."""
    items = problem.load.size
    picks = problem.distance_m[problem.place[one], problem.place[other]]
    drops = problem.distance_m[problem.place[items + one], problem.place[items + other]]
    apart = picks + drops
    both_s = abs(times.begin_s[items + one] - times.begin_s[items + other])
    apart += 0.5 * both_s * problem.speed[0]
    if plan.robot[items + one] == plan.robot[items + other]:
        apart *= 0.8
    return apart  # type: ignore[no-any-return]


@compiled
def _strings(
    problem: ProblemArrays, plan: Plan, dice: Dice, chosen: Integers, wanted: int
) -> int:  # fmt: skip
    """Items with a task in a stretch of a route, then in a near stretch of another."""
    count = _by_chance(plan, dice, chosen, 0, 1)
    if count == 0:
        return 0
    target = chosen[0] + (problem.load.size if throw(dice) < 0.5 else 0)
    if plan.robot[target] == NOWHERE:
        return _by_chance(plan, dice, chosen, count, wanted)
    place = plan.place[target]
    first = one_of(dice, plan.length.size)
    for number in range(plan.length.size):
        k = (first + number) % plan.length.size
        if plan.length[k] == 0:
            continue
        middle, nearest = 0, inf
        for at in range(plan.length[k]):
            away = problem.distance_m[place, plan.place[plan.route[k, at]]] * (1 + throw(dice))
            if away < nearest:
                middle, nearest = at, away
        span = 1 + one_of(dice, wanted)
        begin = max(0, middle - one_of(dice, span))
        for at in range(begin, min(plan.length[k], begin + span)):
            item = problem.item[plan.route[k, at]]
            if count < wanted and not _has(chosen, count, item):
                chosen[count] = item
                count += 1
    return count


@compiled
def _worst(problem: ProblemArrays, plan: Plan, dice: Dice, chosen: Integers, wanted: int) -> int:
    """Items that cost much distance where they are, more or less."""
    count = 0
    while count < wanted:
        most, found = -inf, NOWHERE
        for _ in range(2 + problem.load.size // 3):
            item = one_of(dice, problem.load.size)
            if plan.transfers[item] == BANKED or _has(chosen, count, item):
                continue
            spared = _spared(problem, plan, item) * (0.5 + throw(dice))
            if spared > most:
                most, found = spared, item
        if found == NOWHERE:
            break
        chosen[count] = found
        count += 1
    return count


@compiled
def _spared(problem: ProblemArrays, plan: Plan, item: int) -> float:
    """How much shorter the routes are without the item's nodes (metres)."""
    spared = 0.0
    for k in range(plan.length.size):
        kept = here = problem.start[k]
        for at in range(plan.length[k] + 1):
            last = at == plan.length[k]
            place = problem.end[k] if last else plan.place[plan.route[k, at]]
            spared += way_m(problem, here, place)
            here = place
            if not last and problem.item[plan.route[k, at]] == item:
                continue
            spared -= way_m(problem, kept, place)
            kept = place
    return spared


@compiled
def _with_same_transfer(
    problem: ProblemArrays, plan: Plan, dice: Dice, chosen: Integers, wanted: int
) -> int:
    """Items that change robots at one place; filled up by chance."""
    given = 0
    place = NOWHERE
    for k in range(plan.length.size):
        for at in range(plan.length[k]):
            if problem.kind[plan.route[k, at]] == GIVE:
                given += 1
                if one_of(dice, given) == 0:
                    place = plan.place[plan.route[k, at]]
    count = 0
    for k in range(plan.length.size):
        for at in range(plan.length[k]):
            node = plan.route[k, at]
            item = problem.item[node]
            if problem.kind[node] != GIVE or plan.place[node] != place:
                continue
            if not _has(chosen, count, item):
                chosen[count] = item
                count += 1
    return _by_chance(plan, dice, chosen, count, wanted)


@compiled
def _whole_robot(
    problem: ProblemArrays, plan: Plan, dice: Dice, chosen: Integers, wanted: int
) -> int:
    """All that one robot has anything to do with, at most three times what is wanted."""
    count = 0
    k = one_of(dice, plan.length.size)
    for at in range(plan.length[k]):
        item = problem.item[plan.route[k, at]]
        if count < 3 * wanted and not _has(chosen, count, item):
            chosen[count] = item
            count += 1
    return _by_chance(plan, dice, chosen, count, wanted)
