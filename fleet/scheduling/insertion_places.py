"""Where an item could be put into routes: every way without a transfer, the best ones with one."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from fleet.scheduling.problem import Problem
from fleet.scheduling.schedule import Action, Route, Task

BEST_PLACES = 8
"""How many transfer places are tried for an item: those with the smallest detour."""
BEST_LEGS = 6
"""How many first and how many second legs are combined at each of them."""


class Leg(NamedTuple):
    """A robot loads the item before its task number `load_at` (None: it has it) and unloads it
    before its task number `unload_at`, which costs `added_m` metres."""

    added_m: float
    robot: int
    load_at: int | None
    unload_at: int


class Insertion(NamedTuple):
    """One leg, or two with a transfer at `place` between them."""

    added: float
    legs: tuple[Leg, ...]
    place: int | None


def insertions(problem: Problem, routes: Sequence[Route], item: int) -> list[Insertion]:
    """The ways to put an item in, cheapest first; `added` is weighted distance and robots."""
    robots = list(_different_robots(problem, routes))
    visits = problem.items[item]
    aboard = visits.aboard
    origin = None if aboard is not None else visits.pickup.place
    carriers = robots if aboard is None else [aboard]
    found = [
        Insertion(_weighted(problem, routes, leg), (leg,), None)
        for robot in carriers
        for leg in _legs(problem, routes, robot, origin, visits.delivery.place)
    ]
    begin = visits.pickup.place if aboard is None else problem.robots[aboard].start
    for place in _transfer_places(problem, begin, visits.delivery.place):
        givers = _best(problem, routes, carriers, origin, place)
        takers = _best(problem, routes, robots, place, visits.delivery.place)
        found.extend(
            Insertion(
                _weighted(problem, routes, give) + _weighted(problem, routes, take),
                (give, take),
                place,
            )
            for give in givers
            for take in takers
            if give.robot != take.robot
        )
    return sorted(found)


def routes_with(
    problem: Problem, routes: Sequence[Route], item: int, insertion: Insertion
) -> tuple[Route, ...]:
    """The routes with the item put in."""
    visits, changed = problem.items[item], list(routes)
    first, last = insertion.legs[0], insertion.legs[-1]
    load = Task(visits.pickup.place, Action.PICK, item)
    for leg in insertion.legs:
        unload = Task(visits.delivery.place, Action.DROP, item)
        if insertion.place is not None and leg is first:
            unload = Task(insertion.place, Action.GIVE, item, last.robot)
        elif insertion.place is not None:
            load = Task(insertion.place, Action.TAKE, item, first.robot)
        route = changed[leg.robot]
        at = leg.unload_at if leg.load_at is None else leg.load_at
        loads = () if leg.load_at is None else (load,)
        changed[leg.robot] = (
            *route[:at], *loads, *route[at : leg.unload_at], unload, *route[leg.unload_at :]
        )  # fmt: skip
    return tuple(changed)


def _different_robots(problem: Problem, routes: Sequence[Route]) -> Iterator[int]:
    """All robots, but of unused ones that are alike only the first."""
    seen = set()
    carrying = {item.aboard for item in problem.items}
    for number, robot in enumerate(problem.robots):
        if not routes[number] and number not in carrying:
            alike = (
                robot.start, robot.end, robot.capacity,
                robot.shift, robot.max_duration_s, robot.speed,
            )  # fmt: skip
            if alike in seen:
                continue
            seen.add(alike)
        yield number


def _weighted(problem: Problem, routes: Sequence[Route], leg: Leg) -> float:
    robots = 0.0 if routes[leg.robot] else problem.weights.robots
    return problem.weights.distance * leg.added_m + robots


def _transfer_places(problem: Problem, origin: int, destination: int) -> list[int]:
    places = np.array(problem.transfers.places, dtype=np.intp)
    if len(problem.robots) < 2 or not len(places):
        return []
    distance_m = problem.travel.distance_m
    detours_m = distance_m[origin, places] + distance_m[places, destination]
    nearest = np.argsort(detours_m, kind="stable")[:BEST_PLACES]
    return [int(place) for place in places[nearest[np.isfinite(detours_m[nearest])]]]


def _best(
    problem: Problem, routes: Sequence[Route], robots: Sequence[int], load: int | None, unload: int
) -> list[Leg]:
    """The legs that add least, at most two of each robot."""
    legs = [
        leg for robot in robots for leg in sorted(_legs(problem, routes, robot, load, unload))[:2]
    ]
    return sorted(legs)[:BEST_LEGS]


def _legs(
    problem: Problem, routes: Sequence[Route], robot: int, load: int | None, unload: int
) -> list[Leg]:
    """Every way to load and unload along a robot's route that there is."""
    described, distance_m = problem.robots[robot], problem.travel.distance_m
    before = np.array([described.start, *(task.place for task in routes[robot])], dtype=np.intp)
    after = np.append(before[1:], before[-1] if described.end is None else described.end)
    # Nothing follows the last task of a robot that may end anywhere.
    last = np.zeros(len(before), dtype=bool)
    last[-1] = described.end is None
    skipped_m = np.where(last, 0.0, distance_m[before, after])
    on_m = np.where(last, 0.0, distance_m[unload, after])
    with np.errstate(invalid="ignore"):
        unload_m = distance_m[before, unload] + on_m - skipped_m
        if load is None:
            return [
                Leg(added_m, robot, None, at)
                for at, added_m in enumerate(unload_m.tolist())
                if added_m < np.inf
            ]
        load_m = distance_m[before, load] + distance_m[load, after] - skipped_m
        both_m = load_m[:, None] + unload_m[None, :]
        at_once_m = distance_m[before, load] + distance_m[load, unload] + on_m - skipped_m
    np.fill_diagonal(both_m, at_once_m)
    first, second = np.nonzero(np.triu(both_m < np.inf))
    added = both_m[first, second].tolist()
    return [
        Leg(added_m, robot, at, then)
        for added_m, at, then in zip(added, first.tolist(), second.tolist(), strict=True)
    ]
