"""Routes with their times, loads and costs; putting tasks in, taking items out, copying.

Every route is a row from its robot's start to its end. There is one row more than there are robots,
to try things out. Rows with the same version are the same, times included, in whichever plan.
"""

from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.alns.problem_arrays import NOBODY, ProblemArrays
from mend.fleet.scheduling.alns.records import Integers, Records, records
from mend.fleet.scheduling.compiled import compiled, inlined

BANKED = -1
STALE = 0
"""The version of a row whose times are not known."""


class Plan(NamedTuple):
    """Routes, possibly without some items.

    `stops` by row and position: the node, the earliest begin (`begin_s`), the latest at which all
    that comes after it is in time (`latest_s`), and the load afterwards. `rows`: how long a row is,
    whose, what it costs (apart from the makespan), its version. `tasks` by node: its place, and in
    which row it is at which position, if it is in any. `transfers` by item: how often it changes
    robots, or `BANKED`; `handed`: how many transfers there are in all.
    """

    stops: Records
    rows: Records
    tasks: Records
    transfers: Integers
    handed: Integers


def empty_plan(problem: ProblemArrays) -> Plan:
    """A plan in which every item is in the bank; its times are not known."""
    robots, nodes = problem.robots.size, problem.nodes.size
    plan = Plan(
        stops=records((robots + 1, nodes - 2 * robots + 2), "node", "begin_s latest_s load"),
        rows=records(robots + 1, "length owner version", "cost"),
        tasks=records(nodes, "place row at"),
        transfers=np.full(problem.items.size, BANKED, np.int64),
        handed=np.zeros(1, np.int64),
    )
    plan.rows.length, plan.rows.version = 2, STALE
    plan.rows.owner = np.arange(robots + 1) % robots
    plan.tasks.place, plan.tasks.row = problem.nodes.place, NOBODY
    plan.stops.node[:, 0] = nodes - 2 * robots + plan.rows.owner
    plan.stops.node[:, 1] = nodes - robots + plan.rows.owner
    return plan


@inlined
def put(plan: Plan, row: int, at: int, node: int, place: int) -> None:
    """Insert a node into a row after position `at`."""
    for later in range(plan.rows[row].length - 1, at, -1):
        plan.stops[row, later + 1].node = plan.stops[row, later].node
    plan.stops[row, at + 1].node = node
    plan.rows[row].length += 1
    plan.tasks[node].place = place
    plan.tasks[node].row = row
    plan.rows[row].version = STALE


@compiled
def take_out(problem: ProblemArrays, plan: Plan, item: int) -> None:
    """Remove an item's nodes from all rows and put it into the bank."""
    whole = plan.transfers[item] == 0
    for row in range(plan.rows.size - 1):
        if whole and row != plan.tasks[problem.items.size + item].row:
            continue
        kept = 0
        for at in range(plan.rows[row].length):
            node = plan.stops[row, at].node
            if problem.nodes[node].item_of != item:
                plan.stops[row, kept].node = node
                kept += 1
        if kept < plan.rows[row].length:
            plan.rows[row].length = kept
            plan.rows[row].version = STALE
    plan.handed[0] -= plan.transfers[item]
    plan.transfers[item] = BANKED


@compiled
def copy_plan(origin: Plan, copy: Plan) -> None:
    """Make `copy` the same plan as `origin`, whose times are known."""
    for row in range(origin.rows.size - 1):
        if copy.rows[row].version == origin.rows[row].version:
            continue
        copy.rows[row].version = origin.rows[row].version
        copy.rows[row].length = origin.rows[row].length
        copy.rows[row].cost = origin.rows[row].cost
        for at in range(origin.rows[row].length):
            node = origin.stops[row, at].node
            copy.stops[row, at].node = node
            copy.stops[row, at].begin_s = origin.stops[row, at].begin_s
            copy.stops[row, at].latest_s = origin.stops[row, at].latest_s
            copy.stops[row, at].load = origin.stops[row, at].load
            copy.tasks[node].place, copy.tasks[node].at = origin.tasks[node].place, at
            copy.tasks[node].row = row
    for item in range(origin.transfers.size):
        copy.transfers[item] = origin.transfers[item]
    copy.handed[0] = origin.handed[0]


@compiled
def routes_cost(problem: ProblemArrays, plan: Plan) -> float:
    """What the routes of the plan cost."""
    value, last_s = 0.0, 0.0
    for row in range(plan.rows.size - 1):
        value += plan.rows[row].cost
        if plan.rows[row].length > 2:
            last_s = max(last_s, plan.stops[row, plan.rows[row].length - 1].begin_s)
    return value + problem.weight_makespan * last_s


@compiled
def plan_value(problem: ProblemArrays, plan: Plan) -> float:
    """What the plan costs, with what the items cost that are in the bank."""
    value = routes_cost(problem, plan)
    for item in range(plan.transfers.size):
        if plan.transfers[item] == BANKED:
            value += problem.penalty
    return value


@compiled
def copy_route(plan: Plan, row: int, other: int) -> None:
    """Make another row the route of this one, for the same robot; its times are not known."""
    plan.rows[other].owner = plan.rows[row].owner
    plan.rows[other].length = plan.rows[row].length
    for at in range(plan.rows[row].length):
        plan.stops[other, at].node = plan.stops[row, at].node
