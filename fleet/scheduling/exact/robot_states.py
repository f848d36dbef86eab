"""All that one robot may have done so far, and what it may do next, as windows allow it.

A state is where the robot is, how far each item is with it, and at which transfer places it has
been. That other robots have to be there in time is left out, apart from what windows say of that:
nothing can be taken before it could be there, nor given when it is too late to be delivered.
"""

from dataclasses import dataclass
from math import inf
from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.exact.state_expansion import (
    Floats,
    Integers,
    Limits,
    Moves,
    expand,
    with_robot,
)
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.tolerance import LENGTH_M
from mend.fleet.scheduling.travel import shortest_ways

MOST_STATES = 200_000
MOST_MOVES = 3_000_000
"""For one robot; beyond that other ways to a proof are quicker."""
MOST_ITEMS = 12
MOST_PLACES = 8


class RobotStates(NamedTuple):
    """One robot's states in an order in which every move leads to a later one; the first is the
    start. The moves from state s are those from `first_move[s]` to `first_move[s + 1]`.

    Nodes are pickups, deliveries and transfer places, numbered in this order. Who ends after a
    state drives `end_m` metres home in `end_s`; both are infinite while something is aboard.
    """

    first_move: Integers
    moves: Moves
    travel_s: Floats
    travel_m: Floats
    """By move."""
    end_s: Floats
    end_m: Floats
    """By state."""
    starts_s: float
    ends_by_s: float


def states_of(problem: Problem) -> list[RobotStates] | None:
    """The states of every robot; None where there are too many."""
    if len(problem.items) > MOST_ITEMS or len(problem.transfers.places) > MOST_PLACES:
        return None
    ways = _ItemWays.of(problem)
    found = []
    for robot in range(len(problem.robots)):
        states = _states_of_robot(problem, robot, ways)
        if states is None:
            return None
        found.append(states)
    return found


@dataclass(frozen=True, slots=True, eq=False)
class _ItemWays:
    """When items can be where at the earliest and at the latest, whoever carries them (seconds).

    `drop_by_s` by item; `to_drop_s` by node (the robots' starts last) and item; `give_by_s` and
    `take_from_s` by item and transfer place.
    """

    drop_by_s: Floats
    to_drop_s: Floats
    give_by_s: Floats
    take_from_s: Floats

    @classmethod
    def of(cls, problem: Problem) -> "_ItemWays":
        items, transfers = problem.items, problem.transfers
        fastest = max(robot.speed for robot in problem.robots)
        ways_s = shortest_ways(problem.travel.time_s) / fastest
        drops = np.array([item.delivery.place for item in items])
        drop_by_s = np.array([_drop_by_s(problem, item) for item in range(len(items))])
        pick_from_s = np.array([_pick_from_s(problem, item) for item in range(len(items))])
        origins = np.array([_origin(problem, item) for item in range(len(items))])
        places = np.array(transfers.places, dtype=np.int64)
        # Where one leaves an item for the other, giving is over before taking begins.
        apart_s = 0.0 if transfers.together else transfers.service_s
        give_by_s = (
            drop_by_s[:, None] - ways_s[np.ix_(places, drops)].T - apart_s - transfers.service_s
        )
        return cls(
            drop_by_s,
            ways_s[np.ix_(np.array(_node_places(problem)), drops)],
            # The kernels are compiled for rows one after the other, as all else has them.
            np.ascontiguousarray(give_by_s),
            pick_from_s[:, None] + ways_s[np.ix_(origins, places)] + apart_s,
        )


def _node_places(problem: Problem) -> list[int]:
    picks = [item.pickup.place for item in problem.items]
    drops = [item.delivery.place for item in problem.items]
    starts = [robot.start for robot in problem.robots]
    return [*picks, *drops, *problem.transfers.places, *starts]


def _drop_by_s(problem: Problem, item: int) -> float:
    described = problem.items[item]
    latest_s = described.delivery.window.latest_s
    if described.aboard is not None:
        return min(latest_s, described.max_on_board_s)
    picked_s = described.pickup.window.latest_s + described.pickup.service_s
    return min(latest_s, picked_s + described.max_on_board_s)


def _pick_from_s(problem: Problem, item: int) -> float:
    """When an item can leave its pickup at the earliest."""
    described = problem.items[item]
    if described.aboard is not None:
        return problem.robots[described.aboard].shift.earliest_s
    return described.pickup.window.earliest_s + described.pickup.service_s


def _origin(problem: Problem, item: int) -> int:
    described = problem.items[item]
    if described.aboard is not None:
        return problem.robots[described.aboard].start
    return described.pickup.place


def _states_of_robot(problem: Problem, robot: int, ways: _ItemWays) -> RobotStates | None:
    described, items, transfers = problem.robots[robot], problem.items, problem.transfers
    count = len(items)
    nodes = 2 * count + len(transfers.places)
    places = [*_node_places(problem)[:nodes], described.start]
    between = np.ix_(np.array(places), np.array(places))
    travel_s = problem.travel.time_s[between] / described.speed
    travel_m = problem.travel.distance_m[between]
    home_s, home_m = np.zeros(nodes + 1), np.zeros(nodes + 1)
    if described.end is not None:
        home_s = problem.travel.time_s[places, described.end] / described.speed
        home_m = problem.travel.distance_m[places, described.end]
    visits = [item.pickup for item in items] + [item.delivery for item in items]
    free = [0.0] * len(transfers.places)
    by_node = np.array([each.window.latest_s for each in visits] + [inf] * len(free))
    earliest_s = np.array([each.window.earliest_s for each in visits] + free)
    lasts_s = np.array([each.service_s for each in visits] + [transfers.service_s] * len(free))
    limits = Limits(
        count,
        len(transfers.places),
        np.array([item.aboard is None for item in items], dtype=np.bool_),
        np.array([item.load for item in items], dtype=np.float64),
        float(described.capacity),
        travel_s,
        earliest_s,
        np.minimum(by_node, _leave_by_s(described.shift.latest_s, home_s[:nodes]) - lasts_s),
        lasts_s,
        ways.drop_by_s,
        np.vstack([ways.to_drop_s[:nodes], ways.to_drop_s[nodes + robot]]),
        ways.give_by_s,
        ways.take_from_s,
        _detours_may_pay(problem),
    )
    aboard = sum(1 << number for number, item in enumerate(items) if item.aboard == robot)
    starts_s = float(described.shift.earliest_s)
    keys, first_move, moves = expand(limits, aboard, starts_s, MOST_STATES, MOST_MOVES)
    if not len(keys):
        return None
    at = keys >> (limits.places + 2 * count)
    empty = np.array([with_robot(key, limits)[0] == 0 for key in keys])
    return RobotStates(
        first_move,
        moves,
        travel_s[at[moves.origin], moves.node],
        travel_m[at[moves.origin], moves.node],
        np.where(empty, home_s[at], inf),
        np.where(empty, home_m[at], inf),
        starts_s,
        float(described.shift.latest_s),
    )


def _leave_by_s(there_by_s: float, home_s: Floats) -> Floats:
    """Minus infinity where there is no way home."""
    return np.asarray(there_by_s - np.where(np.isfinite(home_s), home_s, 0.0)) - np.where(
        np.isfinite(home_s), 0.0, inf
    )


def _detours_may_pay(problem: Problem) -> bool:
    """Whether a way over a transfer place may be shorter than the direct one."""
    for matrix in (problem.travel.distance_m, problem.travel.time_s):
        for place in problem.transfers.places:
            over = matrix[:, place, None] + matrix[None, place, :]
            if bool((over < matrix - LENGTH_M).any()):
                return True
    return False
