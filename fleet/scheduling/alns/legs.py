"""The cheapest places in a route for one leg of an item: where it is loaded and unloaded."""

from math import inf
from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.alns.driving import arrival, latest_leave
from mend.fleet.scheduling.alns.plan import Plan
from mend.fleet.scheduling.alns.problem_arrays import (
    NOBODY,
    UNREACHABLE,
    Floats,
    Integers,
    ProblemArrays,
    origin_of,
)
from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.tolerance import LOAD, SEARCH_S

KEPT = 5
"""How many of the cheapest legs of one robot between two ends are remembered."""


class Ends(NamedTuple):
    """Where an item can be loaded and unloaded: its pickup or delivery (0), then transfer places.

    By that number: `load_...` how it is loaded there, `unload_...` how it is unloaded there.
    """

    load_place: Integers
    load_s: Floats
    load_from_s: Floats
    load_until_s: Floats
    unload_place: Integers
    unload_s: Floats
    unload_from_s: Floats
    unload_until_s: Floats


class Legs(NamedTuple):
    """The cheapest legs by slot and rank; `known` of them by slot, for a `version` of the row.

    `extra`: what a leg probably costs; `load_at`, `unload_at`: after which position of the row as
    it is now; `ready_s`: when it can be unloaded at the earliest; `wanted_s`: by when it must be
    loaded.
    """

    known: Integers
    version: Integers
    extra: Floats
    load_at: Integers
    unload_at: Integers
    ready_s: Floats
    wanted_s: Floats


class Wanted(NamedTuple):
    """Legs in a row between two ends of an item, cheaper than `limit`: the `most` cheapest, or any
    one if that `will_do`."""

    slot: int
    row: int
    item: int
    origin: int
    target: int
    limit: float
    most: int
    any_will_do: bool


class Loaded(NamedTuple):
    """An item was loaded after a position of a row: the robot is at a place, free from a time on.

    `there_m`: its way there; `until_s`: by when it must load; `leave_s`: by when to be in time for
    what follows; `room`: how much may be on board besides the item.
    """

    at: int
    place: int
    free_s: float
    there_m: float
    until_s: float
    leave_s: float
    room: float


def ends_for(places: int) -> Ends:
    """Room for the ends of an item, so many of them transfer places."""
    whole, real = np.zeros(places + 1, np.int64), np.zeros(places + 1)
    return Ends(
        whole, real, real.copy(), real.copy(), whole.copy(), real.copy(), real.copy(), real.copy()
    )


def legs_for(slots: int) -> Legs:
    """Room for legs in so many slots."""
    whole, real = np.zeros((slots, KEPT), np.int64), np.zeros((slots, KEPT))
    return Legs(
        np.zeros(slots, np.int64), np.full(slots, -1, np.int64), real, whole, whole.copy(),
        real.copy(), real.copy(),
    )  # fmt: skip


@compiled
def open_home(problem: ProblemArrays, ends: Ends, item: int) -> None:
    """The item's own ends: its pickup and its delivery."""
    drop = problem.size.size + item
    ends.load_place[0], ends.load_s[0] = origin_of(problem, item), problem.service_s[item]
    ends.load_from_s[0], ends.load_until_s[0] = problem.earliest_s[item], problem.latest_s[item]
    ends.unload_place[0], ends.unload_s[0] = problem.place[drop], problem.service_s[drop]
    ends.unload_from_s[0], ends.unload_until_s[0] = problem.earliest_s[drop], problem.latest_s[drop]


@compiled
def open_transfer(problem: ProblemArrays, ends: Ends, item: int, end: int, place: int) -> None:
    """The item's end of a number is a transfer place."""
    drop = problem.size.size + item
    soonest_s = problem.time_s[ends.load_place[0], place] / problem.fastest
    if problem.carrier[item] == NOBODY:
        soonest_s += problem.earliest_s[item] + problem.service_s[item]
    onward_s = problem.time_s[place, problem.place[drop]] / problem.fastest
    last_s = problem.latest_s[drop] - onward_s - problem.transfer_s
    apart_s = 0.0 if problem.together else problem.transfer_s
    ends.load_place[end] = ends.unload_place[end] = place
    ends.load_s[end] = ends.unload_s[end] = problem.transfer_s
    ends.unload_from_s[end], ends.unload_until_s[end] = soonest_s, last_s - apart_s
    ends.load_from_s[end], ends.load_until_s[end] = soonest_s + apart_s, last_s


