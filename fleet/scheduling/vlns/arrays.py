"""The problem and a plan as arrays, as the kernels read them.

A task is a node: `item` its pickup, `items + item` its delivery, and from `2 * items` on, for each
item and number of transfer, what is given (even) and right after it what is taken (odd).
"""

from dataclasses import replace
from math import inf, isfinite
from typing import NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.problem import Problem

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Flags = NDArray[np.bool_]

PICK, DROP, GIVE, TAKE = 0, 1, 2, 3
NOWHERE = cast(int, np.int64(-1))
HOME = cast(int, np.int64(0))
"""The first of an item's ends: its pickup or delivery. These two are no plain numbers, as a kernel
would be compiled once more for every plain number that it is called with."""
BANKED = -1
UNREACHABLE = 1e12
"""Metres and seconds of a way that does not exist; finite, so that differences stay numbers."""

TOTAL, DISTANCE = 0, 1
"""Where a plan's `value` has its cost and its distance."""


class ProblemArrays(NamedTuple):
    """A problem. Arrays by place, robot (k), item (n) or node (v)."""

    distance_m: Floats
    time_s: Floats
    start: Integers
    end: Integers
    capacity: Floats
    speed: Floats
    shift_begin_s: Floats
    shift_end_s: Floats
    max_duration_s: Floats
    loaded: Floats
    """By robot: the load of what it carries from the beginning."""
    place: Integers
    kind: Integers
    item: Integers
    earliest_s: Floats
    latest_s: Floats
    due_s: Floats
    service_s: Floats
    load: Floats
    max_on_board_s: Floats
    aboard: Integers
    transfer_place: Integers
    exchange: Flags
    """By place: whether it is a transfer place."""
    fastest: float
    """The speed of the fastest robot."""
    transfer_s: float
    together: bool
    chain: int
    """The most transfers of one item."""
    spans: int
    """How many constraints bind something to be not much earlier than something later."""
    timeless: bool
    """Whether times decide only what is feasible, not what it costs."""
    weight_distance: float
    weight_makespan: float
    weight_completion: float
    weight_lateness: float
    weight_robots: float
    metre: float
    """What one more metre probably costs, the time that it takes included."""
    second: float
    """What it probably costs to deliver one item a second later."""
    twin: Integers
    """By robot: the one before it that can do exactly the same, or `NOWHERE`."""
    penalty: float
    """What an item costs that is not delivered."""


class Plan(NamedTuple):
    """Routes, possibly without some items; those are in the bank.

    `transfers` by item: how often it changes robots, or `BANKED`.
    """

    route: Integers
    length: Integers
    place: Integers
    robot: Integers
    transfers: Integers
    value: Floats


def problem_arrays(problem: Problem, chain: int) -> ProblemArrays:
    """The problem, with at most `chain` transfers of one item."""
    items, robots = problem.items, problem.robots
    weights, transfers = problem.weights, problem.transfers
    count = len(items)
    nodes = 2 * count * (1 + chain)
    visits = [item.pickup for item in items] + [item.delivery for item in items]
    place = np.zeros(nodes, np.int64)
    kind = np.empty(nodes, np.int64)
    earliest, latest, due = np.full(nodes, -inf), np.full(nodes, inf), np.full(nodes, inf)
    service = np.full(nodes, transfers.service_s)
    place[: 2 * count] = [visit.place for visit in visits]
    kind[:count], kind[count : 2 * count] = PICK, DROP
    kind[2 * count :: 2], kind[2 * count + 1 :: 2] = GIVE, TAKE
    earliest[: 2 * count] = [visit.window.earliest_s for visit in visits]
    latest[: 2 * count] = [visit.window.latest_s for visit in visits]
    due[: 2 * count] = [visit.due_s for visit in visits]
    service[: 2 * count] = [visit.service_s for visit in visits]
    numbers = np.arange(count)
    aboard = np.array([NOWHERE if i.aboard is None else i.aboard for i in items], np.int64)
    on_board = np.array([item.max_on_board_s for item in items], np.float64)
    # What is on board from the beginning was loaded at the origin of time.
    for number in numbers[aboard != NOWHERE]:
        latest[count + number] = min(latest[count + number], on_board[number])
        on_board[number] = inf
    loaded = np.zeros(len(robots))
    for item in items:
        if item.aboard is not None:
            loaded[item.aboard] += item.load
    duration = np.array([robot.max_duration_s for robot in robots], np.float64)
    distance_m = np.where(np.isfinite(problem.travel.distance_m), problem.travel.distance_m,
                          UNREACHABLE)  # fmt: skip
    time_s = np.where(np.isfinite(problem.travel.time_s), problem.travel.time_s, UNREACHABLE)
    return ProblemArrays(
        distance_m=np.ascontiguousarray(distance_m),
        time_s=np.ascontiguousarray(time_s),
        start=np.array([robot.start for robot in robots], np.int64),
        end=np.array([NOWHERE if r.end is None else r.end for r in robots], np.int64),
        capacity=np.array([robot.capacity for robot in robots], np.float64),
        speed=np.array([robot.speed for robot in robots], np.float64),
        shift_begin_s=np.array([robot.shift.earliest_s for robot in robots], np.float64),
        shift_end_s=np.array([robot.shift.latest_s for robot in robots], np.float64),
        max_duration_s=duration,
        loaded=loaded,
        place=place,
        kind=kind,
        item=np.concatenate((numbers, numbers, np.repeat(numbers, 2 * chain))).astype(np.int64),
        earliest_s=earliest,
        latest_s=latest,
        due_s=due,
        service_s=service,
        load=np.array([item.load for item in items], np.float64),
        max_on_board_s=on_board,
        aboard=aboard,
        transfer_place=np.array(transfers.places, np.int64),
        exchange=np.isin(np.arange(len(problem.places)), transfers.places),
        fastest=max(robot.speed for robot in robots),
        transfer_s=float(transfers.service_s),
        together=transfers.together,
        chain=chain,
        spans=int(np.isfinite(on_board).sum() + np.isfinite(duration).sum()),
        timeless=not (weights.makespan or weights.completion or _lateness_weight(problem)),
        weight_distance=float(weights.distance),
        weight_makespan=float(weights.makespan),
        weight_completion=float(weights.completion),
        weight_lateness=float(weights.lateness),
        weight_robots=float(weights.robots),
        metre=float(weights.distance + weights.makespan) or 1e-3,
        second=float(weights.completion + _lateness_weight(problem)),
        twin=_twins(problem),
        penalty=_penalty(problem),
    )


