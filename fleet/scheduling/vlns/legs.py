"""The cheapest places in a route for one leg of an item's way: where it is loaded and unloaded."""

from math import inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.dice import Dice, throw
from mend.fleet.scheduling.vlns.arrays import NOWHERE, TAKE, Floats, Integers, Plan, ProblemArrays
from mend.fleet.scheduling.vlns.times import TOLERANCE, Times, drive_s, way_m

KEPT = 5
"""How many of the cheapest legs of one robot between two places are remembered."""


class Ends(NamedTuple):
    """Where one item can be loaded and unloaded: its pickup or delivery (0), then transfer places.

    All by that number. `loading` says how it is loaded there, `unloading` how it is unloaded.
    """

    known: Integers
    loading_place: Integers
    loading_s: Floats
    loading_from_s: Floats
    loading_until_s: Floats
    unloading_place: Integers
    unloading_s: Floats
    unloading_from_s: Floats
    unloading_until_s: Floats


class Legs(NamedTuple):
    """The cheapest legs by robot, end where loaded, end where unloaded and rank.

    `extra`: what it probably costs; `load_at`, `unload_at`: before which position of the route as
    it is now; `ready_s`: when it can be unloaded at the earliest; `wanted_s`: by when it must be
    loaded. `known`: how many ranks there are.
    """

    known: Integers
    extra: Floats
    load_at: Integers
    unload_at: Integers
    ready_s: Floats
    wanted_s: Floats


def ends_for(most: int) -> Ends:
    """Room for the ends of an item, `most` of them transfer places."""
    one, whole = np.zeros(most + 1), np.zeros(most + 1, np.int64)
    return Ends(
        np.zeros(1, np.int64), whole, one, one.copy(), one.copy(), whole.copy(), one.copy(),
        one.copy(), one.copy(),
    )  # fmt: skip


def legs_for(robots: int, most: int) -> Legs:
    """Room for the legs of an item over `most` transfer places."""
    shape = (robots, most + 1, most + 1, KEPT)
    whole: NDArray[np.int64] = np.zeros(shape, np.int64)
    real: NDArray[np.float64] = np.zeros(shape)
    return Legs(
        np.zeros(shape[:3], np.int64), real, whole, whole.copy(), real.copy(), real.copy()
    )  # fmt: skip


@compiled
def find_legs(
    problem: ProblemArrays, plan: Plan, times: Times, ends: Ends, legs: Legs, dice: Dice,
    robot: int, item: int, load: int, unload: int, limit: float, blink: float,
) -> None:  # fmt: skip
    """The cheapest legs of a robot from one end to another, cheaper than `limit`.

    Judged by the robot's own route and by the latest times that the other routes leave it; whether
    all routes together allow a leg is for `find_times` to say. `blink`: the share of the places
    that are overlooked, for variety.
    """
    legs.known[robot, load, unload] = 0
    aboard = load == 0 and problem.aboard[item] != NOWHERE
    free_s = times.leaves_s[robot]
    before = problem.start[robot]
    room = problem.capacity[robot] - problem.load[item] + TOLERANCE
    for at in range(plan.length[robot] + 1):
        if aboard:
            if at == 0:
                _unload_after(
                    problem, plan, times, ends, legs, dice, robot, load, unload, at, before,
                    free_s, 0.0, inf, inf, limit, blink,
                )  # fmt: skip
            return
        if free_s > ends.loading_until_s[load] + TOLERANCE:
            return
        if times.load[robot, at] <= room:
            place = ends.loading_place[load]
            arrival_s = free_s + drive_s(problem, robot, before, place)
            begin_s = max(arrival_s, ends.loading_from_s[load])
            worth = _detour_cost(problem, plan, robot, at, before, place) < _worst_kept(
                legs, robot, load, unload, limit
            )
            if worth and begin_s <= ends.loading_until_s[load] + TOLERANCE:
                _unload_after(
                    problem, plan, times, ends, legs, dice, robot, load, unload, at, place,
                    begin_s + ends.loading_s[load], way_m(problem, before, place),
                    ends.loading_until_s[load], room, limit, blink,
                )  # fmt: skip
        if at < plan.length[robot]:
            node = plan.route[robot, at]
            before = plan.place[node]
            free_s = times.begin_s[node] + problem.service_s[node]


@compiled
def _detour_cost(
    problem: ProblemArrays, plan: Plan, robot: int, at: int, before: int, place: int
) -> float:
    """What going over a place alone costs; where ways keep the triangle inequality, no leg that
    loads there costs less."""
    after = _place_at(problem, plan, robot, at)
    detour_m = way_m(problem, before, place) + way_m(problem, place, after)
    return problem.metre * (detour_m - way_m(problem, before, after))


@compiled
def _worst_kept(legs: Legs, robot: int, load: int, unload: int, limit: float) -> float:
    """What a leg must cost less than to be remembered."""
    if legs.known[robot, load, unload] < KEPT:
        return limit
    return min(limit, legs.extra[robot, load, unload, KEPT - 1])  # type: ignore[no-any-return]


