"""Routes with their times and loads, kept up to date; putting items in, taking them out, undoing.

Every route is a row that begins with its robot's start and ends with its end. There is one row
more than there are robots, to try things out.
"""

from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.routing.arrays import NOBODY, Flags, Floats, Integers, RoutingArrays


class Plan(NamedTuple):
    """Routes, possibly without some items. By row and position, by row, or by item."""

    node: Integers
    begin_s: Floats
    """The earliest begin at a position, given what is before it."""
    latest_s: Floats
    """The latest begin, given what is after it."""
    load: Floats
    """On board after a position."""
    length: Integers
    cost: Floats
    """By row: what its driving costs, with the robot's cost where it does anything."""
    version: Integers
    """By row: another number whenever the row is another one."""
    newest: Integers
    """The last number given to a row."""
    robot: Integers
    """By item: who brings it, or `NOBODY`."""


class Undo(NamedTuple):
    """The rows as they were before they were changed; `known` of them are in `touched`."""

    node: Integers
    length: Integers
    cost: Floats
    version: Integers
    marked: Flags
    touched: Integers
    known: Integers


def empty_plan(arrays: RoutingArrays) -> Plan:
    """A plan in which no robot has anything to do."""
    robots, items = arrays.capacity.size, arrays.near.shape[0]
    shape = (robots + 1, 2 * items + 2)
    plan = Plan(
        node=np.zeros(shape, np.int64),
        begin_s=np.zeros(shape),
        latest_s=np.zeros(shape),
        load=np.zeros(shape),
        length=np.full(robots + 1, 2, np.int64),
        cost=np.zeros(robots + 1),
        version=np.zeros(robots + 1, np.int64),
        newest=np.zeros(1, np.int64),
        robot=np.full(items, NOBODY, np.int64),
    )
    for robot in range(robots):
        plan.node[robot, 0] = 2 * items + robot
        plan.node[robot, 1] = 2 * items + robots + robot
        refresh(arrays, plan, robot, robot)
    return plan


def undo_for(plan: Plan) -> Undo:
    """Room to remember every row."""
    rows = plan.length.size
    return Undo(
        plan.node.copy(), plan.length.copy(), plan.cost.copy(), plan.version.copy(),
        np.zeros(rows, np.bool_), np.zeros(rows, np.int64), np.zeros(1, np.int64),
    )  # fmt: skip


@compiled
def refresh(arrays: RoutingArrays, plan: Plan, row: int, robot: int) -> None:
    """Compute a row's times, loads and cost anew, as if it were the robot's."""
    pace, last = arrays.pace[robot], plan.length[row] - 1
    node = plan.node[row, 0]
    plan.begin_s[row, 0] = arrays.earliest_s[node]
    plan.load[row, 0] = 0.0
    cost = arrays.robot_cost if last > 1 else 0.0
    for at in range(1, last + 1):
        after = plan.node[row, at]
        arrival_s = plan.begin_s[row, at - 1] + arrays.service_s[node]
        arrival_s += arrays.time_s[node, after] * pace
        plan.begin_s[row, at] = max(arrival_s, arrays.earliest_s[after])
        plan.load[row, at] = plan.load[row, at - 1] + arrays.load[after]
        cost += arrays.cost[node, after]
        node = after
    plan.cost[row] = cost
    plan.latest_s[row, last] = arrays.latest_s[node]
    for at in range(last - 1, -1, -1):
        before = plan.node[row, at]
        leave_s = plan.latest_s[row, at + 1] - arrays.time_s[before, node] * pace
        latest_s = min(arrays.latest_s[before], leave_s - arrays.service_s[before])
        plan.latest_s[row, at] = latest_s
        node = before
    plan.newest[0] += 1
    plan.version[row] = plan.newest[0]


@compiled
def put(
    arrays: RoutingArrays, plan: Plan, item: int, row: int, robot: int, pick: int, drop: int
) -> None:
    """Insert an item: its pickup after position `pick`, its delivery after `drop` (as of now)."""
    last = plan.length[row] - 1
    for at in range(last, drop, -1):
        plan.node[row, at + 2] = plan.node[row, at]
    plan.node[row, drop + 2] = plan.robot.size + item
    for at in range(drop, pick, -1):
        plan.node[row, at + 1] = plan.node[row, at]
    plan.node[row, pick + 1] = item
    plan.length[row] += 2
    if row == robot:
        plan.robot[item] = robot
    refresh(arrays, plan, row, robot)


@compiled
def take_out(arrays: RoutingArrays, plan: Plan, item: int) -> None:
    """Remove an item from the route that it is in."""
    robot, items = plan.robot[item], plan.robot.size
    kept = 0
    for at in range(plan.length[robot]):
        node = plan.node[robot, at]
        if node not in (item, items + item):
            plan.node[robot, kept] = node
            kept += 1
    plan.length[robot] = kept
    plan.robot[item] = NOBODY
    refresh(arrays, plan, robot, robot)


@compiled
def copy_plan(origin: Plan, copy: Plan) -> None:
    """Make `copy` the same plan as `origin`; what is remembered by its versions stays wrong."""
    for row in range(origin.length.size):
        copy_row(origin, row, copy, row)
        copy.cost[row] = origin.cost[row]
        copy.newest[0] += 1
        copy.version[row] = copy.newest[0]
    for item in range(origin.robot.size):
        copy.robot[item] = origin.robot[item]


@compiled
def copy_row(origin: Plan, row: int, copy: Plan, other: int) -> None:
    """Copy one row with its times and loads, but without its cost and version."""
    copy.length[other] = origin.length[row]
    for at in range(origin.length[row]):
        copy.node[other, at] = origin.node[row, at]
        copy.begin_s[other, at] = origin.begin_s[row, at]
        copy.latest_s[other, at] = origin.latest_s[row, at]
        copy.load[other, at] = origin.load[row, at]


@compiled
def remember(plan: Plan, undo: Undo, row: int) -> None:
    """Keep a row as it is, unless it is kept already."""
    if undo.marked[row]:
        return
    undo.marked[row] = True
    undo.touched[undo.known[0]] = row
    undo.known[0] += 1
    undo.length[row], undo.cost[row] = plan.length[row], plan.cost[row]
    undo.version[row] = plan.version[row]
    for at in range(plan.length[row]):
        undo.node[row, at] = plan.node[row, at]


@compiled
def settle(undo: Undo) -> None:
    """Forget what was kept: the changes stay."""
    for number in range(undo.known[0]):
        undo.marked[undo.touched[number]] = False
    undo.known[0] = 0


@compiled
def restore(arrays: RoutingArrays, plan: Plan, undo: Undo) -> None:
    """Bring back every row that was kept."""
    items = plan.robot.size
    for number in range(undo.known[0]):
        row = undo.touched[number]
        plan.length[row] = undo.length[row]
        for at in range(undo.length[row]):
            node = undo.node[row, at]
            plan.node[row, at] = node
            if node < items:
                plan.robot[node] = row
        refresh(arrays, plan, row, row)
        plan.version[row] = undo.version[row]
    settle(undo)


@compiled
def changed_by(plan: Plan, undo: Undo) -> float:
    """How much more the changed rows cost than before."""
    change = 0.0
    for number in range(undo.known[0]):
        row = undo.touched[number]
        change += plan.cost[row] - undo.cost[row]
    return change


@compiled
def plan_cost(plan: Plan) -> float:
    """What all routes cost."""
    cost = 0.0
    for robot in range(plan.length.size - 1):
        cost += plan.cost[robot]
    return cost
