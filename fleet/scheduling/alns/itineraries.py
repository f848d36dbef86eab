"""Itineraries of an item over one robot or several: a search over robots and transfer places.

A label is the beginning of an itinerary: the item is at a transfer place, and one robot brought it
there.
"""

from math import inf
from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.alns.legs import (
    KEPT,
    Legs,
    Wanted,
    ends_for,
    find_legs,
    legs_for,
    open_home,
    open_transfer,
)
from mend.fleet.scheduling.alns.plan import Plan, put
from mend.fleet.scheduling.alns.problem_arrays import (
    NOBODY,
    UNREACHABLE,
    ProblemArrays,
    give_node,
    origin_of,
)
from mend.fleet.scheduling.alns.records import Flags, Floats, Integers, Records
from mend.fleet.scheduling.compiled import compiled, inlined
from mend.fleet.scheduling.rng import Rng, below, uniform
from mend.fleet.scheduling.tolerance import SEARCH_S

MOST_PLACES = 6
"""How many transfer places are looked at for one item at a time."""
MOST = 12
"""How many of the cheapest itineraries are tried."""
LABELS = 600
SPARE = 2
"""How many direct itineraries one with transfers may be worse than, as those could turn out
untimely."""

EXTRA, READY_S = 0, 1
ROW, PLACE, SLOT, RANK, PARENT, TRANSFERS = range(6)
"""The columns of a label."""
LOAD_AT, UNLOAD_AT, FROM, TO = range(1, 5)
"""After its row, the columns of a leg: the positions to load and to unload after, and the ends."""
ONE_END = -1
"""The parent of a label, or the label of an itinerary, that begins at the pickup."""


class Allowed(NamedTuple):
    """Which itineraries are looked for: with up to so many transfers, with one at least if that
    `must` be; `blink`: the share of legs that are overlooked, for variety."""

    transfers: int
    must: bool
    blink: float


class Itineraries(NamedTuple):
    """The cheapest itineraries of one item in order of `extra`, what they probably cost.

    `label` and `last` have their transfers and their last legs. `tabu` by node: the robot that must
    not do it for now, or `NOBODY`; `shut` by robot: whether it takes nothing for now.
    """

    tabu: Integers
    shut: Flags
    ends: Records
    legs: Legs
    places: Integers
    """How many transfer places are looked at."""
    label: Integers
    label_real: Floats
    labels: Integers
    known: Integers
    extra: Floats
    last: Integers
    leg: Integers
    """The legs of the itinerary that was unrolled."""


def itineraries_for(problem: ProblemArrays) -> Itineraries:
    """Room for the itineraries of one item."""
    robots, places = problem.robots.size, min(problem.transfer_place.size, MOST_PLACES)
    return Itineraries(
        tabu=np.full(problem.nodes.size, NOBODY, np.int64),
        shut=np.zeros(robots, np.bool_),
        ends=ends_for(places),
        legs=legs_for((robots + 1) * problem.items.size + robots * (places + 1) ** 2),
        places=np.zeros(1, np.int64),
        label=np.zeros((LABELS, 6), np.int64),
        label_real=np.zeros((LABELS, 2)),
        labels=np.zeros(1, np.int64),
        known=np.zeros(1, np.int64),
        extra=np.zeros(MOST),
        last=np.zeros((MOST, 4), np.int64),
        leg=np.zeros((problem.chain + 1, 5), np.int64),
    )


@compiled
def lift_tabu(found: Itineraries) -> None:
    """Let every robot do everything again."""
    for node in range(found.tabu.size):
        found.tabu[node] = NOBODY
    for robot in range(found.shut.size):
        found.shut[robot] = False


@compiled
def find_itineraries(
    problem: ProblemArrays, plan: Plan, found: Itineraries, rng: Rng, item: int, allowed: Allowed
) -> None:
    """The cheapest itineraries of an item that is in the bank."""
    found.known[0] = found.labels[0] = 0
    open_home(problem, found.ends, item)
    if not allowed.must:
        _find_direct(problem, plan, found, rng, item, allowed)
    _choose_places(problem, plan, found, rng, item, allowed)
    if found.places[0] == 0:
        return
    limit = problem.metre * UNREACHABLE / 2
    if problem.timeless and found.known[0] > 0:
        limit = found.extra[min(found.known[0] - 1, SPARE)]
    _find_parts(problem, plan, found, item, allowed, limit)
    _join_parts(problem, found, rng, allowed, limit)


@inlined
def direct_slot(plan: Plan, item: int, row: int) -> int:
    """Where the legs of a row are that bring an item all the way."""
    return item * plan.rows.size + row


