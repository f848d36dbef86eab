"""Ways of an item over one robot or several: a search over robots and transfer places.

A label is the beginning of a way: the item is at a transfer place, and one robot brought it there.
"""

from math import inf
from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.dice import Dice, one_of
from mend.fleet.scheduling.vlns.arrays import (
    HOME,
    NOWHERE,
    UNREACHABLE,
    Floats,
    Integers,
    Plan,
    ProblemArrays,
    give_node,
    put,
)
from mend.fleet.scheduling.vlns.legs import Ends, Legs, ends_for, find_legs, legs_for
from mend.fleet.scheduling.vlns.times import TOLERANCE, Times

MOST_PLACES = 6
"""How many transfer places are looked at for one item at a time."""
WAYS = 12
"""How many of the cheapest ways are tried."""
LABELS = 600
SPARE = 2
"""How many direct ways a way with transfers may be worse than, as those could turn out untimely."""

EXTRA, READY_S = 0, 1
ROBOT, PLACE, RANK, PARENT, TRANSFERS = 0, 1, 2, 3, 4


class Ways(NamedTuple):
    """The cheapest ways, by their order: what they probably cost and their last leg.

    `place` has the transfer place of each end; `known`: how many labels and how many ways;
    `barred` by node: the robot that must not do it for now, or `NOWHERE`.
    """

    barred: Integers
    ends: Ends
    legs: Legs
    place: Integers
    label: Integers
    label_real: Floats
    known: Integers
    extra: Floats
    last: Integers
    leg: Integers


def ways_for(problem: ProblemArrays) -> Ways:
    """Room for the ways of one item."""
    most = min(problem.transfer_place.size, MOST_PLACES)
    return Ways(
        barred=np.full(problem.place.size, NOWHERE, np.int64),
        ends=ends_for(most),
        legs=legs_for(problem.start.size, most),
        place=np.zeros(most + 1, np.int64),
        label=np.zeros((LABELS, 5), np.int64),
        label_real=np.zeros((LABELS, 2)),
        known=np.zeros(2, np.int64),
        extra=np.zeros(WAYS + 1),
        last=np.zeros((WAYS + 1, 3), np.int64),
        leg=np.zeros((problem.chain + 1, 4), np.int64),
    )


@compiled
def lift_bars(ways: Ways) -> None:
    """Let every robot do everything again."""
    for node in range(ways.barred.size):
        ways.barred[node] = NOWHERE


@compiled
def find_ways(
    problem: ProblemArrays, plan: Plan, times: Times, ways: Ways, dice: Dice,
    item: int, fewest: int, most: int, blink: float,
) -> None:  # fmt: skip
    """The cheapest ways of an item with `fewest` (0 or 1) to `most` transfers."""
    ways.known[0] = ways.known[1] = 0
    _choose_places(problem, plan, ways, dice, item, most)
    _open_ends(problem, ways, item)
    limit = problem.metre * UNREACHABLE / 2
    drop = problem.load.size + item
    if fewest == 0:
        for k in range(plan.length.size):
            if _useless(problem, plan, k, item) or ways.barred[item] == k or ways.barred[drop] == k:
                continue
            find_legs(
                problem, plan, times, ways.ends, ways.legs, dice, k, item, HOME, HOME, limit,
                blink,
            )  # fmt: skip
            for rank in range(ways.legs.known[k, 0, 0]):
                _remember(ways, ways.legs.extra[k, 0, 0, rank], NOWHERE, k, rank)
    if ways.ends.known[0] == 0:
        return
    if problem.timeless and ways.known[1] > 0:
        limit = ways.extra[min(ways.known[1] - 1, SPARE)]
    _find_parts(problem, plan, times, ways, dice, item, most, limit, blink)
    _join_parts(problem, ways, most, limit)


@compiled
def _useless(problem: ProblemArrays, plan: Plan, robot: int, item: int) -> bool:
    """Whether a robot need not be looked at: its twin is as free as it is."""
    if problem.aboard[item] != NOWHERE:
        return problem.aboard[item] != robot  # type: ignore[no-any-return]
    twin = problem.twin[robot]
    return twin != NOWHERE and plan.length[robot] == 0 and plan.length[twin] == 0  # type: ignore[no-any-return]


