"""The cheapest places in one robot's route to load an item at one end and unload it at another.

Judged by the robot's own times and by how late the others let it be; whether all routes together
allow a leg is for the temporal network to say.
"""

from math import inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mend.fleet.scheduling.compiled import compiled

KEPT = 4
"""How many of the cheapest legs of one robot between two ends are remembered."""
FAR = 1e12
"""Metres and seconds of a way that does not exist; finite, so that differences stay numbers."""
ABOARD = -1
"""Where a leg begins whose item is on board already."""
ANYWHERE = -1
"""The end of a robot that may end anywhere."""
TOLERANCE_S = 1e-7

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


class RouteTimes(NamedTuple):
    """A robot's route: by position 0 its start, then its tasks.

    `load`: on board after it; `latest_s`: by when it must begin. `held`: nothing may be put before
    this position's task.
    """

    place: Integers
    begin_s: Floats
    service_s: Floats
    latest_s: Floats
    load: Floats
    held: int
    end: int
    end_latest_s: float
    capacity: float
    speed: float


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


class Prices(NamedTuple):
    """What a leg costs per metre, per second until the delivery is done, per second that it is
    late, and for a robot that does nothing else."""

    metre: float
    second: float
    late_second: float
    due_s: float
    robot: float


class Legs(NamedTuple):
    """The cheapest legs by end where loaded, end where unloaded and rank; `extra` infinite: none.

    `ready_s`: when it begins to unload at the earliest; `wanted_s`: by when it must load.
    """

    extra: Floats
    metres: Floats
    load_at: Integers
    unload_at: Integers
    ready_s: Floats
    wanted_s: Floats


def no_legs(ends: int) -> Legs:
    """Room for the legs of one robot between so many ends."""
    shape = (ends, ends, KEPT)
    return Legs(
        np.full(shape, inf), np.zeros(shape), np.zeros(shape, np.int64), np.zeros(shape, np.int64),
        np.zeros(shape), np.zeros(shape),
    )  # fmt: skip


@compiled
def find_legs(
    distance_m: Floats, time_s: Floats, route: RouteTimes, ends: Ends, prices: Prices,
    load: float, aboard: bool, first: bool, legs: Legs,
) -> None:  # fmt: skip
    """Find the legs between all ends.

    `aboard`: this robot has the item, so that end 0 is where it starts; `first`: it may be the one
    that brings the item away from end 0.
    """
    for origin in range(ends.load_place.size):
        if origin == 0 and not first:
            continue
        for target in range(ends.unload_place.size):
            if origin == target and origin > 0:
                continue
            if origin == 0 and aboard:
                _unload_after(
                    distance_m, time_s, route, ends, prices, legs, origin, target, ABOARD,
                    route.place[0], route.begin_s[0], inf, route.capacity + 1e-9,
                )  # fmt: skip
            else:
                _load_anywhere(
                    distance_m, time_s, route, ends, prices, legs, origin, target,
                    route.capacity - load + 1e-9,
                )  # fmt: skip


@compiled
def _load_anywhere(
    distance_m: Floats, time_s: Floats, route: RouteTimes, ends: Ends, prices: Prices, legs: Legs,
    origin: int, target: int, room: float,
) -> None:  # fmt: skip
    place = ends.load_place[origin]
    for at in range(route.held, route.place.size):
        free_s = route.begin_s[at] + route.service_s[at]
        if free_s > ends.load_until_s[origin] + TOLERANCE_S:
            return
        if route.load[at] > room:
            continue
        begin_s = free_s + time_s[route.place[at], place] / route.speed
        begin_s = max(begin_s, ends.load_from_s[origin])
        if begin_s <= ends.load_until_s[origin] + TOLERANCE_S:
            _unload_after(
                distance_m, time_s, route, ends, prices, legs, origin, target, at, place,
                begin_s + ends.load_s[origin], ends.load_until_s[origin], room,
            )  # fmt: skip