@inlined
def part_slot(found: Itineraries, plan: Plan, row: int, ends: tuple[int, int]) -> int:
    """Where the legs of a row between two ends are."""
    count = found.places[0] + 1
    first = plan.transfers.size * plan.rows.size
    return first + (row * count + ends[0]) * count + ends[1]  # type: ignore[no-any-return]


@compiled
def _find_direct(
    problem: ProblemArrays, plan: Plan, found: Itineraries, rng: Rng, item: int, allowed: Allowed
) -> None:
    drop, legs = problem.items.size + item, found.legs
    for row in range(problem.robots.size):
        if found.shut[row] or found.tabu[item] == row or found.tabu[drop] == row:
            continue
        if _useless(problem, plan, row, item):
            continue
        slot = direct_slot(plan, item, row)
        look_up(problem, plan, found, item, row)
        for rank in range(legs.slots[slot].known):
            if allowed.blink == 0.0 or uniform(rng) >= allowed.blink:
                _remember(found, legs.ranked[slot, rank].extra, ONE_END, row, (slot, rank))


@inlined
def look_up(problem: ProblemArrays, plan: Plan, found: Itineraries, item: int, row: int) -> None:
    """Find the legs that bring an item all the way, unless they are known for the row as it is."""
    slot = direct_slot(plan, item, row)
    if found.legs.slots[slot].version != plan.rows[row].version:
        limit = problem.metre * UNREACHABLE / 2
        wanted = Wanted(slot, row, item, 0, 0, limit, KEPT, False)
        find_legs(problem, plan, found.ends, found.legs, wanted)
        found.legs.slots[slot].version = plan.rows[row].version


@inlined
def _useless(problem: ProblemArrays, plan: Plan, row: int, item: int) -> bool:
    """Whether a robot need not begin: another one has the item, or its twin is as free as it is."""
    if problem.items[item].carrier != NOBODY:
        return problem.items[item].carrier != row  # type: ignore[no-any-return]
    twin = problem.robots[row].twin
    return twin != NOBODY and plan.rows[row].length == 2 and plan.rows[twin].length == 2  # type: ignore[no-any-return]


