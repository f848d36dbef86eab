"""Routes with their times, loads and costs; putting tasks in, taking items out, copying.

Every route is a row from its robot's start to its end. There is one row more than there are robots,
to try things out. Rows with the same version are the same, times included, in whichever plan.
"""

from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.alns.problem_arrays import NOBODY, Floats, Integers, ProblemArrays
from mend.fleet.scheduling.compiled import compiled

BANKED = -1
STALE = 0
"""The version of a row whose times are not known."""


class Plan(NamedTuple):
    """Routes, possibly without some items; those are in the bank. Arrays by row and position, by
    row, by node, or by item."""

    node: Integers
    begin_s: Floats
    """The earliest begin."""
    latest_s: Floats
    """The latest begin at which all that comes after it is in time."""
    load: Floats
    """On board afterwards."""
    length: Integers
    owner: Integers
    """The robot of a row."""
    cost: Floats
    """What a row costs, apart from the makespan."""
    version: Integers
    place: Integers
    row: Integers
    at: Integers
    """In which row a node is and at which position, if it is in any."""
    transfers: Integers
    """How often an item changes robots, or `BANKED`."""
    handed: Integers
    """How many transfers there are in all."""


def empty_plan(problem: ProblemArrays) -> Plan:
    """A plan in which every item is in the bank; its times are not known."""
    robots, items, nodes = problem.capacity.size, problem.size.size, problem.place.size
    shape = (robots + 1, nodes - 2 * robots + 2)
    plan = Plan(
        node=np.zeros(shape, np.int64),
        begin_s=np.zeros(shape),
        latest_s=np.zeros(shape),
        load=np.zeros(shape),
        length=np.full(robots + 1, 2, np.int64),
        owner=np.arange(robots + 1) % robots,
        cost=np.zeros(robots + 1),
        version=np.full(robots + 1, STALE, np.int64),
        place=problem.place.copy(),
        row=np.full(nodes, NOBODY, np.int64),
        at=np.zeros(nodes, np.int64),
        transfers=np.full(items, BANKED, np.int64),
        handed=np.zeros(1, np.int64),
    )
    for row, robot in enumerate(plan.owner):
        plan.node[row, :2] = nodes - 2 * robots + robot, nodes - robots + robot
    return plan


@compiled
def put(plan: Plan, row: int, at: int, node: int, place: int) -> None:
    """Insert a node into a row after position `at`."""
    for later in range(plan.length[row] - 1, at, -1):
        plan.node[row, later + 1] = plan.node[row, later]
    plan.node[row, at + 1] = node
    plan.length[row] += 1
    plan.place[node] = place
    plan.row[node] = row
    plan.version[row] = STALE


@compiled
def take_out(problem: ProblemArrays, plan: Plan, item: int) -> None:
    """Remove an item's nodes from all rows and put it into the bank."""
    whole = plan.transfers[item] == 0
    for row in range(plan.length.size - 1):
        if whole and row != plan.row[problem.size.size + item]:
            continue
        kept = 0
        for at in range(plan.length[row]):
            node = plan.node[row, at]
            if problem.item[node] != item:
                plan.node[row, kept] = node
                kept += 1
        if kept < plan.length[row]:
            plan.length[row] = kept
            plan.version[row] = STALE
    plan.handed[0] -= plan.transfers[item]
    plan.transfers[item] = BANKED


@compiled
def copy_plan(origin: Plan, copy: Plan) -> None:
    """Make `copy` the same plan as `origin`, whose times are known."""
    for row in range(origin.length.size - 1):
        if copy.version[row] == origin.version[row]:
            continue
        copy.version[row], copy.length[row] = origin.version[row], origin.length[row]
        copy.cost[row] = origin.cost[row]
        for at in range(origin.length[row]):
            node = origin.node[row, at]
            copy.node[row, at] = node
            copy.begin_s[row, at] = origin.begin_s[row, at]
            copy.latest_s[row, at] = origin.latest_s[row, at]
            copy.load[row, at] = origin.load[row, at]
            copy.place[node], copy.at[node] = origin.place[node], at
            copy.row[node] = row
    for item in range(origin.transfers.size):
        copy.transfers[item] = origin.transfers[item]
    copy.handed[0] = origin.handed[0]


@compiled
def plan_value(problem: ProblemArrays, plan: Plan) -> float:
    """What the plan costs, with what the items cost that are in the bank."""
    value, last_s = 0.0, 0.0
    for row in range(plan.length.size - 1):
        value += plan.cost[row]
        if plan.length[row] > 2:
            last_s = max(last_s, plan.begin_s[row, plan.length[row] - 1])
    for item in range(plan.transfers.size):
        if plan.transfers[item] == BANKED:
            value += problem.penalty
    return value + problem.weight_makespan * last_s


@compiled
def copy_route(plan: Plan, row: int, other: int) -> None:
    """Make another row the route of this one, for the same robot; its times are not known."""
    plan.owner[other] = plan.owner[row]
    plan.length[other] = plan.length[row]
    for at in range(plan.length[row]):
        plan.node[other, at] = plan.node[row, at]
