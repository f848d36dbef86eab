"""Which items are removed from a plan together: by chance, or because they belong together.

A removed visit may be barred to its robot: others must then do it, or it is done over transfers.
"""

from math import inf

from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.dice import Dice, one_of, throw
from mend.fleet.scheduling.vlns.arrays import (
    BANKED,
    DROP,
    GIVE,
    NOWHERE,
    Integers,
    Plan,
    ProblemArrays,
)
from mend.fleet.scheduling.vlns.times import Times, way_m

SMALL = 8
"""Up to so many items, all of them may be removed at once."""


@compiled
def choose_items(
    problem: ProblemArrays, plan: Plan, times: Times, dice: Dice, chosen: Integers,
    barred: Integers,
) -> int:  # fmt: skip
    """Write the items to remove to `chosen`, in one of several manners; how many they are.

    Those in the bank are not among them. `times` are those of the plan. `barred` by node: the robot
    that must not do it for now; nothing is barred when this is called.
    """
    items = problem.load.size
    wanted = 1 + one_of(dice, items if items <= SMALL else min(items, 4 + items // 5))
    manner = throw(dice)
    if manner < 0.2:
        return _by_chance(plan, dice, chosen, 0, wanted)
    if manner < 0.4:
        return _related(problem, plan, times, dice, chosen, wanted)
    if manner < 0.6:
        return _strings(problem, plan, dice, chosen, wanted)
    if manner < 0.75:
        return _worst(problem, plan, dice, chosen, wanted)
    if manner < 0.9:
        return _visit(problem, plan, dice, chosen, barred, wanted)
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


@compiled
def _visit(
    problem: ProblemArrays, plan: Plan, dice: Dice, chosen: Integers, barred: Integers, wanted: int
) -> int:  # fmt: skip
    """All for which one robot goes to some neighbourhood, barred to it; then what is near there.

    Its way is spared only when all of it is done by others, so that no single item shows the gain.
    """
    k = one_of(dice, plan.length.size)
    if plan.length[k] == 0:
        return _by_chance(plan, dice, chosen, 0, wanted)
    first = _far_leg(problem, plan, dice, k)
    far_m = _leg_m(problem, plan, k, first)
    last = first + 1
    while last < plan.length[k] and _leg_m(problem, plan, k, last) < far_m:
        last += 1
    count = 0
    for at in range(first, last):
        node = plan.route[k, at]
        item = problem.item[node]
        if problem.kind[node] <= DROP:
            barred[node] = k
        if not _has(chosen, count, item):
            chosen[count] = item
            count += 1
    return _near(problem, plan, dice, chosen, count, plan.place[plan.route[k, first]], wanted)


@compiled
def _far_leg(problem: ProblemArrays, plan: Plan, dice: Dice, robot: int) -> int:
    """The position before which the robot goes far: each as probable as it is long."""
    whole_m = 0.0
    found = 0
    for at in range(plan.length[robot]):
        leg_m = _leg_m(problem, plan, robot, at)
        whole_m += leg_m
        if throw(dice) * whole_m < leg_m:
            found = at
    return found


@compiled
def _leg_m(problem: ProblemArrays, plan: Plan, robot: int, at: int) -> float:
    """How far the robot goes to get to a position of its route (metres)."""
    before = problem.start[robot] if at == 0 else plan.place[plan.route[robot, at - 1]]
    return problem.distance_m[before, plan.place[plan.route[robot, at]]]  # type: ignore[no-any-return]


@compiled
def _near(
    problem: ProblemArrays, plan: Plan, dice: Dice, chosen: Integers, count: int, place: int,
    more: int,
) -> int:  # fmt: skip
    """Add up to so many items more, mostly those with a pickup or delivery near a place."""
    items = problem.load.size
    for _ in range(more):
        nearest, found = inf, NOWHERE
        for _ in range(1 + items // 4):
            item = one_of(dice, items)
            if plan.transfers[item] == BANKED or _has(chosen, count, item):
                continue
            away = min(
                problem.distance_m[place, problem.place[item]],
                problem.distance_m[place, problem.place[items + item]],
            )
            if away < nearest:
                nearest, found = away, item
        if found == NOWHERE:
            break
        chosen[count] = found
        count += 1
    return count
