"""Times of a plan: the earliest over all robots at once, and how late each task may begin."""

from math import inf
from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.alns.driving import latest_leave, trip
from mend.fleet.scheduling.alns.plan import BANKED, STALE, Plan
from mend.fleet.scheduling.alns.problem_arrays import (
    DROP,
    GIVE,
    PICK,
    TAKE,
    Flags,
    Floats,
    Integers,
    ProblemArrays,
)
from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.tolerance import LOAD, SEARCH_S

UNSET = -1e18


class Sweep(NamedTuple):
    """Room to propagate times in, and the newest version of a row."""

    release_s: Floats
    """By node: before what it does not begin, for its window or for spans."""
    met_s: Floats
    """By node: when something is given, or when a robot is there and waits for its partner."""
    order: Integers
    """Nodes in an order in which nothing is taken before it was given."""
    reached: Integers
    """By row: how many of its nodes have times."""
    changed: Flags
    """By row: whether it has other times than before."""
    newest: Integers


def sweep_for(problem: ProblemArrays) -> Sweep:
    """Room for the times of any plan of the problem."""
    nodes, rows = problem.place.size, problem.capacity.size + 1
    return Sweep(
        release_s=problem.earliest_s.copy(),
        met_s=np.zeros(nodes),
        order=np.zeros(nodes, np.int64),
        reached=np.zeros(rows, np.int64),
        changed=np.zeros(rows, np.bool_),
        newest=np.zeros(1, np.int64),
    )


@compiled
def update(problem: ProblemArrays, plan: Plan, sweep: Sweep) -> bool:
    """Times, loads and costs of all rows that are stale; False where that cannot be carried out."""
    if plan.handed[0] > 0 or problem.spans > 0:
        return _update_all(problem, plan, sweep)
    fits = True
    for row in range(plan.length.size - 1):
        if plan.version[row] == STALE:
            fits = update_row(problem, plan, sweep, row) and fits
            for at in range(plan.length[row]):
                plan.at[plan.node[row, at]] = at
    return fits


@compiled
def update_row(problem: ProblemArrays, plan: Plan, sweep: Sweep, row: int) -> bool:
    """The same of one row in which nothing changes robots and no span binds."""
    sweep.reached[row] = 0
    fits = _drive_on(problem, plan, sweep, row)
    for at in range(sweep.reached[row] - 1, -1, -1):
        _pull(problem, plan, row, at)
    sweep.newest[0] += 1
    plan.version[row] = sweep.newest[0]
    return fits


@compiled
def _update_all(problem: ProblemArrays, plan: Plan, sweep: Sweep) -> bool:
    """Every sweep keeps what goes forward in time. A longest time on board or away may then call
    for a later pickup or start, and another sweep; more sweeps than such spans contradict."""
    rows = plan.length.size - 1
    for row in range(rows):
        sweep.changed[row] = plan.version[row] == STALE
        if problem.spans > 0:
            for at in range(plan.length[row]):
                node = plan.node[row, at]
                sweep.release_s[node] = problem.earliest_s[node]
    count, sweeps = _sweep(problem, plan, sweep), 0
    while count > 0 and problem.spans > 0 and _keep_spans(problem, plan, sweep):
        sweeps += 1
        count = _sweep(problem, plan, sweep) if sweeps <= problem.spans else 0
    for number in range(count - 1, -1, -1):
        node = sweep.order[number]
        row = plan.row[node]
        before_s = plan.latest_s[row, plan.at[node]]
        _pull(problem, plan, row, plan.at[node])
        if plan.latest_s[row, plan.at[node]] != before_s:
            sweep.changed[row] = True
    for row in range(rows):
        if sweep.changed[row] or 0 < sweep.reached[row] < plan.length[row]:
            sweep.newest[0] += 1
            plan.version[row] = sweep.newest[0]
    return count > 0


@compiled
def _sweep(problem: ProblemArrays, plan: Plan, sweep: Sweep) -> int:
    """Drive all routes; how many nodes they have, or 0 where that cannot be carried out."""
    rows, count, left = plan.length.size - 1, 0, 0
    for row in range(rows):
        sweep.reached[row] = 0
        left += plan.length[row]
        for at in range(plan.length[row]):
            sweep.met_s[plan.node[row, at]] = UNSET
    while count < left:
        before = count
        for row in range(rows):
            first = sweep.reached[row]
            if first == plan.length[row]:
                continue
            if not _drive_on(problem, plan, sweep, row):
                return 0
            for at in range(first, sweep.reached[row]):
                node = plan.node[row, at]
                sweep.order[count] = node
                plan.at[node], plan.row[node] = at, row
                count += 1
        if count == before:
            return 0
    return count


