"""The problem as arrays, as the kernels of the search without transfers read it.

A node is where a robot can be: `item` its pickup, `items + item` its delivery, then every robot's
start, then every robot's end.
"""

from dataclasses import replace
from math import isfinite
from typing import NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from mend.fleet.scheduling.problem import Problem, Robot, Visit
from mend.fleet.scheduling.solution import UnsupportedError

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Flags = NDArray[np.bool_]

NOBODY = cast(int, np.int64(-1))
"""No plain number, as a kernel would be compiled once more for every one."""
UNREACHABLE = 1e12
"""Metres and seconds of a way that does not exist; finite, so that differences stay numbers."""
TIME_SHARE = 0.3
"""How much items are related by when they are due, compared with by where they are."""


class RoutingArrays(NamedTuple):
    """A problem. Arrays by node (v), item (n) or robot (m)."""

    cost: Floats
    """By node and node: what driving there costs."""
    time_s: Floats
    """By node and node: how long it takes at speed 1."""
    earliest_s: Floats
    latest_s: Floats
    service_s: Floats
    load: Floats
    """By node: what the load of the robot changes by."""
    capacity: Floats
    pace: Floats
    """By robot: what its travel times are multiplied by."""
    twin: Integers
    """By robot: the one before it that can do exactly the same, or `NOBODY`."""
    near: Integers
    """By item: all others, the most related first."""
    robot_cost: float


def unsupported(problem: Problem) -> str | None:
    """What in a problem this search does not know; None where it knows everything."""
    if problem.travel.epochs:
        return "doors that open and close"
    if problem.weights.makespan or problem.weights.completion:
        return "a weight for time"
    visits = [visit for item in problem.items for visit in (item.pickup, item.delivery)]
    if problem.weights.lateness and any(isfinite(visit.due_s) for visit in visits):
        return "items that are due"
    if any(item.aboard is not None for item in problem.items):
        return "items that are aboard already"
    if any(isfinite(item.max_on_board_s) for item in problem.items):
        return "a longest time on board"
    if any(isfinite(robot.max_duration_s) for robot in problem.robots):
        return "a longest time that a robot is away"
    return None


def routing_arrays(problem: Problem) -> RoutingArrays:
    """The problem without transfers. Raises `UnsupportedError`."""
    unknown = unsupported(problem)
    if unknown is not None:
        raise UnsupportedError(f"the search 'alns' does not know {unknown}")
    items, robots = problem.items, problem.robots
    visits = [item.pickup for item in items] + [item.delivery for item in items]
    idle = np.zeros(len(robots))
    loads = np.array([item.load for item in items], np.float64)
    cost = _between(problem, problem.travel.distance_m, visits) * problem.weights.distance
    return RoutingArrays(
        cost=cost,
        time_s=_between(problem, problem.travel.time_s, visits),
        earliest_s=np.array(
            [visit.window.earliest_s for visit in visits]
            + 2 * [robot.shift.earliest_s for robot in robots]
        ),
        latest_s=np.array(
            [visit.window.latest_s for visit in visits]
            + 2 * [robot.shift.latest_s for robot in robots]
        ),
        service_s=np.concatenate(([visit.service_s for visit in visits], idle, idle)),
        load=np.concatenate((loads, -loads, idle, idle)),
        capacity=np.array([robot.capacity for robot in robots], np.float64),
        pace=np.array([1.0 / robot.speed for robot in robots]),
        twin=_twins(robots),
        near=_related(problem),
        robot_cost=float(problem.weights.robots),
    )


def _between(problem: Problem, matrix: Floats, visits: list[Visit]) -> Floats:
    """By node and node, from what is by place and place; an end that may be anywhere is near."""
    places = [visit.place for visit in visits]
    places += [robot.start for robot in problem.robots]
    places += [robot.start if robot.end is None else robot.end for robot in problem.robots]
    finite = np.where(np.isfinite(matrix), matrix, UNREACHABLE)
    between = np.ascontiguousarray(finite[np.ix_(places, places)])
    first = len(visits) + len(problem.robots)
    for number, robot in enumerate(problem.robots):
        if robot.end is None:
            between[:, first + number] = 0.0
    return between


def _twins(robots: tuple[Robot, ...]) -> Integers:
    seen: dict[object, int] = {}
    twins = np.full(len(robots), NOBODY, np.int64)
    for number, robot in enumerate(robots):
        same = replace(robot, name="")
        twins[number] = seen.get(same, NOBODY)
        seen[same] = number
    return twins


def _related(problem: Problem) -> Integers:
    """By item: the others, those first that are near, and to be fetched and brought when it is."""
    time_s = np.minimum(problem.travel.time_s, UNREACHABLE)
    apart = np.zeros((len(problem.items), len(problem.items)))
    for visits in (
        [item.pickup for item in problem.items],
        [item.delivery for item in problem.items],
    ):
        places = [visit.place for visit in visits]
        begins_s = np.array([visit.window.earliest_s for visit in visits])
        apart += time_s[np.ix_(places, places)]
        apart += TIME_SHARE * np.abs(begins_s[:, None] - begins_s[None, :])
    np.fill_diagonal(apart, -1.0)
    return np.ascontiguousarray(np.argsort(apart, axis=1, kind="stable")[:, 1:].astype(np.int64))
