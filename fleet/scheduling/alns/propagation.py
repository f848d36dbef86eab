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
    ProblemArrays,
)
from mend.fleet.scheduling.alns.records import Flags, Floats, Integers
from mend.fleet.scheduling.compiled import compiled, inlined
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
    nodes, rows = problem.nodes.size, problem.robots.size + 1
    return Sweep(
        release_s=problem.nodes.earliest_s.copy(),
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
    for row in range(plan.rows.size - 1):
        if plan.rows[row].version == STALE:
            fits = update_row(problem, plan, sweep, row) and fits
            for at in range(plan.rows[row].length):
                plan.tasks[plan.stops[row, at].node].at = at
    return fits


@compiled
def update_row(problem: ProblemArrays, plan: Plan, sweep: Sweep, row: int) -> bool:
    """The same of one row in which nothing changes robots and no span binds."""
    sweep.reached[row] = 0
    fits = _drive_on(problem, plan, sweep, row)
    for at in range(sweep.reached[row] - 1, -1, -1):
        _pull(problem, plan, row, at)
    sweep.newest[0] += 1
    plan.rows[row].version = sweep.newest[0]
    return fits


@compiled
def _update_all(problem: ProblemArrays, plan: Plan, sweep: Sweep) -> bool:
    """Every sweep keeps what goes forward in time. A longest time on board or away may then call
    for a later pickup or start, and another sweep; more sweeps than such spans contradict."""
    rows = plan.rows.size - 1
    for row in range(rows):
        sweep.changed[row] = plan.rows[row].version == STALE
        if problem.spans > 0:
            for at in range(plan.rows[row].length):
                node = plan.stops[row, at].node
                sweep.release_s[node] = problem.nodes[node].earliest_s
    count, sweeps = _sweep(problem, plan, sweep), 0
    while count > 0 and problem.spans > 0 and _keep_spans(problem, plan, sweep):
        sweeps += 1
        count = _sweep(problem, plan, sweep) if sweeps <= problem.spans else 0
    for number in range(count - 1, -1, -1):
        node = sweep.order[number]
        row = plan.tasks[node].row
        before_s = plan.stops[row, plan.tasks[node].at].latest_s
        _pull(problem, plan, row, plan.tasks[node].at)
        if plan.stops[row, plan.tasks[node].at].latest_s != before_s:
            sweep.changed[row] = True
    for row in range(rows):
        if sweep.changed[row] or 0 < sweep.reached[row] < plan.rows[row].length:
            sweep.newest[0] += 1
            plan.rows[row].version = sweep.newest[0]
    return count > 0


@compiled
def _sweep(problem: ProblemArrays, plan: Plan, sweep: Sweep) -> int:
    """Drive all routes; how many nodes they have, or 0 where that cannot be carried out."""
    rows, count, left = plan.rows.size - 1, 0, 0
    for row in range(rows):
        sweep.reached[row] = 0
        left += plan.rows[row].length
        for at in range(plan.rows[row].length):
            sweep.met_s[plan.stops[row, at].node] = UNSET
    while count < left:
        before = count
        for row in range(rows):
            first = sweep.reached[row]
            if first == plan.rows[row].length:
                continue
            if not _drive_on(problem, plan, sweep, row):
                return 0
            for at in range(first, sweep.reached[row]):
                node = plan.stops[row, at].node
                sweep.order[count] = node
                plan.tasks[node].at, plan.tasks[node].row = at, row
                count += 1
        if count == before:
            return 0
    return count


@compiled
def _drive_on(problem: ProblemArrays, plan: Plan, sweep: Sweep, row: int) -> bool:
    """Go on in a route until its end, or until the robot has to wait for another; False where that
    is too late or too heavy."""
    robot = plan.rows[row].owner
    for at in range(sweep.reached[row], plan.rows[row].length):
        node = plan.stops[row, at].node
        begin_s, load, metres = sweep.release_s[node], problem.nodes[node].load, 0.0
        if at > 0:
            before = plan.stops[row, at - 1].node
            free_s = plan.stops[row, at - 1].begin_s + problem.nodes[before].service_s
            there_s, metres = trip(
                problem, robot, plan.tasks[before].place, plan.tasks[node].place, free_s
            )
            begin_s = max(begin_s, there_s)
            load += plan.stops[row, at - 1].load
        kind = problem.nodes[node].kind
        if kind in (GIVE, TAKE):
            begin_s = _wait_for_partner(problem, sweep, node, begin_s)
            if begin_s == UNSET:
                return True
        if begin_s != plan.stops[row, at].begin_s:
            sweep.changed[row] = True
        plan.stops[row, at].begin_s, plan.stops[row, at].load = begin_s, load
        spent = 0.0 if at == 0 else plan.rows[row].cost
        if at == 1 and plan.rows[row].length > 2:
            spent += problem.weight_robots
        plan.rows[row].cost = spent + problem.weight_distance * metres
        if kind in (PICK, DROP):
            plan.rows[row].cost += _timely_cost(problem, node, begin_s)
        sweep.reached[row] = at + 1
        if (
            begin_s > problem.nodes[node].latest_s + SEARCH_S
            or load > problem.robots[robot].capacity + LOAD
        ):
            # A robot that cannot even get home keeps this row: no plan with it is worth anything.
            plan.rows[row].cost = inf
            return False
    return True


@inlined
def _wait_for_partner(problem: ProblemArrays, sweep: Sweep, node: int, ready_s: float) -> float:
    """When a robot that is ready can give or take; `UNSET` while its partner is not that far."""
    other = node ^ 1
    if problem.together:
        sweep.met_s[node] = ready_s
        return UNSET if sweep.met_s[other] == UNSET else max(ready_s, sweep.met_s[other])
    if problem.nodes[node].kind == GIVE:
        sweep.met_s[node] = ready_s
        return ready_s
    if sweep.met_s[other] == UNSET:
        return UNSET
    return max(ready_s, sweep.met_s[other] + problem.transfer_s)  # type: ignore[no-any-return]


@inlined
def _timely_cost(problem: ProblemArrays, node: int, begin_s: float) -> float:
    """What it costs that a pickup or delivery begins then."""
    price = problem.weight_lateness * max(0.0, begin_s - problem.nodes[node].due_s)
    if problem.nodes[node].kind == DROP:
        price += problem.weight_completion * (begin_s + problem.nodes[node].service_s)
    return price  # type: ignore[no-any-return]


@inlined
def _pull(problem: ProblemArrays, plan: Plan, row: int, at: int) -> None:
    """By when a node must begin so that all after it can keep its time, which is known.

    Never too early: spans and, where robots meet, a partner are left out.
    """
    node = plan.stops[row, at].node
    latest_s = problem.nodes[node].latest_s
    if at + 1 < plan.rows[row].length:
        place, following = plan.tasks[node].place, plan.tasks[plan.stops[row, at + 1].node].place
        leave_s = latest_leave(
            problem, plan.rows[row].owner, place, following, plan.stops[row, at + 1].latest_s
        )
        latest_s = min(latest_s, leave_s - problem.nodes[node].service_s)
    if problem.nodes[node].kind == GIVE and not problem.together:
        taken_s = plan.stops[plan.tasks[node + 1].row, plan.tasks[node + 1].at].latest_s
        latest_s = min(latest_s, taken_s - problem.transfer_s)
    plan.stops[row, at].latest_s = latest_s


@compiled
def _keep_spans(problem: ProblemArrays, plan: Plan, sweep: Sweep) -> bool:
    """Release later what would lie too long before something else; whether anything was."""
    moved, items = False, problem.items.size
    for item in range(items):
        if plan.transfers[item] == BANKED or problem.items[item].max_on_board_s == inf:
            continue
        drop = items + item
        span_s = problem.items[item].max_on_board_s + problem.nodes[item].service_s
        needed_s = plan.stops[plan.tasks[drop].row, plan.tasks[drop].at].begin_s - span_s
        if plan.stops[plan.tasks[item].row, plan.tasks[item].at].begin_s < needed_s - SEARCH_S:
            sweep.release_s[item] = needed_s
            moved = True
    for row in range(plan.rows.size - 1):
        needed_s = (
            plan.stops[row, plan.rows[row].length - 1].begin_s - problem.robots[row].max_duration_s
        )
        if plan.stops[row, 0].begin_s < needed_s - SEARCH_S:
            sweep.release_s[plan.stops[row, 0].node] = needed_s
            moved = True
    return moved