@compiled
def _unload_after(
    distance_m: Floats, time_s: Floats, route: RouteTimes, ends: Ends, prices: Prices, legs: Legs,
    origin: int, target: int, load_at: int, place: int, free_s: float, wanted_s: float, room: float,
) -> None:  # fmt: skip
    """Try to unload at every position, when the robot was done with loading at `free_s`."""
    target_place, length = ends.unload_place[target], route.place.size
    first = 0 if load_at == ABOARD else load_at
    begun = route.place[first]
    loading_s = 0.0 if load_at == ABOARD else ends.load_s[origin]
    next_place = _place_after(route, first)
    skipped_m = _way_m(distance_m, begun, next_place)
    there_m = 0.0 if load_at == ABOARD else distance_m[begun, place]
    lead_m = there_m + _way_m(distance_m, place, next_place) - skipped_m
    leave_s = _leave_by_s(time_s, route, first, place) - loading_s
    here = place
    for at in range(first, length):
        after = _place_after(route, at)
        ready_s = free_s + time_s[here, target_place] / route.speed
        ready_s = max(ready_s, ends.unload_from_s[target])
        done_s = ready_s + ends.unload_s[target]
        if (
            at >= route.held
            and ready_s <= ends.unload_until_s[target] + TOLERANCE_S
            and done_s <= _leave_by_s(time_s, route, at, target_place) + TOLERANCE_S
        ):
            metres = (
                there_m - skipped_m if at == first else lead_m - _way_m(distance_m, here, after)
            )
            metres += distance_m[here, target_place] + _way_m(distance_m, target_place, after)
            until_s = wanted_s if at == first else min(wanted_s, leave_s)
            extra = _price(prices, metres, target, ready_s, done_s) + (
                prices.robot if length == 1 else 0.0
            )
            _remember(legs, origin, target, extra, metres, load_at, at, ready_s, until_s)
        if at + 1 == length or route.load[at + 1] > room:
            return
        begin_s = free_s + time_s[here, route.place[at + 1]] / route.speed
        begin_s = max(begin_s, route.begin_s[at + 1])
        if begin_s > route.latest_s[at + 1] + TOLERANCE_S:
            return
        free_s = begin_s + route.service_s[at + 1]
        here = route.place[at + 1]


@compiled
def _place_after(route: RouteTimes, at: int) -> int:
    return route.place[at + 1] if at + 1 < route.place.size else route.end


@compiled
def _way_m(distance_m: Floats, origin: int, destination: int) -> float:
    if destination == ANYWHERE:
        return 0.0
    return distance_m[origin, destination]  # type: ignore[no-any-return]


@compiled
def _leave_by_s(time_s: Floats, route: RouteTimes, at: int, place: int) -> float:
    """By when the robot must leave `place` to be in time for what follows position `at`."""
    if at + 1 < route.place.size:
        return route.latest_s[at + 1] - time_s[place, route.place[at + 1]] / route.speed  # type: ignore[no-any-return]
    if route.end == ANYWHERE:
        return route.end_latest_s
    return route.end_latest_s - time_s[place, route.end] / route.speed  # type: ignore[no-any-return]


@compiled
def _price(prices: Prices, metres: float, target: int, ready_s: float, done_s: float) -> float:
    price = prices.metre * metres
    if target == 0:
        price += prices.second * done_s
        price += prices.late_second * max(0.0, ready_s - prices.due_s)
    return price


@compiled
def _remember(
    legs: Legs, origin: int, target: int, extra: float, metres: float, load_at: int,
    unload_at: int, ready_s: float, wanted_s: float,
) -> None:  # fmt: skip
    """Keep a leg where it is among the cheapest, in order of cost."""
    if metres > FAR / 2 or not extra < legs.extra[origin, target, KEPT - 1]:
        return
    rank = KEPT - 1
    while rank > 0 and legs.extra[origin, target, rank - 1] > extra:
        legs.extra[origin, target, rank] = legs.extra[origin, target, rank - 1]
        legs.metres[origin, target, rank] = legs.metres[origin, target, rank - 1]
        legs.load_at[origin, target, rank] = legs.load_at[origin, target, rank - 1]
        legs.unload_at[origin, target, rank] = legs.unload_at[origin, target, rank - 1]
        legs.ready_s[origin, target, rank] = legs.ready_s[origin, target, rank - 1]
        legs.wanted_s[origin, target, rank] = legs.wanted_s[origin, target, rank - 1]
        rank -= 1
    legs.extra[origin, target, rank] = extra
    legs.metres[origin, target, rank] = metres
    legs.load_at[origin, target, rank] = load_at
    legs.unload_at[origin, target, rank] = unload_at
    legs.ready_s[origin, target, rank] = ready_s
    legs.wanted_s[origin, target, rank] = wanted_s
