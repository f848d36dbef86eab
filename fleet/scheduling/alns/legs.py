"""The cheapest places in a route for one leg of an item: where it is loaded and unloaded."""

from math import inf
from typing import NamedTuple

from mend.fleet.scheduling.alns.driving import arrival, latest_leave
from mend.fleet.scheduling.alns.plan import Plan
from mend.fleet.scheduling.alns.problem_arrays import (
    DROP,
    GIVE,
    NOBODY,
    UNREACHABLE,
    ProblemArrays,
    origin_of,
)
from mend.fleet.scheduling.alns.records import Records, records
from mend.fleet.scheduling.compiled import compiled, inlined
from mend.fleet.scheduling.tolerance import LOAD, SEARCH_S

KEPT = 5
"""How many of the cheapest legs of one robot between two ends are remembered."""


class Legs(NamedTuple):
    """The cheapest legs by slot and rank: `known` of them by slot, for a `version` of the row.

    `extra`: what a leg probably costs; `load_at`, `unload_at`: after which position of the row as
    it is now; `ready_s`: when it can be unloaded at the earliest; `wanted_s`: by when it must be
    loaded.
    """

    slots: Records
    ranked: Records


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


def ends_for(places: int) -> Records:
    """Room for the ends of an item, so many of them transfer places.

    End 0 is its pickup or delivery. `load_...`: how it is loaded there, `unload_...`: how it is
    unloaded there.
    """
    times = "load_s load_from_s load_until_s unload_s unload_from_s unload_until_s"
    return records(places + 1, "load_place unload_place", times)


def legs_for(slots: int) -> Legs:
    """Room for legs in so many slots."""
    legs = Legs(
        records(slots, "known version"),
        records((slots, KEPT), "load_at unload_at", "extra ready_s wanted_s"),
    )
    legs.slots.version = -1
    return legs


@compiled
def open_home(problem: ProblemArrays, ends: Records, item: int) -> None:
    """The item's own ends: its pickup and its delivery."""
    drop = problem.items.size + item
    ends[0].load_place, ends[0].load_s = origin_of(problem, item), problem.nodes[item].service_s
    ends[0].load_from_s, ends[0].load_until_s = (
        problem.nodes[item].earliest_s,
        problem.nodes[item].latest_s,
    )
    ends[0].unload_place, ends[0].unload_s = (
        problem.nodes[drop].place,
        problem.nodes[drop].service_s,
    )
    ends[0].unload_from_s, ends[0].unload_until_s = (
        problem.nodes[drop].earliest_s,
        problem.nodes[drop].latest_s,
    )


@compiled
def open_transfer(problem: ProblemArrays, ends: Records, item: int, end: int, place: int) -> None:
    """The item's end of a number is a transfer place."""
    drop = problem.items.size + item
    soonest_s = problem.time_s[ends[0].load_place, place] / problem.fastest
    if problem.items[item].carrier == NOBODY:
        soonest_s += problem.nodes[item].earliest_s + problem.nodes[item].service_s
    onward_s = problem.time_s[place, problem.nodes[drop].place] / problem.fastest
    last_s = problem.nodes[drop].latest_s - onward_s - problem.transfer_s
    apart_s = 0.0 if problem.together else problem.transfer_s
    ends[end].load_place = ends[end].unload_place = place
    ends[end].load_s = ends[end].unload_s = problem.transfer_s
    ends[end].unload_from_s, ends[end].unload_until_s = soonest_s, last_s - apart_s
    ends[end].load_from_s, ends[end].load_until_s = soonest_s + apart_s, last_s


