"""Times of a plan: the earliest over all robots at once, and how late each task may begin."""

from math import inf
from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.vlns.arrays import (
    BANKED,
    DISTANCE,
    DROP,
    GIVE,
    NOWHERE,
    PICK,
    TAKE,
    TOTAL,
    Floats,
    Integers,
    Plan,
    ProblemArrays,
)

TOLERANCE = 1e-9
UNSET = -1e18


class Times(NamedTuple):
    """Times (seconds) by node and robot, and the loads by robot and position.

    `release_s`: before what no node begins for its window or for spans; `met_s`: when a robot is
    there and waits for its partner; `load` at a position: what is on board before it.
    """

    begin_s: Floats
    latest_s: Floats
    release_s: Floats
    met_s: Floats
    leaves_s: Floats
    ends_s: Floats
    load: Floats
    order: Integers
    slot: Integers
    at: Integers
    free_s: Floats


def times_for(problem: ProblemArrays) -> Times:
    """Room for the times of a plan."""
    nodes, robots = problem.place.size, problem.start.size
    return Times(
        begin_s=np.zeros(nodes),
        latest_s=np.zeros(nodes),
        release_s=np.zeros(nodes),
        met_s=np.zeros(nodes),
        leaves_s=np.zeros(robots),
        ends_s=np.zeros(robots),
        load=np.zeros((robots, nodes + 1)),
        order=np.zeros(nodes, np.int64),
        slot=np.zeros(nodes, np.int64),
        at=np.zeros(robots, np.int64),
        free_s=np.zeros(robots),
    )


@compiled
def drive_s(problem: ProblemArrays, robot: int, origin: int, destination: int) -> float:
    """Seconds from place to place; none to an end that may be anywhere."""
    if destination == NOWHERE:
        return 0.0
    return problem.time_s[origin, destination] / problem.speed[robot]  # type: ignore[no-any-return]


@compiled
def way_m(problem: ProblemArrays, origin: int, destination: int) -> float:
    """Metres from place to place; none to an end that may be anywhere."""
    if destination == NOWHERE:
        return 0.0
    return problem.distance_m[origin, destination]  # type: ignore[no-any-return]


@compiled
def find_times(problem: ProblemArrays, plan: Plan, times: Times) -> bool:
    """The earliest times and the loads; False where the plan cannot be carried out.

    Every sweep keeps what goes forward in time. A longest time on board or away may then call for
    a later pickup or start, and another sweep; more sweeps than such spans mean a contradiction.
    """
    for k in range(plan.length.size):
        times.leaves_s[k] = problem.shift_begin_s[k]
        for at in range(plan.length[k]):
            node = plan.route[k, at]
            times.release_s[node] = problem.earliest_s[node]
    for _ in range(problem.spans + 1):
        if not _sweep(problem, plan, times):
            return False
        if problem.spans == 0 or not _keep_spans(problem, plan, times):
            return True
    return False


@compiled
def _sweep(problem: ProblemArrays, plan: Plan, times: Times) -> bool:
    """Drive all routes in an order in which nothing is taken before it was given."""
    robots = plan.length.size
    left = 0
    for k in range(robots):
        times.at[k] = 0
        times.free_s[k] = times.leaves_s[k]
        times.load[k, 0] = problem.loaded[k]
        if times.load[k, 0] > problem.capacity[k] + TOLERANCE:
            return False
        left += plan.length[k]
        for at in range(plan.length[k]):
            node = plan.route[k, at]
            times.begin_s[node] = UNSET
            times.met_s[node] = UNSET
    total = left
    while left > 0:
        before = left
        for k in range(robots):
            while times.at[k] < plan.length[k]:
                if not _go_on(problem, plan, times, k):
                    break
                node = plan.route[k, times.at[k]]
                if times.begin_s[node] > problem.latest_s[node] + TOLERANCE:
                    return False
                if times.load[k, times.at[k] + 1] > problem.capacity[k] + TOLERANCE:
                    return False
                times.order[total - left] = node
                times.slot[node] = times.at[k]
                times.at[k] += 1
                left -= 1
        if left == before:
            return False
    for k in range(robots):
        place = problem.start[k]
        if plan.length[k] > 0:
            place = plan.place[plan.route[k, plan.length[k] - 1]]
        times.ends_s[k] = times.free_s[k] + drive_s(problem, k, place, problem.end[k])
        if times.ends_s[k] > problem.shift_end_s[k] + TOLERANCE:
            return False
    return True