@compiled
def find_legs(problem: ProblemArrays, plan: Plan, ends: Ends, legs: Legs, wanted: Wanted) -> None:
    """Write the legs to their slot.

    Judged by the robot's own route and by the latest times that the other routes leave it; whether
    all routes together allow a leg is for `update` to say. Costs and times are taken to obey the
    triangle inequality: where they do not, some legs are missed, but none is wrong.
    """
    row, item = wanted.row, wanted.item
    legs.known[wanted.slot] = 0
    robot, last = plan.owner[row], plan.length[row] - 1
    place = ends.load_place[wanted.origin]
    if wanted.origin == 0 and problem.carrier[item] != NOBODY:
        carried = Loaded(0, place, plan.begin_s[row, 0], 0.0, inf, inf, inf)
        _unload_after(problem, plan, ends, legs, (wanted, carried))
        return
    room = problem.capacity[robot] - problem.size[item] + LOAD
    until_s, loading_s = ends.load_until_s[wanted.origin], ends.load_s[wanted.origin]
    opening = problem.weight_robots if last == 1 else 0.0
    for at in range(problem.held[robot], last):
        node = plan.node[row, at]
        here, following = plan.place[node], plan.place[plan.node[row, at + 1]]
        free_s = plan.begin_s[row, at] + problem.service_s[node]
        if free_s > until_s + SEARCH_S:
            return
        if plan.load[row, at] > room:
            continue
        there_m = problem.distance_m[here, place]
        detour_m = there_m + problem.distance_m[place, following]
        detour_m -= problem.distance_m[here, following]
        if problem.metre * detour_m + opening >= _worst_kept(legs, wanted):
            continue
        begin_s = max(arrival(problem, robot, here, place, free_s), ends.load_from_s[wanted.origin])
        if begin_s > until_s + SEARCH_S:
            continue
        leave_s = latest_leave(problem, robot, place, following, plan.latest_s[row, at + 1])
        loaded = Loaded(at, place, begin_s + loading_s, there_m, until_s, leave_s - loading_s, room)
        _unload_after(problem, plan, ends, legs, (wanted, loaded))
        if wanted.any_will_do and legs.known[wanted.slot] > 0:
            return


@compiled
def _unload_after(
    problem: ProblemArrays, plan: Plan, ends: Ends, legs: Legs, leg: tuple[Wanted, Loaded]
) -> None:
    """Try to unload at every position from where it was loaded on."""
    wanted, loaded = leg
    row, robot, last = wanted.row, plan.owner[wanted.row], plan.length[wanted.row] - 1
    target, until_s = ends.unload_place[wanted.target], ends.unload_until_s[wanted.target]
    from_s, lasts_s = ends.unload_from_s[wanted.target], ends.unload_s[wanted.target]
    following = plan.place[plan.node[row, loaded.at + 1]]
    skipped_m = problem.distance_m[plan.place[plan.node[row, loaded.at]], following]
    lead_m = loaded.there_m + problem.distance_m[loaded.place, following] - skipped_m
    opening = problem.weight_robots if last == 1 else 0.0
    here, free_s = loaded.place, loaded.free_s
    for at in range(loaded.at, last):
        node = plan.node[row, at + 1]
        following = plan.place[node]
        metres = problem.distance_m[here, target] + problem.distance_m[target, following]
        if at == loaded.at:
            metres += loaded.there_m - skipped_m
        else:
            metres += lead_m - problem.distance_m[here, following]
        extra = problem.metre * metres + opening
        if at >= problem.held[robot] and extra < _worst_kept(legs, wanted):
            ready_s = max(arrival(problem, robot, here, target, free_s), from_s)
            done_s = ready_s + lasts_s
            if wanted.target == 0:
                extra += problem.weight_completion * done_s
                due_s = problem.due_s[problem.size.size + wanted.item]
                extra += problem.weight_lateness * max(0.0, ready_s - due_s)
            if (
                ready_s <= until_s + SEARCH_S
                and arrival(problem, robot, target, following, done_s)
                <= plan.latest_s[row, at + 1] + SEARCH_S
            ):
                wanted_s = loaded.until_s
                if at > loaded.at:
                    wanted_s = min(wanted_s, loaded.leave_s)
                _remember(legs, wanted, extra, (loaded.at, at), (ready_s, wanted_s))
                if wanted.any_will_do and legs.known[wanted.slot] > 0:
                    return
        if at + 1 == last or plan.load[row, at + 1] > loaded.room:
            return
        begin_s = max(arrival(problem, robot, here, following, free_s), plan.begin_s[row, at + 1])
        if begin_s > plan.latest_s[row, at + 1] + SEARCH_S:
            return
        free_s = begin_s + problem.service_s[node]
        if free_s > until_s + SEARCH_S:
            return
        here = following


@compiled
def _worst_kept(legs: Legs, wanted: Wanted) -> float:
    """What a leg must cost less than to be remembered."""
    if legs.known[wanted.slot] < wanted.most:
        return wanted.limit
    return min(wanted.limit, legs.extra[wanted.slot, wanted.most - 1])  # type: ignore[no-any-return]


@compiled
def _remember(
    legs: Legs, wanted: Wanted, extra: float, at: tuple[int, int], times_s: tuple[float, float]
) -> None:
    """Keep a leg where it is among the cheapest, in order of cost."""
    slot = wanted.slot
    if not extra < min(_worst_kept(legs, wanted), UNREACHABLE / 2):
        return
    rank = min(legs.known[slot], wanted.most - 1)
    legs.known[slot] = rank + 1
    while rank > 0 and legs.extra[slot, rank - 1] > extra:
        legs.extra[slot, rank] = legs.extra[slot, rank - 1]
        legs.load_at[slot, rank] = legs.load_at[slot, rank - 1]
        legs.unload_at[slot, rank] = legs.unload_at[slot, rank - 1]
        legs.ready_s[slot, rank] = legs.ready_s[slot, rank - 1]
        legs.wanted_s[slot, rank] = legs.wanted_s[slot, rank - 1]
        rank -= 1
    legs.extra[slot, rank] = extra
    legs.load_at[slot, rank], legs.unload_at[slot, rank] = at
    legs.ready_s[slot, rank], legs.wanted_s[slot, rank] = times_s