@compiled
def find_legs(
    problem: ProblemArrays, plan: Plan, ends: Records, legs: Legs, wanted: Wanted
) -> None:
    """Write the legs to their slot.

    Judged by the robot's own route and by the latest times that the other routes leave it; whether
    all routes together allow a leg is for `update` to say. Costs and times are taken to obey the
    triangle inequality: where they do not, some legs are missed, but none is wrong.
    """
    row, item = wanted.row, wanted.item
    legs.slots[wanted.slot].known = 0
    robot, last = plan.rows[row].owner, plan.rows[row].length - 1
    place = ends[wanted.origin].load_place
    if wanted.origin == 0 and problem.items[item].carrier != NOBODY:
        carried = Loaded(0, place, plan.stops[row, 0].begin_s, 0.0, inf, inf, inf)
        _unload_after(problem, plan, ends, legs, (wanted, carried))
        return
    room = problem.robots[robot].capacity - problem.items[item].load + LOAD
    until_s, loading_s = ends[wanted.origin].load_until_s, ends[wanted.origin].load_s
    opening = problem.weight_robots if last == 1 else 0.0
    for at in range(problem.robots[robot].held, last):
        node = plan.stops[row, at].node
        here, following = plan.tasks[node].place, plan.tasks[plan.stops[row, at + 1].node].place
        free_s = plan.stops[row, at].begin_s + problem.nodes[node].service_s
        if free_s > until_s + SEARCH_S:
            return
        if plan.stops[row, at].load > room:
            continue
        there_m = problem.distance_m[here, place]
        detour_m = there_m + problem.distance_m[place, following]
        detour_m -= problem.distance_m[here, following]
        if problem.metre * detour_m + opening >= _worst_kept(legs, wanted):
            continue
        begin_s = max(arrival(problem, robot, here, place, free_s), ends[wanted.origin].load_from_s)
        if begin_s > until_s + SEARCH_S:
            continue
        leave_s = latest_leave(problem, robot, place, following, plan.stops[row, at + 1].latest_s)
        loaded = Loaded(at, place, begin_s + loading_s, there_m, until_s, leave_s - loading_s, room)
        _unload_after(problem, plan, ends, legs, (wanted, loaded))
        if wanted.any_will_do and legs.slots[wanted.slot].known > 0:
            return


@compiled
def _unload_after(
    problem: ProblemArrays, plan: Plan, ends: Records, legs: Legs, leg: tuple[Wanted, Loaded]
) -> None:
    """Try to unload at every position from where it was loaded on."""
    wanted, loaded = leg
    row, robot, last = wanted.row, plan.rows[wanted.row].owner, plan.rows[wanted.row].length - 1
    target, until_s = ends[wanted.target].unload_place, ends[wanted.target].unload_until_s
    from_s, lasts_s = ends[wanted.target].unload_from_s, ends[wanted.target].unload_s
    following = plan.tasks[plan.stops[row, loaded.at + 1].node].place
    skipped_m = problem.distance_m[plan.tasks[plan.stops[row, loaded.at].node].place, following]
    lead_m = loaded.there_m + problem.distance_m[loaded.place, following] - skipped_m
    opening = problem.weight_robots if last == 1 else 0.0
    here, free_s, pushed = loaded.place, loaded.free_s, 0.0
    for at in range(loaded.at, last):
        node = plan.stops[row, at + 1].node
        following = plan.tasks[node].place
        metres = problem.distance_m[here, target] + problem.distance_m[target, following]
        if at == loaded.at:
            metres += loaded.there_m - skipped_m
        else:
            metres += lead_m - problem.distance_m[here, following]
        extra = problem.metre * metres + opening + pushed
        if at >= problem.robots[robot].held and extra < _worst_kept(legs, wanted):
            ready_s = max(arrival(problem, robot, here, target, free_s), from_s)
            done_s = ready_s + lasts_s
            if wanted.target == 0:
                extra += problem.weight_completion * done_s
                due_s = problem.nodes[problem.items.size + wanted.item].due_s
                extra += problem.weight_lateness * max(0.0, ready_s - due_s)
            if (
                ready_s <= until_s + SEARCH_S
                and arrival(problem, robot, target, following, done_s)
                <= plan.stops[row, at + 1].latest_s + SEARCH_S
            ):
                extra += _push_back(problem, plan, row, (at, target, done_s))
                wanted_s = loaded.until_s
                if at > loaded.at:
                    wanted_s = min(wanted_s, loaded.leave_s)
                _remember(legs, wanted, extra, (loaded.at, at), (ready_s, wanted_s))
                if wanted.any_will_do and legs.slots[wanted.slot].known > 0:
                    return
        if at + 1 == last or plan.stops[row, at + 1].load > loaded.room:
            return
        begin_s = max(
            arrival(problem, robot, here, following, free_s), plan.stops[row, at + 1].begin_s
        )
        if begin_s > plan.stops[row, at + 1].latest_s + SEARCH_S:
            return
        pushed += _delay_cost(problem, node, begin_s, plan.stops[row, at + 1].begin_s)
        free_s = begin_s + problem.nodes[node].service_s
        if free_s > until_s + SEARCH_S:
            return
        here = following