@compiled
def _drive_on(problem: ProblemArrays, plan: Plan, sweep: Sweep, row: int) -> bool:
    """Go on in a route until its end, or until the robot has to wait for another; False where that
    is too late or too heavy."""
    robot = plan.owner[row]
    for at in range(sweep.reached[row], plan.length[row]):
        node = plan.node[row, at]
        begin_s, load, metres = sweep.release_s[node], problem.load[node], 0.0
        if at > 0:
            before = plan.node[row, at - 1]
            free_s = plan.begin_s[row, at - 1] + problem.service_s[before]
            there_s, metres = trip(problem, robot, plan.place[before], plan.place[node], free_s)
            begin_s = max(begin_s, there_s)
            load += plan.load[row, at - 1]
        kind = problem.kind[node]
        if kind in (GIVE, TAKE):
            begin_s = _wait_for_partner(problem, sweep, node, begin_s)
            if begin_s == UNSET:
                return True
        if begin_s != plan.begin_s[row, at]:
            sweep.changed[row] = True
        plan.begin_s[row, at], plan.load[row, at] = begin_s, load
        spent = 0.0 if at == 0 else plan.cost[row]
        if at == 1 and plan.length[row] > 2:
            spent += problem.weight_robots
        plan.cost[row] = spent + problem.weight_distance * metres
        if kind in (PICK, DROP):
            plan.cost[row] += _timely_cost(problem, node, begin_s)
        sweep.reached[row] = at + 1
        if begin_s > problem.latest_s[node] + SEARCH_S or load > problem.capacity[robot] + LOAD:
            return False
    return True


@compiled
def _wait_for_partner(problem: ProblemArrays, sweep: Sweep, node: int, ready_s: float) -> float:
    """When a robot that is ready can give or take; `UNSET` while its partner is not that far."""
    other = node ^ 1
    if problem.together:
        sweep.met_s[node] = ready_s
        return UNSET if sweep.met_s[other] == UNSET else max(ready_s, sweep.met_s[other])
    if problem.kind[node] == GIVE:
        sweep.met_s[node] = ready_s
        return ready_s
    if sweep.met_s[other] == UNSET:
        return UNSET
    return max(ready_s, sweep.met_s[other] + problem.transfer_s)  # type: ignore[no-any-return]


@compiled
def _timely_cost(problem: ProblemArrays, node: int, begin_s: float) -> float:
    """What it costs that a pickup or delivery begins then."""
    price = problem.weight_lateness * max(0.0, begin_s - problem.due_s[node])
    if problem.kind[node] == DROP:
        price += problem.weight_completion * (begin_s + problem.service_s[node])
    return price  # type: ignore[no-any-return]


@compiled
def _pull(problem: ProblemArrays, plan: Plan, row: int, at: int) -> None:
    """By when a node must begin so that all after it can keep its time, which is known.

    Never too early: spans and, where robots meet, a partner are left out.
    """
    node = plan.node[row, at]
    latest_s = problem.latest_s[node]
    if at + 1 < plan.length[row]:
        place, following = plan.place[node], plan.place[plan.node[row, at + 1]]
        leave_s = latest_leave(
            problem, plan.owner[row], place, following, plan.latest_s[row, at + 1]
        )
        latest_s = min(latest_s, leave_s - problem.service_s[node])
    if problem.kind[node] == GIVE and not problem.together:
        taken_s = plan.latest_s[plan.row[node + 1], plan.at[node + 1]]
        latest_s = min(latest_s, taken_s - problem.transfer_s)
    plan.latest_s[row, at] = latest_s


@compiled
def _keep_spans(problem: ProblemArrays, plan: Plan, sweep: Sweep) -> bool:
    """Release later what would lie too long before something else; whether anything was."""
    moved, items = False, problem.size.size
    for item in range(items):
        if plan.transfers[item] == BANKED or problem.max_on_board_s[item] == inf:
            continue
        drop = items + item
        span_s = problem.max_on_board_s[item] + problem.service_s[item]
        needed_s = plan.begin_s[plan.row[drop], plan.at[drop]] - span_s
        if plan.begin_s[plan.row[item], plan.at[item]] < needed_s - SEARCH_S:
            sweep.release_s[item] = needed_s
            moved = True
    for row in range(plan.length.size - 1):
        needed_s = plan.begin_s[row, plan.length[row] - 1] - problem.max_duration_s[row]
        if plan.begin_s[row, 0] < needed_s - SEARCH_S:
            sweep.release_s[plan.node[row, 0]] = needed_s
            moved = True
    return moved
