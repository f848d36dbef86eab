"""Which items are removed together: by chance, or because they belong together in some way."""

from enum import IntEnum
from math import inf

from mend.fleet.scheduling.alns.plan import BANKED, Plan
from mend.fleet.scheduling.alns.problem_arrays import DROP, NOBODY, ProblemArrays
from mend.fleet.scheduling.alns.state import State
from mend.fleet.scheduling.compiled import compiled, inlined
from mend.fleet.scheduling.rng import Rng, below, uniform

STRING = 10
"""How many stops in a row are taken from one route at most."""


class Removal(IntEnum):
    """The destroy operators."""

    RANDOM = 0
    RELATED = 1
    STRING = 2
    WORST = 3
    ROUTE = 4
    DETOUR = 5
    TRANSFER = 6


@compiled
def choose_items(problem: ProblemArrays, state: State, rng: Rng, operator: int, wanted: int) -> int:
    """Choose about so many items of the trial plan; how many they are. None is from the bank."""
    for item in range(state.picked.size):
        state.picked[item] = False
    if operator == Removal.RELATED:
        return _related(problem, state, rng, wanted)
    if operator == Removal.STRING:
        return _strings(problem, state, rng, wanted)
    if operator == Removal.WORST:
        return _worst(problem, state, rng, wanted)
    if operator == Removal.ROUTE:
        return _route(problem, state, rng, wanted)
    if operator == Removal.DETOUR:
        return _detour(problem, state, rng, wanted)
    if operator == Removal.TRANSFER:
        return _same_transfer(problem, state, rng, wanted)
    return _random(state, rng, 0, wanted)


@inlined
def _pick(state: State, item: int, count: int) -> int:
    """Add an item unless it is in the bank or chosen already; how many are chosen then."""
    if item == NOBODY or state.picked[item] or state.trial.transfers[item] == BANKED:
        return count
    state.picked[item] = True
    state.chosen[count] = item
    return count + 1


@compiled
def _random(state: State, rng: Rng, count: int, wanted: int) -> int:
    """Add any items; gives up after some draws."""
    for _ in range(4 * wanted):
        if count < wanted:
            count = _pick(state, below(rng, state.picked.size), count)
    return count


@compiled
def _related(problem: ProblemArrays, state: State, rng: Rng, wanted: int) -> int:
    """Items that are near one that is chosen already, the nearest most likely (Shaw 1998)."""
    others = state.picked.size - 1
    count = _random(state, rng, 0, 1)
    for _ in range(4 * wanted):
        if count == 0 or count >= wanted or others == 0:
            break
        seed = state.chosen[below(rng, count)]
        rank = int(uniform(rng) ** 5 * others)
        count = _pick(state, problem.near[seed, rank], count)
    return count


@compiled
def _strings(problem: ProblemArrays, state: State, rng: Rng, wanted: int) -> int:
    """Neighbours in a route, from one route after the other near some item (SISR)."""
    plan, items = state.trial, state.picked.size
    longest = 1 + below(rng, STRING)
    seed = below(rng, items)
    count = _string(problem, state, rng, (seed, longest), 0)
    for rank in range(items - 1):
        if count >= wanted:
            break
        item = problem.near[seed, rank]
        if plan.transfers[item] == BANKED:
            continue
        known = False
        for number in range(count):
            drop = items + state.chosen[number]
            known = known or plan.tasks[drop].row == plan.tasks[items + item].row
        if not known:
            count = _string(problem, state, rng, (item, longest), count)
    return count


@compiled
def _string(
    problem: ProblemArrays, state: State, rng: Rng, around: tuple[int, int], count: int
) -> int:
    """Choose an item and others that are visited right before or after one of its ends."""
    (item, longest), plan, items = around, state.trial, state.picked.size
    if plan.transfers[item] == BANKED:
        return count
    node = items + item
    if problem.items[item].carrier == NOBODY and uniform(rng) < 0.5:
        node = item
    row, at = plan.tasks[node].row, plan.tasks[node].at
    length = 1 + below(rng, longest)
    first = max(1, at - below(rng, length))
    for position in range(first, min(plan.rows[row].length - 1, first + length)):
        count = _pick(state, problem.nodes[plan.stops[row, position].node].item_of, count)
    return count