@compiled
def _choose_places(
    problem: ProblemArrays, plan: Plan, ways: Ways, dice: Dice, item: int, most: int
) -> None:
    """All transfer places where they are few; otherwise those on the way, in use, and by chance."""
    known = problem.transfer_place.size
    wanted = min(known, ways.place.size - 1) if most > 0 else 0
    ways.ends.known[0] = wanted
    if wanted == known:
        for number in range(known):
            ways.place[number + 1] = problem.transfer_place[number]
        return
    origin = _origin(problem, item)
    target = problem.place[problem.load.size + item]
    for number in range(wanted):
        best, chosen = inf, NOWHERE
        for _ in range(2 + known // 4):
            place = problem.transfer_place[one_of(dice, known)]
            detour = problem.distance_m[origin, place] + problem.distance_m[place, target]
            if detour < best and (number % 3 < 2 or chosen == NOWHERE):
                best, chosen = detour, place
        if number % 3 == 1:
            k = one_of(dice, plan.length.size)
            if plan.length[k] > 0:
                node = plan.route[k, one_of(dice, plan.length[k])]
                if _is_transfer_place(problem, plan.place[node]):
                    chosen = plan.place[node]
        ways.place[number + 1] = chosen


@compiled
def _is_transfer_place(problem: ProblemArrays, place: int) -> bool:
    return problem.exchange[place]  # type: ignore[no-any-return]


@compiled
def _origin(problem: ProblemArrays, item: int) -> int:
    if problem.aboard[item] != NOWHERE:
        return problem.start[problem.aboard[item]]  # type: ignore[no-any-return]
    return problem.place[item]  # type: ignore[no-any-return]


@compiled
def _open_ends(problem: ProblemArrays, ways: Ways, item: int) -> None:
    """Where the item can be loaded and unloaded, and within what times."""
    ends, drop = ways.ends, problem.load.size + item
    ends.loading_place[0] = _origin(problem, item)
    ends.loading_s[0] = problem.service_s[item]
    ends.loading_from_s[0] = problem.earliest_s[item]
    ends.loading_until_s[0] = problem.latest_s[item]
    ends.unloading_place[0] = problem.place[drop]
    ends.unloading_s[0] = problem.service_s[drop]
    ends.unloading_from_s[0] = problem.earliest_s[drop]
    ends.unloading_until_s[0] = problem.latest_s[drop]
    fastest = problem.fastest
    for number in range(1, ends.known[0] + 1):
        place = ways.place[number]
        ends.loading_place[number] = ends.unloading_place[number] = place
        ends.loading_s[number] = ends.unloading_s[number] = problem.transfer_s
        there_s = problem.time_s[ends.loading_place[0], place] / fastest
        onward_s = problem.time_s[place, problem.place[drop]] / fastest
        soonest_s = there_s
        if problem.aboard[item] == NOWHERE:
            soonest_s += problem.earliest_s[item] + problem.service_s[item]
        last_s = problem.latest_s[drop] - onward_s - problem.transfer_s
        ends.unloading_from_s[number] = soonest_s
        ends.unloading_until_s[number] = last_s
        ends.loading_from_s[number] = soonest_s
        ends.loading_until_s[number] = last_s
        if not problem.together:
            ends.loading_from_s[number] += problem.transfer_s
            ends.unloading_until_s[number] -= problem.transfer_s


@compiled
def _find_parts(
    problem: ProblemArrays, plan: Plan, times: Times, ways: Ways, dice: Dice,
    item: int, most: int, limit: float, blink: float,
) -> None:  # fmt: skip
    """The cheapest legs from and to transfer places, and between them for two transfers or more."""
    places = ways.ends.known[0]
    for k in range(plan.length.size):
        first = not _useless(problem, plan, k, item) and ways.barred[item] != k
        last = ways.barred[problem.load.size + item] != k
        for place in range(1, places + 1):
            ways.legs.known[k, 0, place] = 0
            if first:
                find_legs(
                    problem, plan, times, ways.ends, ways.legs, dice, k, item, HOME, place, limit,
                    blink,
                )  # fmt: skip
            ways.legs.known[k, place, 0] = 0
            if last:
                find_legs(
                    problem, plan, times, ways.ends, ways.legs, dice, k, item, place, HOME, limit,
                    blink,
                )  # fmt: skip
            for other in range(1, places + 1):
                if most > 1 and other != place:
                    find_legs(
                        problem, plan, times, ways.ends, ways.legs, dice, k, item, place, other,
                        limit, blink,
                    )  # fmt: skip


@compiled
def _join_parts(problem: ProblemArrays, ways: Ways, most: int, limit: float) -> None:
    """Extend labels transfer by transfer; whatever can be brought to the delivery is a way."""
    legs, places = ways.legs, ways.ends.known[0]
    robots = legs.known.shape[0]
    for k in range(robots):
        for place in range(1, places + 1):
            for rank in range(legs.known[k, 0, place]):
                extra = legs.extra[k, 0, place, rank]
                ready_s = legs.ready_s[k, 0, place, rank]
                _add_label(ways, extra, ready_s, k, place, rank, NOWHERE)
    at = 0
    while at < ways.known[0]:
        spent, origin = ways.label_real[at, EXTRA], ways.label[at, PLACE]
        given_s = ways.label_real[at, READY_S]
        if not problem.together:
            given_s += problem.transfer_s
        for k in range(robots):
            if k == ways.label[at, ROBOT]:
                continue
            for target in range(places + 1):
                if target == origin or (target > 0 and ways.label[at, TRANSFERS] >= most):
                    continue
                for rank in range(legs.known[k, origin, target]):
                    extra = spent + legs.extra[k, origin, target, rank]
                    if extra >= limit:
                        break
                    if given_s > legs.wanted_s[k, origin, target, rank] + TOLERANCE:
                        continue
                    if target == 0:
                        _remember(ways, extra, at, k, rank)
                    else:
                        ready_s = max(legs.ready_s[k, origin, target, rank], given_s)
                        _add_label(ways, extra, ready_s, k, target, rank, at)
        at += 1


@compiled
def _add_label(
    ways: Ways, extra: float, ready_s: float, robot: int, place: int, rank: int, parent: int
) -> None:
    at = ways.known[0]
    if at == LABELS:
        return
    ways.label_real[at, EXTRA] = extra
    ways.label_real[at, READY_S] = ready_s
    ways.label[at, ROBOT] = robot
    ways.label[at, PLACE] = place
    ways.label[at, RANK] = rank
    ways.label[at, PARENT] = parent
    ways.label[at, TRANSFERS] = 1
    if parent != NOWHERE:
        ways.label[at, TRANSFERS] += ways.label[parent, TRANSFERS]
    ways.known[0] += 1


@compiled
def _remember(ways: Ways, extra: float, label: int, robot: int, rank: int) -> None:
    """Keep a way where it is among the cheapest, in order of cost."""
    at = ways.known[1]
    if at == WAYS:
        if extra >= ways.extra[WAYS - 1]:
            return
        at -= 1
    ways.known[1] = at + 1
    while at > 0 and ways.extra[at - 1] > extra:
        ways.extra[at] = ways.extra[at - 1]
        for part in range(3):
            ways.last[at, part] = ways.last[at - 1, part]
        at -= 1
    ways.extra[at] = extra
    ways.last[at, 0] = label
    ways.last[at, 1] = robot
    ways.last[at, 2] = rank


@compiled
def follow(problem: ProblemArrays, plan: Plan, ways: Ways, item: int, number: int) -> bool:
    """Insert the item's nodes along a way. False, and nothing done, where it crosses itself."""
    transfers = _unroll(ways, number)
    leg = ways.leg
    for later in range(transfers + 1):
        for earlier in range(later):
            same = leg[earlier, 0] == leg[later, 0]
            if same and _load_at(ways, later) < _unload_at(ways, earlier):
                return False
    for at in range(transfers, -1, -1):
        k = leg[at, 0]
        drop = problem.load.size + item
        last = drop if at == transfers else give_node(problem, item, at)
        first = item if at == 0 else give_node(problem, item, at - 1) + 1
        put(plan, k, _unload_at(ways, at), last, ways.ends.unloading_place[leg[at, 2]])
        if at > 0 or problem.aboard[item] == NOWHERE:
            put(plan, k, _load_at(ways, at), first, ways.ends.loading_place[leg[at, 1]])
    plan.transfers[item] = transfers
    return True


@compiled
def _load_at(ways: Ways, number: int) -> int:
    leg = ways.leg
    return ways.legs.load_at[leg[number, 0], leg[number, 1], leg[number, 2], leg[number, 3]]  # type: ignore[no-any-return]


@compiled
def _unload_at(ways: Ways, number: int) -> int:
    leg = ways.leg
    return ways.legs.unload_at[leg[number, 0], leg[number, 1], leg[number, 2], leg[number, 3]]  # type: ignore[no-any-return]


@compiled
def _unroll(ways: Ways, number: int) -> int:
    """Write the legs of a way in order; how many transfers it has."""
    label = ways.last[number, 0]
    transfers = 0 if label == NOWHERE else ways.label[label, TRANSFERS]
    ways.leg[transfers, 0] = ways.last[number, 1]
    ways.leg[transfers, 1] = 0
    ways.leg[transfers, 2] = 0
    ways.leg[transfers, 3] = ways.last[number, 2]
    for at in range(transfers - 1, -1, -1):
        place = ways.label[label, PLACE]
        ways.leg[at + 1, 1] = place
        ways.leg[at, 0] = ways.label[label, ROBOT]
        ways.leg[at, 1] = 0
        ways.leg[at, 2] = place
        ways.leg[at, 3] = ways.label[label, RANK]
        label = ways.label[label, PARENT]
    return transfers