@compiled
def _unload_after(
    problem: ProblemArrays, plan: Plan, times: Times, ends: Ends, legs: Legs, dice: Dice,
    robot: int, load: int, unload: int, first: int, place: int, free_s: float, there_m: float,
    wanted_s: float, room: float, limit: float, blink: float,
) -> None:  # fmt: skip
    """Try to unload at every position from `first` on, when it was loaded right before it.

    `place`, `free_s`: where and when the robot is done with loading; `there_m`: its way there.
    """
    length = plan.length[robot]
    loading_s = ends.loading_s[load]
    target = ends.unloading_place[unload]
    begun = problem.start[robot] if first == 0 else plan.place[plan.route[robot, first - 1]]
    skipped_m = way_m(problem, begun, _place_at(problem, plan, robot, first))
    lead_m = there_m + way_m(problem, place, _place_at(problem, plan, robot, first)) - skipped_m
    if wanted_s < inf or first < length:
        wanted_s = min(wanted_s, _latest_at(problem, plan, times, robot, first, place) - loading_s)
    here = place
    for at in range(first, length + 1):
        after = _place_at(problem, plan, robot, at)
        begin_s = max(free_s + drive_s(problem, robot, here, target), ends.unloading_from_s[unload])
        onward_m = way_m(problem, here, target) + way_m(problem, target, after)
        extra_m = there_m - skipped_m if at == first else lead_m - way_m(problem, here, after)
        extra_m += onward_m
        extra = _extra(problem, plan, robot, unload, extra_m, begin_s)
        if begin_s <= ends.unloading_until_s[unload] + TOLERANCE and extra < limit:
            done_s = begin_s + ends.unloading_s[unload]
            if done_s <= _latest_at(problem, plan, times, robot, at, target) + TOLERANCE and (
                blink == 0.0 or throw(dice) >= blink
            ):
                _remember(legs, robot, load, unload, extra, first, at, begin_s, wanted_s)
        if at == length:
            return
        node = plan.route[robot, at]
        if times.load[robot, at + 1] > room:
            return
        begin_s = max(free_s + drive_s(problem, robot, here, plan.place[node]),
                      problem.earliest_s[node])  # fmt: skip
        if problem.kind[node] == TAKE and not problem.together:
            begin_s = max(begin_s, times.begin_s[node - 1] + problem.transfer_s)
        if begin_s > times.latest_s[node] + TOLERANCE:
            return
        free_s = begin_s + problem.service_s[node]
        if free_s > ends.unloading_until_s[unload] + TOLERANCE:
            return
        here = plan.place[node]


@compiled
def _place_at(problem: ProblemArrays, plan: Plan, robot: int, at: int) -> int:
    """The place at a position of a route, the robot's end after the last."""
    if at < plan.length[robot]:
        return plan.place[plan.route[robot, at]]  # type: ignore[no-any-return]
    return problem.end[robot]  # type: ignore[no-any-return]


@compiled
def _latest_at(
    problem: ProblemArrays, plan: Plan, times: Times, robot: int, at: int, place: int
) -> float:
    """By when the robot must leave `place` to be in time at a position of its route."""
    if at < plan.length[robot]:
        node = plan.route[robot, at]
        return times.latest_s[node] - drive_s(problem, robot, place, plan.place[node])  # type: ignore[no-any-return]
    return problem.shift_end_s[robot] - drive_s(problem, robot, place, problem.end[robot])  # type: ignore[no-any-return]


@compiled
def _extra(
    problem: ProblemArrays, plan: Plan, robot: int, unload: int, extra_m: float, ready_s: float
) -> float:
    """What a leg probably costs; exact where only distance and robots count."""
    extra = problem.metre * extra_m
    if unload == 0:
        extra += problem.second * ready_s
    if plan.length[robot] == 0:
        extra += problem.weight_robots
    return extra


@compiled
def _remember(
    legs: Legs, robot: int, load: int, unload: int, extra: float, load_at: int, unload_at: int,
    ready_s: float, wanted_s: float,
) -> None:  # fmt: skip
    """Keep a leg where it is among the cheapest, in order of cost."""
    count = legs.known[robot, load, unload]
    if count == KEPT:
        if extra >= legs.extra[robot, load, unload, KEPT - 1]:
            return
        count -= 1
    rank = count
    while rank > 0 and legs.extra[robot, load, unload, rank - 1] > extra:
        legs.extra[robot, load, unload, rank] = legs.extra[robot, load, unload, rank - 1]
        legs.load_at[robot, load, unload, rank] = legs.load_at[robot, load, unload, rank - 1]
        legs.unload_at[robot, load, unload, rank] = legs.unload_at[robot, load, unload, rank - 1]
        legs.ready_s[robot, load, unload, rank] = legs.ready_s[robot, load, unload, rank - 1]
        legs.wanted_s[robot, load, unload, rank] = legs.wanted_s[robot, load, unload, rank - 1]
        rank -= 1
    legs.extra[robot, load, unload, rank] = extra
    legs.load_at[robot, load, unload, rank] = load_at
    legs.unload_at[robot, load, unload, rank] = unload_at
    legs.ready_s[robot, load, unload, rank] = ready_s
    legs.wanted_s[robot, load, unload, rank] = wanted_s
    legs.known[robot, load, unload] = count + 1
