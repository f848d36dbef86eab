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

from mend.fleet.scheduling.alns.records import Floats, Integers, Records, records
from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.problem import Problem, Visit

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
    epochs: Records
    epoch_distance_m: Floats
    epoch_time_s: Floats
    """By epoch, and by place and place; none where no door opens or closes."""
    robots: Records
    """`capacity`; `pace`: what travel times are multiplied by; `max_duration_s`; `held`: before how
    many of its first tasks nothing may be put; `twin`: the robot before it that can do exactly the
    same, or `NOBODY`."""
    nodes: Records
    """`place`, `kind`, `item_of`, `earliest_s`, `latest_s`, `due_s`, `service_s`; `load`: what the
    load of the robot changes by."""
    items: Records
    """`load`; `max_on_board_s`; `carrier`: the robot that has it already, or is about to
    pick it up, or `NOBODY`."""
    near: Integers
    """By item: all others, the most related first."""
    transfer_place: Integers
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
    penalty: float
    """What an item costs that is not delivered."""


class Kept(NamedTuple):
    """What of a running plan stays as it is: by robot, before how many of its first tasks nothing
    may be put; items whose pickup is the first task of this robot already."""

    held: Sequence[int]
    begun: Mapping[int, int]


def problem_arrays(problem: Problem, chain: int, kept: Kept | None = None) -> ProblemArrays:
    """The problem, with at most `chain` transfers of one item."""
    items, weights, travel = problem.items, problem.weights, problem.travel
    handling = problem.transfers
    spans = [item.max_on_board_s for item in items if item.aboard is None]
    spans += [robot.max_duration_s for robot in problem.robots]
    visits = [visit for item in items for visit in (item.pickup, item.delivery)]
    late = any(isfinite(visit.due_s) for visit in visits) and weights.lateness
    epochs = records(len(travel.epochs), real="from_s until_s")
    epochs.from_s = [epoch.from_s for epoch in travel.epochs]
    epochs.until_s = [epoch.until_s for epoch in travel.epochs]
    return ProblemArrays(
        distance_m=_with_anywhere(travel.distance_m),
        time_s=_with_anywhere(travel.time_s),
        epochs=epochs,
        epoch_distance_m=_by_epoch([epoch.distance_m for epoch in travel.epochs]),
        epoch_time_s=_by_epoch([epoch.time_s for epoch in travel.epochs]),
        robots=_robots(problem, kept),
        nodes=_nodes(problem, chain),
        items=_items(problem, kept),
        near=_related(problem),
        transfer_place=np.array(handling.places, np.int64),
        fastest=float(max(robot.speed for robot in problem.robots)),
        transfer_s=float(handling.service_s),
        together=handling.together,
        chain=chain,
        spans=sum(isfinite(span_s) for span_s in spans),
        timeless=not (weights.makespan or weights.completion or late or travel.epochs),
        weight_distance=float(weights.distance),
        weight_makespan=float(weights.makespan),
        weight_completion=float(weights.completion),
        weight_lateness=float(weights.lateness),
        weight_robots=float(weights.robots),
        metre=float(weights.distance + weights.makespan) or LEAST_PRICE,
        penalty=_penalty(problem),
    )


def _robots(problem: Problem, kept: Kept | None) -> Records:
    robots = records(len(problem.robots), "held twin", "capacity pace max_duration_s")
    robots.held = 0 if kept is None else kept.held
    robots.twin = _twins(problem)
    robots.capacity = [robot.capacity for robot in problem.robots]
    robots.pace = [1.0 / robot.speed for robot in problem.robots]
    robots.max_duration_s = [robot.max_duration_s for robot in problem.robots]
    return robots


def _items(problem: Problem, kept: Kept | None) -> Records:
    begun = {} if kept is None else kept.begun
    items = records(len(problem.items), "carrier", "load max_on_board_s")
    aboard = [item.aboard for item in problem.items]
    items.carrier = [
        begun.get(number, NOBODY if robot is None else robot) for number, robot in enumerate(aboard)
    ]
    items.load = [item.load for item in problem.items]
    # What is on board from the beginning has its delivery's time in place of this.
    items.max_on_board_s = [
        item.max_on_board_s if item.aboard is None else inf for item in problem.items
    ]
    return items


def _nodes(problem: Problem, chain: int) -> Records:
    parts = (_visits(problem), _exchanges(problem, chain), _ends(problem))
    return np.concatenate(parts).view(np.recarray)


def _blank(count: int) -> Records:
    nodes = records(count, "place kind item_of", "earliest_s latest_s due_s service_s load")
    nodes.earliest_s, nodes.latest_s, nodes.due_s, nodes.item_of = -inf, inf, inf, NOBODY
    return nodes


def _visits(problem: Problem) -> Records:
    items, count = problem.items, len(problem.items)
    nodes = _blank(2 * count)
    visits = [item.pickup for item in items] + [item.delivery for item in items]
    nodes.place = [visit.place for visit in visits]
    nodes.kind = np.repeat((PICK, DROP), count)
    nodes.item_of = np.tile(np.arange(count), 2)
    nodes.earliest_s = [visit.window.earliest_s for visit in visits]
    nodes.latest_s = [visit.window.latest_s for visit in visits]
    # What is on board from the beginning was loaded at the origin of time.
    nodes.latest_s[count:] = np.minimum(
        nodes.latest_s[count:],
        [inf if item.aboard is None else item.max_on_board_s for item in items],
    )
    nodes.due_s = [visit.due_s for visit in visits]
    nodes.service_s = [visit.service_s for visit in visits]
    nodes.load = [item.load for item in items] + [-item.load for item in items]
    return nodes


def _exchanges(problem: Problem, chain: int) -> Records:
    count = len(problem.items)
    nodes = _blank(2 * count * chain)
    nodes.kind = np.tile((GIVE, TAKE), count * chain)
    nodes.item_of = np.repeat(np.arange(count), 2 * chain)
    nodes.service_s = problem.transfers.service_s
    loads = np.array([item.load for item in problem.items])
    nodes.load = np.repeat(loads, 2 * chain) * np.tile((-1.0, 1.0), count * chain)
    return nodes


def _ends(problem: Problem) -> Records:
    robots, count = problem.robots, len(problem.robots)
    nodes = _blank(2 * count)
    anywhere = problem.travel.count
    nodes.kind = np.repeat((START, END), count)
    nodes.place[:count] = [robot.start for robot in robots]
    nodes.place[count:] = [anywhere if robot.end is None else robot.end for robot in robots]
    nodes.earliest_s = [robot.shift.earliest_s for robot in robots] * 2
    nodes.latest_s[count:] = [robot.shift.latest_s for robot in robots]
    for item in problem.items:
        if item.aboard is not None:
            nodes.load[item.aboard] += item.load
    return nodes


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
    laden = {item.aboard for item in problem.items}
    for number, robot in enumerate(problem.robots):
        same = number if number in laden else replace(robot, name="")
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
    return 2 * problem.items.size + 2 * (item * problem.chain + number)


@compiled
def origin_of(problem: ProblemArrays, item: int) -> int:
    """Where the item's way begins: its pickup, or the start of the robot that has it."""
    if problem.items[item].carrier == NOBODY:
        return int(problem.nodes[item].place)
    starts = problem.nodes.size - 2 * problem.robots.size
    return int(problem.nodes[starts + problem.items[item].carrier].place)