@compiled
def _push_back(problem: ProblemArrays, plan: Plan, row: int, left: tuple[int, int, float]) -> float:
    """What it costs that a robot is free only at a time, at a place, after a position of its row.

    What other robots do later then is left out.
    """
    at, here, free_s = left
    if problem.timeless:
        return 0.0
    robot, cost = plan.rows[row].owner, 0.0
    for after in range(at + 1, plan.rows[row].length):
        stop = plan.stops[row, after]
        following = plan.tasks[stop.node].place
        begin_s = arrival(problem, robot, here, following, free_s)
        if begin_s <= stop.begin_s:
            return cost
        cost += _delay_cost(problem, stop.node, begin_s, stop.begin_s)
        here, free_s = following, begin_s + problem.nodes[stop.node].service_s
    return cost


@inlined
def _delay_cost(problem: ProblemArrays, node: int, begin_s: float, before_s: float) -> float:
    """What it costs that a node begins then, and not at the time of before."""
    kind, price = problem.nodes[node].kind, 0.0
    if kind in (DROP, GIVE):
        price += problem.weight_completion * (begin_s - before_s)
    due_s = problem.nodes[node].due_s
    if begin_s > due_s:
        price += problem.weight_lateness * (begin_s - max(before_s, due_s))
    return price


@inlined
def _worst_kept(legs: Legs, wanted: Wanted) -> float:
    """What a leg must cost less than to be remembered."""
    if legs.slots[wanted.slot].known < wanted.most:
        return wanted.limit
    return min(wanted.limit, legs.ranked[wanted.slot, wanted.most - 1].extra)  # type: ignore[no-any-return]


@inlined
def _remember(
    legs: Legs, wanted: Wanted, extra: float, at: tuple[int, int], times_s: tuple[float, float]
) -> None:
    """Keep a leg where it is among the cheapest, in order of cost."""
    slot = wanted.slot
    if not extra < min(_worst_kept(legs, wanted), UNREACHABLE / 2):
        return
    rank = min(legs.slots[slot].known, wanted.most - 1)
    legs.slots[slot].known = rank + 1
    while rank > 0 and legs.ranked[slot, rank - 1].extra > extra:
        legs.ranked[slot, rank].extra = legs.ranked[slot, rank - 1].extra
        legs.ranked[slot, rank].load_at = legs.ranked[slot, rank - 1].load_at
        legs.ranked[slot, rank].unload_at = legs.ranked[slot, rank - 1].unload_at
        legs.ranked[slot, rank].ready_s = legs.ranked[slot, rank - 1].ready_s
        legs.ranked[slot, rank].wanted_s = legs.ranked[slot, rank - 1].wanted_s
        rank -= 1
    legs.ranked[slot, rank].extra = extra
    legs.ranked[slot, rank].load_at, legs.ranked[slot, rank].unload_at = at
    legs.ranked[slot, rank].ready_s, legs.ranked[slot, rank].wanted_s = times_s