def _lateness_weight(problem: Problem) -> float:
    """What lateness costs, where anything can be late."""
    visits = (visit for item in problem.items for visit in (item.pickup, item.delivery))
    return problem.weights.lateness if any(isfinite(visit.due_s) for visit in visits) else 0.0


def _twins(problem: Problem) -> Integers:
    seen: dict[object, int] = {}
    twins = np.full(len(problem.robots), NOWHERE, np.int64)
    for number, robot in enumerate(problem.robots):
        same = replace(robot, name="")
        twins[number] = seen.get(same, NOWHERE)
        seen[same] = number
    return twins


def _penalty(problem: Problem) -> float:
    """More than any one item can save when it is left out."""
    weights, travel = problem.weights, problem.travel
    farthest_m = float(np.max(travel.distance_m, where=np.isfinite(travel.distance_m), initial=1.0))
    longest_s = float(np.max(travel.time_s, where=np.isfinite(travel.time_s), initial=1.0))
    slowest = min(robot.speed for robot in problem.robots)
    ends = [v.window.latest_s for item in problem.items for v in (item.pickup, item.delivery)]
    horizon_s = max((end for end in ends if isfinite(end)), default=0.0)
    horizon_s += 4 * len(problem.items) * longest_s / slowest
    timed = weights.makespan + (weights.completion + weights.lateness) * len(problem.items)
    return 1.0 + 10 * (weights.robots + 4 * weights.distance * farthest_m) + timed * horizon_s


def empty_plan(problem: ProblemArrays) -> Plan:
    """A plan in which every item is still in the bank; its value is not computed."""
    nodes, robots = problem.place.size, problem.start.size
    return Plan(
        route=np.zeros((robots, nodes), np.int64),
        length=np.zeros(robots, np.int64),
        place=problem.place.copy(),
        robot=np.full(nodes, NOWHERE, np.int64),
        transfers=np.full(problem.load.size, BANKED, np.int64),
        value=np.zeros(2),
    )


@compiled
def copy_plan(origin: Plan, copy: Plan) -> None:
    """Make `copy` the same plan as `origin`."""
    for k in range(origin.length.size):
        length = origin.length[k]
        copy.length[k] = length
        for at in range(length):
            node = origin.route[k, at]
            copy.route[k, at] = node
            copy.place[node] = origin.place[node]
            copy.robot[node] = k
    for item in range(origin.transfers.size):
        copy.transfers[item] = origin.transfers[item]
    copy.value[TOTAL] = origin.value[TOTAL]
    copy.value[DISTANCE] = origin.value[DISTANCE]


@compiled
def give_node(problem: ProblemArrays, item: int, number: int) -> int:
    """The node of what is given in the item's transfer of that number; what is taken follows it."""
    return 2 * problem.load.size + 2 * (item * problem.chain + number)


@compiled
def put(plan: Plan, robot: int, at: int, node: int, place: int) -> None:
    """Insert a node into a route before position `at`."""
    for later in range(plan.length[robot], at, -1):
        plan.route[robot, later] = plan.route[robot, later - 1]
    plan.route[robot, at] = node
    plan.length[robot] += 1
    plan.place[node] = place
    plan.robot[node] = robot


@compiled
def take_out(problem: ProblemArrays, plan: Plan, item: int) -> None:
    """Remove an item's nodes from all routes and put it into the bank."""
    for k in range(plan.length.size):
        kept = 0
        for at in range(plan.length[k]):
            node = plan.route[k, at]
            if problem.item[node] != item:
                plan.route[k, kept] = node
                kept += 1
        plan.length[k] = kept
    plan.transfers[item] = BANKED