@compiled
def _choose_places(
    problem: ProblemArrays, plan: Plan, found: Itineraries, rng: Rng, item: int, allowed: Allowed
) -> None:
    """All transfer places where they are few; otherwise those on the way, in use, and by chance."""
    known = problem.transfer_place.size
    wanted = min(known, found.ends.size - 1) if allowed.transfers > 0 else 0
    found.places[0] = wanted
    if wanted == known:
        for number in range(known):
            place = problem.transfer_place[number]
            open_transfer(problem, found.ends, item, number + 1, place)
        return
    origin, target = origin_of(problem, item), problem.nodes[problem.items.size + item].place
    for number in range(wanted):
        best, chosen = inf, NOBODY
        for _ in range(2 + known // 4):
            place = problem.transfer_place[below(rng, known)]
            detour = problem.distance_m[origin, place] + problem.distance_m[place, target]
            if detour < best and (number % 3 < 2 or chosen == NOBODY):
                best, chosen = detour, place
        if number % 3 == 1:
            row = below(rng, problem.robots.size)
            place = plan.tasks[plan.stops[row, below(rng, plan.rows[row].length)].node].place
            for other in range(known):
                if problem.transfer_place[other] == place:
                    chosen = place
        open_transfer(problem, found.ends, item, number + 1, chosen)


@compiled
def _find_parts(
    problem: ProblemArrays, plan: Plan, found: Itineraries, item: int, allowed: Allowed,
    limit: float,
) -> None:  # fmt: skip
    """The cheapest legs from and to transfer places, and between them for two transfers or more."""
    for row in range(problem.robots.size):
        first = not _useless(problem, plan, row, item) and found.tabu[item] != row
        last = found.tabu[problem.items.size + item] != row
        for origin in range(found.places[0] + 1):
            for target in range(found.places[0] + 1):
                if origin == target or (origin > 0 and target > 0 and allowed.transfers < 2):
                    continue
                slot = part_slot(found, plan, row, (origin, target))
                found.legs.slots[slot].known = 0
                if found.shut[row] or (origin == 0 and not first) or (target == 0 and not last):
                    continue
                wanted = Wanted(slot, row, item, origin, target, limit, KEPT, False)
                find_legs(problem, plan, found.ends, found.legs, wanted)


@compiled
def _join_parts(
    problem: ProblemArrays, found: Itineraries, rng: Rng, allowed: Allowed, limit: float
) -> None:
    """Extend labels transfer by transfer; whatever can be brought to the delivery is one."""
    legs, count = found.legs, found.places[0] + 1
    rows = problem.robots.size
    first = problem.items.size * (rows + 1)
    apart_s = 0.0 if problem.together else problem.transfer_s
    at = -1
    while at < found.labels[0]:
        spent, given_s, origin, mover, transfers = 0.0, -inf, 0, -1, 0
        if at >= 0:
            spent, given_s = found.label_real[at, EXTRA], found.label_real[at, READY_S] + apart_s
            origin, mover = found.label[at, PLACE], found.label[at, ROW]
            transfers = found.label[at, TRANSFERS]
        for row in range(rows):
            if row == mover:
                continue
            for target in range(count):
                if target == origin or (target > 0 and transfers >= allowed.transfers):
                    continue
                slot = first + (row * count + origin) * count + target
                for rank in range(legs.slots[slot].known):
                    extra = spent + legs.ranked[slot, rank].extra
                    if extra >= limit:
                        break
                    if given_s > legs.ranked[slot, rank].wanted_s + SEARCH_S:
                        continue
                    if allowed.blink > 0.0 and uniform(rng) < allowed.blink:
                        continue
                    if target == 0:
                        _remember(found, extra, at, row, (slot, rank))
                    else:
                        ready_s = max(legs.ranked[slot, rank].ready_s, given_s)
                        step = (row, target, slot, rank, at, transfers + 1)
                        _add_label(found, extra, ready_s, step)
        at += 1


@compiled
def _add_label(
    found: Itineraries, extra: float, ready_s: float, step: tuple[int, int, int, int, int, int]
) -> None:
    at = found.labels[0]
    if at == LABELS:
        return
    found.label_real[at, EXTRA], found.label_real[at, READY_S] = extra, ready_s
    for part in range(6):
        found.label[at, part] = step[part]
    found.labels[0] += 1


@inlined
def _remember(found: Itineraries, extra: float, label: int, row: int, leg: tuple[int, int]) -> None:
    """Keep an itinerary where it is among the cheapest, in order of cost."""
    at = found.known[0]
    if at == MOST:
        if extra >= found.extra[MOST - 1]:
            return
        at -= 1
    found.known[0] = at + 1
    while at > 0 and found.extra[at - 1] > extra:
        found.extra[at] = found.extra[at - 1]
        for part in range(4):
            found.last[at, part] = found.last[at - 1, part]
        at -= 1
    found.extra[at] = extra
    found.last[at, 0], found.last[at, 1] = label, row
    found.last[at, 2], found.last[at, 3] = leg


@compiled
def unroll(found: Itineraries, number: int) -> int:
    """Write the legs of an itinerary in order; how many transfers it has."""
    label, row = found.last[number, 0], found.last[number, 1]
    slot, rank = found.last[number, 2], found.last[number, 3]
    transfers = 0 if label == ONE_END else found.label[label, TRANSFERS]
    leg, legs, target = found.leg, found.legs, 0
    for at in range(transfers, -1, -1):
        leg[at, ROW], leg[at, TO] = row, target
        leg[at, LOAD_AT], leg[at, UNLOAD_AT] = (
            legs.ranked[slot, rank].load_at,
            legs.ranked[slot, rank].unload_at,
        )
        if at > 0:
            row, target = found.label[label, ROW], found.label[label, PLACE]
            slot, rank = found.label[label, SLOT], found.label[label, RANK]
            label = found.label[label, PARENT]
        leg[at, FROM] = target if at > 0 else 0
    return transfers


@compiled
def follow(
    problem: ProblemArrays, plan: Plan, found: Itineraries, item: int, transfers: int
) -> bool:
    """Insert the item's nodes along the legs that were unrolled; False, and nothing done, where
    they cross each other. The times are not known then."""
    for later in range(transfers + 1):
        for earlier in range(later):
            same = found.leg[earlier, ROW] == found.leg[later, ROW]
            if same and found.leg[later, LOAD_AT] < found.leg[earlier, UNLOAD_AT]:
                return False
    items, leg = problem.items.size, found.leg
    for at in range(transfers, -1, -1):
        row = leg[at, ROW]
        last = items + item if at == transfers else give_node(problem, item, at)
        first = item if at == 0 else give_node(problem, item, at - 1) + 1
        put(plan, row, leg[at, UNLOAD_AT], last, found.ends[leg[at, TO]].unload_place)
        if at > 0 or problem.items[item].carrier == NOBODY:
            put(plan, row, leg[at, LOAD_AT], first, found.ends[leg[at, FROM]].load_place)
    plan.transfers[item] = transfers
    plan.handed[0] += transfers
    return True