@compiled
def _go_on(problem: ProblemArrays, plan: Plan, times: Times, robot: int) -> bool:
    """The robot's next node: when it begins. False while the robot has to wait for another."""
    at = times.at[robot]
    node = plan.route[robot, at]
    origin = problem.start[robot] if at == 0 else plan.place[plan.route[robot, at - 1]]
    begin = times.free_s[robot] + drive_s(problem, robot, origin, plan.place[node])
    begin = max(begin, times.release_s[node])
    kind = problem.kind[node]
    if kind == TAKE and not problem.together:
        given = times.begin_s[node - 1]
        if given == UNSET:
            return False
        begin = max(begin, given + problem.transfer_s)
    elif kind >= GIVE and problem.together:
        mate = node ^ 1
        times.met_s[node] = begin
        if times.met_s[mate] == UNSET:
            return False
        begin = max(begin, times.met_s[mate])
    times.begin_s[node] = begin
    times.free_s[robot] = begin + problem.service_s[node]
    load = problem.load[problem.item[node]]
    if kind in (DROP, GIVE):
        load = -load
    times.load[robot, at + 1] = times.load[robot, at] + load
    return True


@compiled
def _keep_spans(problem: ProblemArrays, plan: Plan, times: Times) -> bool:
    """Release later what would lie too long before something else; whether anything was."""
    moved = False
    items = problem.load.size
    for item in range(items):
        if plan.transfers[item] == BANKED or problem.max_on_board_s[item] == inf:
            continue
        span = problem.max_on_board_s[item] + problem.service_s[item]
        needed = times.begin_s[items + item] - span
        if times.begin_s[item] < needed - TOLERANCE:
            times.release_s[item] = needed
            moved = True
    for k in range(plan.length.size):
        needed = times.ends_s[k] - problem.max_duration_s[k]
        if times.leaves_s[k] < needed - TOLERANCE:
            times.leaves_s[k] = needed
            moved = True
    return moved


@compiled
def find_latest(problem: ProblemArrays, plan: Plan, times: Times) -> None:
    """By when every node must begin so that all after it can keep its time.

    Never too early: spans and, where robots meet, a partner not yet looked at are left out. It
    needs the order that `find_times` found.
    """
    nodes = 0
    for k in range(plan.length.size):
        nodes += plan.length[k]
    for number in range(nodes - 1, -1, -1):
        node = times.order[number]
        k, at = plan.robot[node], times.slot[node]
        place = plan.place[node]
        if at + 1 < plan.length[k]:
            later = plan.route[k, at + 1]
            leave = times.latest_s[later] - drive_s(problem, k, place, plan.place[later])
        else:
            leave = problem.shift_end_s[k] - drive_s(problem, k, place, problem.end[k])
        latest = min(problem.latest_s[node], leave - problem.service_s[node])
        if problem.kind[node] == GIVE and not problem.together:
            latest = min(latest, times.latest_s[node + 1] - problem.transfer_s)
        times.latest_s[node] = latest


@compiled
def find_value(problem: ProblemArrays, plan: Plan, times: Times) -> None:
    """The plan's cost from its times; what is in the bank is not counted."""
    distance = makespan = completion = lateness = 0.0
    used = 0
    for k in range(plan.length.size):
        place = problem.start[k]
        for at in range(plan.length[k]):
            node = plan.route[k, at]
            distance += problem.distance_m[place, plan.place[node]]
            place = plan.place[node]
            kind = problem.kind[node]
            if kind == DROP:
                completion += times.begin_s[node] + problem.service_s[node]
            if kind in (DROP, PICK):
                lateness += max(0.0, times.begin_s[node] - problem.due_s[node])
        distance += way_m(problem, place, problem.end[k])
        if plan.length[k] > 0:
            used += 1
            makespan = max(makespan, times.ends_s[k])
    plan.value[DISTANCE] = distance
    plan.value[TOTAL] = (
        problem.weight_distance * distance
        + problem.weight_makespan * makespan
        + problem.weight_completion * completion
        + problem.weight_lateness * lateness
        + problem.weight_robots * used
    )
