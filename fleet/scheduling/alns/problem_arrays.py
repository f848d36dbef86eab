"""The problem as arrays, as the kernels read it.

A node is a task or an end of a route: `item` a pickup, `items + item` its delivery, then for each
item and number of transfer what is given and right after it what is taken, then every robot's
start, then every robot's end. The last place is anywhere: nothing is far from it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import inf, isfinite
from typing import NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.problem import Problem, Visit

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Flags = NDArray[np.bool_]

PICK, DROP, GIVE, TAKE, START, END = range(6)
NOBODY = cast(int, np.int64(-1))
"""No plain number, as a kernel would be compiled once more for every one."""
UNREACHABLE = 1e12
"""Metres and seconds of a way that does not exist; finite, so that differences stay numbers."""
LEAST_PRICE = 1e-3
"""What a metre costs at least, so that of ways that cost nothing the shorter one is preferred."""
TIME_SHARE = 0.3
"""How much items are related by when they are due, compared with by where they are."""


class ProblemArrays(NamedTuple):
    """A problem. Arrays by place, robot, item or node."""

    distance_m: Floats
    time_s: Floats
    """By place and place, at speed 1; with doors what is best in any epoch."""
    epoch_from_s: Floats
    epoch_until_s: Floats
    epoch_distance_m: Floats
    epoch_time_s: Floats
    """By epoch; none where no door opens or closes."""
    capacity: Floats
    pace: Floats
    """By robot: what its travel times are multiplied by."""
    max_duration_s: Floats
    held: Integers
    """By robot: before how many of its first tasks nothing may be put."""
    twin: Integers
    """By robot: the one before it that can do exactly the same, or `NOBODY`."""
    place: Integers
    kind: Integers
    item: Integers
    earliest_s: Floats
    latest_s: Floats
    due_s: Floats
    service_s: Floats
    load: Floats
    """By node: what the load of the robot changes by."""
    size: Floats
    """By item: its load."""
    max_on_board_s: Floats
    carrier: Integers
    """By item: the robot that has it already, or is about to pick it up, or `NOBODY`."""
    near: Integers
    """By item: all others, the most related first."""
    transfer_place: Integers
    fastest: float
    """The speed of the fastest robot."""
    transfer_s: float
    together: bool
    chain: int
    """The most transfers of one item."""
    direct: int
    """How many places in a route are remembered for an item that changes no robots."""
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
    penalty: float
    """What an item costs that is not delivered."""


class Kept(NamedTuple):
    """What of a running plan stays as it is: by robot, before how many of its first tasks nothing
    may be put; items whose pickup is the first task of this robot already."""

    held: Sequence[int]
    begun: Mapping[int, int]


def problem_arrays(problem: Problem, chain: int, kept: Kept | None = None) -> ProblemArrays:
    """The problem, with at most `chain` transfers of one item."""
    items, robots, weights = problem.items, problem.robots, problem.weights
    handling, travel = problem.transfers, problem.travel
    held, begun = ([0] * len(robots), {}) if kept is None else kept
    count, exchanges = len(items), 2 * len(items) * chain
    visits = [item.pickup for item in items] + [item.delivery for item in items]
    shifts = [robot.shift for robot in robots]
    numbers = np.arange(count)
    size = np.array([item.load for item in items], np.float64)
    loaded = [sum(item.load for item in items if item.aboard == k) for k in range(len(robots))]
    idle, free = np.zeros(len(robots)), np.full(exchanges, inf)
    latest_s = np.array([visit.window.latest_s for visit in visits])
    on_board_s = np.array([item.max_on_board_s for item in items], np.float64)
    # What is on board from the beginning was loaded at the origin of time.
    aboard = np.array([item.aboard is not None for item in items], np.bool_)
    latest_s[count:][aboard] = np.minimum(latest_s[count:], on_board_s)[aboard]
    on_board_s[aboard] = inf
    duration_s = np.array([robot.max_duration_s for robot in robots], np.float64)
    late = any(isfinite(visit.due_s) for visit in visits) and weights.lateness
    whole = len(robots) * [NOBODY]
    return ProblemArrays(
        distance_m=_with_anywhere(travel.distance_m),
        time_s=_with_anywhere(travel.time_s),
        epoch_from_s=np.array([epoch.from_s for epoch in travel.epochs], np.float64),
        epoch_until_s=np.array([epoch.until_s for epoch in travel.epochs], np.float64),
        epoch_distance_m=_by_epoch([epoch.distance_m for epoch in travel.epochs]),
        epoch_time_s=_by_epoch([epoch.time_s for epoch in travel.epochs]),
        capacity=np.array([robot.capacity for robot in robots], np.float64),
        pace=np.array([1.0 / robot.speed for robot in robots]),
        max_duration_s=duration_s,
        held=np.array(held, np.int64),
        twin=_twins(problem),
        place=np.array(
            [visit.place for visit in visits]
            + [0] * exchanges
            + [robot.start for robot in robots]
            + [travel.count if robot.end is None else robot.end for robot in robots],
            np.int64,
        ),
        kind=np.repeat(
            np.array([PICK, DROP, *count * chain * [GIVE, TAKE], START, END], np.int64),
            [count, count, *exchanges * [1], len(robots), len(robots)],
        ),
        item=np.array(
            [*numbers, *numbers, *np.repeat(numbers, 2 * chain), *whole, *whole], np.int64
        ),
        earliest_s=np.concatenate(
            (
                [visit.window.earliest_s for visit in visits],
                -free,
                [shift.earliest_s for shift in shifts],
                [shift.earliest_s for shift in shifts],
            )
        ),
        latest_s=np.concatenate(
            (latest_s, free, [inf for _ in shifts], [shift.latest_s for shift in shifts])
        ),
        due_s=np.concatenate(([visit.due_s for visit in visits], free, idle + inf, idle + inf)),
        service_s=np.concatenate(
            (
                [visit.service_s for visit in visits],
                np.full(exchanges, float(handling.service_s)),
                idle,
                idle,
            )
        ),
        load=np.concatenate(
            (
                size,
                -size,
                np.repeat(size, 2 * chain) * np.tile((-1.0, 1.0), count * chain),
                loaded,
                idle,
            )
        ),
        size=size,
        max_on_board_s=on_board_s,
        carrier=np.array(
            [
                begun.get(number, NOBODY if item.aboard is None else item.aboard)
                for number, item in enumerate(items)
            ],
            np.int64,
        ),
        near=_related(problem),
        transfer_place=np.array(handling.places, np.int64),
        fastest=float(max(robot.speed for robot in robots)),
        transfer_s=float(handling.service_s),
        together=handling.together,
        chain=chain,
        direct=5,
        spans=int(np.isfinite(on_board_s).sum() + np.isfinite(duration_s).sum()),
        timeless=not (weights.makespan or weights.completion or late or travel.epochs),
        weight_distance=float(weights.distance),
        weight_makespan=float(weights.makespan),
        weight_completion=float(weights.completion),
        weight_lateness=float(weights.lateness),
        weight_robots=float(weights.robots),
        metre=float(weights.distance + weights.makespan) or LEAST_PRICE,
        penalty=_penalty(problem),
    )


def _with_anywhere(matrix: Floats) -> Floats:
    finite = np.where(np.isfinite(matrix), matrix, UNREACHABLE)
    return np.ascontiguousarray(np.pad(finite, (0, 1)))


def _by_epoch(matrices: list[Floats]) -> Floats:
    if not matrices:
        return np.zeros((0, 0, 0))
    return np.array([_with_anywhere(matrix) for matrix in matrices])


def _twins(problem: Problem) -> Integers:
    seen: dict[object, int] = {}
    twins = np.full(len(problem.robots), NOBODY, np.int64)
    for number, robot in enumerate(problem.robots):
        same = replace(robot, name="")
        twins[number] = seen.get(same, NOBODY)
        seen[same] = number
    return twins


def _related(problem: Problem) -> Integers:
    """By item: the others, those first that are near, and to be fetched and brought when it is."""
    time_s = np.minimum(problem.travel.time_s, UNREACHABLE)
    apart = np.zeros((len(problem.items), len(problem.items)))
    ends: list[list[Visit]] = [
        [item.pickup for item in problem.items],
        [item.delivery for item in problem.items],
    ]
    for visits in ends:
        places = [visit.place for visit in visits]
        begins_s = np.array([visit.window.earliest_s for visit in visits])
        apart += time_s[np.ix_(places, places)]
        apart += TIME_SHARE * np.abs(begins_s[:, None] - begins_s[None, :])
    np.fill_diagonal(apart, -1.0)
    return np.ascontiguousarray(np.argsort(apart, axis=1, kind="stable")[:, 1:].astype(np.int64))


def _penalty(problem: Problem) -> float:
    """More than any one item can save when it is left out."""
    weights, travel = problem.weights, problem.travel
    farthest_m = float(np.max(travel.distance_m, where=np.isfinite(travel.distance_m), initial=1.0))
    longest_s = float(np.max(travel.time_s, where=np.isfinite(travel.time_s), initial=1.0))
    slowest = min(robot.speed for robot in problem.robots)
    ends = [v.window.latest_s for item in problem.items for v in (item.pickup, item.delivery)]
    horizon_s = max((end for end in ends if isfinite(end)), default=0.0)
    horizon_s += 4 * len(problem.items) * longest_s / slowest
    horizon_s += max((e.from_s for e in travel.epochs), default=0.0)
    timed = weights.makespan + (weights.completion + weights.lateness) * len(problem.items)
    return 1.0 + 10 * (weights.robots + 4 * weights.distance * farthest_m) + timed * horizon_s


@compiled
def give_node(problem: ProblemArrays, item: int, number: int) -> int:
    """The node of what is given in the item's transfer of that number; what is taken follows it."""
    return 2 * problem.size.size + 2 * (item * problem.chain + number)


@compiled
def origin_of(problem: ProblemArrays, item: int) -> int:
    """Where the item's way begins: its pickup, or the start of the robot that has it."""
    if problem.carrier[item] == NOBODY:
        return int(problem.place[item])
    starts = problem.place.size - 2 * problem.capacity.size
    return int(problem.place[starts + problem.carrier[item]])