@compiled
def _worst(problem: ProblemArrays, state: State, rng: Rng, wanted: int) -> int:
    """Items whose detours are long, each the worst of some that are drawn."""
    plan, items = state.trial, state.picked.size
    count = 0
    for _ in range(wanted):
        worst, most = NOBODY, -inf
        for _ in range(1 + items // 8):
            item = below(rng, items)
            if plan.transfers[item] != BANKED and not state.picked[item]:
                saved_m = _saved_m(problem, plan, item)
                if saved_m > most:
                    worst, most = item, saved_m
        count = _pick(state, worst, count)
    return count


@compiled
def _saved_m(problem: ProblemArrays, plan: Plan, item: int) -> float:
    """How much shorter the routes would be without an item (metres)."""
    saved_m = 0.0
    for row in range(plan.rows.size - 1):
        if plan.transfers[item] == 0 and row != plan.tasks[plan.transfers.size + item].row:
            continue
        here = kept = plan.tasks[plan.stops[row, 0].node].place
        for at in range(1, plan.rows[row].length):
            node = plan.stops[row, at].node
            place = plan.tasks[node].place
            saved_m += problem.distance_m[here, place]
            here = place
            if problem.nodes[node].item_of != item:
                saved_m -= problem.distance_m[kept, place]
                kept = place
    return saved_m


@compiled
def _route(problem: ProblemArrays, state: State, rng: Rng, wanted: int) -> int:
    """What one robot does and what is near it; of a long route only so much."""
    plan, items = state.trial, state.picked.size
    seed, count = below(rng, items), 0
    if plan.transfers[seed] == BANKED:
        return _random(state, rng, 0, wanted)
    row = plan.tasks[items + seed].row
    for at in range(1, plan.rows[row].length - 1):
        if count < wanted:
            count = _pick(state, problem.nodes[plan.stops[row, at].node].item_of, count)
    for rank in range(min(items - 1, max(0, wanted - count))):
        if uniform(rng) < 0.7:
            count = _pick(state, problem.near[seed, rank], count)
    return count


@compiled
def _same_transfer(problem: ProblemArrays, state: State, rng: Rng, wanted: int) -> int:
    """Items that change robots at one place; filled up by chance."""
    plan, items, chain = state.trial, state.picked.size, problem.chain
    given, place, count = 0, NOBODY, 0
    for item in range(items):
        for number in range(max(0, plan.transfers[item])):
            given += 1
            if below(rng, given) == 0:
                place = plan.tasks[2 * items + 2 * (item * chain + number)].place
    for item in range(items):
        for number in range(max(0, plan.transfers[item])):
            if plan.tasks[2 * items + 2 * (item * chain + number)].place == place:
                count = _pick(state, item, count)
    return _random(state, rng, count, wanted)


@compiled
def _detour(problem: ProblemArrays, state: State, rng: Rng, wanted: int) -> int:
    """All for which one robot goes to some neighbourhood, tabu for it; then what is near there.

    Its way is spared only when all of it is done by others, so that no single item shows the gain.
    """
    plan, row = state.trial, below(rng, problem.robots.size)
    if plan.rows[row].length == 2:
        return _random(state, rng, 0, wanted)
    first = _far_leg(problem, plan, rng, row)
    far_m, last, count = _leg_m(problem, plan, row, first), first + 1, 0
    while last < plan.rows[row].length - 1 and _leg_m(problem, plan, row, last) < far_m:
        last += 1
    for at in range(first, last):
        node = plan.stops[row, at].node
        if problem.nodes[node].kind <= DROP:
            state.found.tabu[node] = row
        count = _pick(state, problem.nodes[node].item_of, count)
    return _near(
        problem, state, rng, (count, wanted), plan.tasks[plan.stops[row, first].node].place
    )


@compiled
def _far_leg(problem: ProblemArrays, plan: Plan, rng: Rng, row: int) -> int:
    """The position before which the robot goes far: each as probable as it is long."""
    whole_m, found = 0.0, 1
    for at in range(1, plan.rows[row].length - 1):
        leg_m = _leg_m(problem, plan, row, at)
        whole_m += leg_m
        if uniform(rng) * whole_m < leg_m:
            found = at
    return found


@compiled
def _leg_m(problem: ProblemArrays, plan: Plan, row: int, at: int) -> float:
    """How far the robot goes to get to a position of its route (metres)."""
    before, here = (
        plan.tasks[plan.stops[row, at - 1].node].place,
        plan.tasks[plan.stops[row, at].node].place,
    )
    return problem.distance_m[before, here]  # type: ignore[no-any-return]


@compiled
def _near(
    problem: ProblemArrays, state: State, rng: Rng, counts: tuple[int, int], place: int
) -> int:
    """Add up to so many items more, mostly those with a pickup or delivery near a place."""
    (count, more), items = counts, state.picked.size
    for _ in range(more):
        nearest, found = inf, NOBODY
        for _ in range(1 + items // 4):
            item = below(rng, items)
            if state.trial.transfers[item] == BANKED or state.picked[item]:
                continue
            away = min(
                problem.distance_m[place, problem.nodes[item].place],
                problem.distance_m[place, problem.nodes[items + item].place],
            )
            if away < nearest:
                nearest, found = away, item
        count = _pick(state, found, count)
    return count
