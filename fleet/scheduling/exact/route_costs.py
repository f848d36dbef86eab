"""The kernels behind `route_bound`: what a robot's routes cost when moves have prices.

Every state has a staircase: the later it is left, the more the cheapest way on from it costs.
"""

from typing import NamedTuple

import numpy as np

from mend.fleet.scheduling.exact.robot_states import RobotStates
from mend.fleet.scheduling.exact.state_expansion import Floats, Integers
from mend.fleet.scheduling.tolerance import CHECK_S
from mend.maps.compiled import compiled

MOST_STEPS = 4096
"""On one state's staircase."""


class PricedMoves(NamedTuple):
    """What a robot's moves cost less what they earn, and by state what it costs to end there."""

    move_cost: Floats
    end_cost: Floats


class Staircases(NamedTuple):
    """By state, from `first[state]` to `first[state] + steps[state]`, cheapest first: who leaves
    until `leave_by_s` can end for `cost`. Nothing at all where there was not enough room."""

    first: Integers
    steps: Integers
    leave_by_s: Floats
    cost: Floats


@compiled
def add_step(by_s: Floats, cost: Floats, count: int, new_by_s: float, new_cost: float) -> int:
    """Add a step unless another is as late and as cheap; drop those that it makes useless."""
    for step in range(count):
        if by_s[step] >= new_by_s and cost[step] <= new_cost:
            return count
    kept = 0
    for step in range(count):
        if by_s[step] > new_by_s or cost[step] < new_cost:
            by_s[kept], cost[kept] = by_s[step], cost[step]
            kept += 1
    by_s[kept], cost[kept] = new_by_s, new_cost
    return kept + 1


@compiled
def staircases(robot: RobotStates, priced: PricedMoves, most: int) -> Staircases:
    """What the rest of a route costs, for all states, from the last to the first."""
    moves, count = robot.moves, len(robot.end_s)
    first, steps = np.zeros(count, np.int64), np.zeros(count, np.int64)
    leave_by_s, cost = np.empty(most), np.empty(most)
    by_s, costs = np.empty(MOST_STEPS), np.empty(MOST_STEPS)
    used = 0
    for state in range(count - 1, -1, -1):
        found = 0
        if robot.end_s[state] < np.inf:
            home_by_s = robot.ends_by_s - robot.end_s[state]
            found = add_step(by_s, costs, found, home_by_s, priced.end_cost[state])
        for move in range(robot.first_move[state], robot.first_move[state + 1]):
            after = moves.target[move]
            for step in range(first[after], first[after] + steps[after]):
                if moves.over_from_s[move] > leave_by_s[step] + CHECK_S:
                    continue
                arrive_s = min(moves.arrives_by_s[move], leave_by_s[step] - moves.lasts_s[move])
                whole = priced.move_cost[move] + cost[step]
                found = add_step(by_s, costs, found, arrive_s - robot.travel_s[move], whole)
                if found == MOST_STEPS:
                    return Staircases(first[:0], steps[:0], leave_by_s[:0], cost[:0])
        if used + found > most:
            return Staircases(first[:0], steps[:0], leave_by_s[:0], cost[:0])
        cheapest = np.argsort(costs[:found])
        leave_by_s[used : used + found] = by_s[:found][cheapest]
        cost[used : used + found] = costs[:found][cheapest]
        first[state], steps[state] = used, found
        used += found
    return Staircases(first, steps, leave_by_s[:used], cost[:used])


@compiled
def rest_of(stairs: Staircases, state: int, leaves_s: float) -> float:
    """The least cost to end from a state that is left at a time; infinite if impossible."""
    for step in range(stairs.first[state], stairs.first[state] + stairs.steps[state]):
        if stairs.leave_by_s[step] >= leaves_s - CHECK_S:
            return float(stairs.cost[step])
    return np.inf


@compiled
def routes_below(
    robot: RobotStates, priced: PricedMoves, stairs: Staircases, ceiling: float, most: int,
    longest: int,
) -> tuple[Integers, Floats]:  # fmt: skip
    """Routes that cost no more than a ceiling: their moves (-1 after the last), and their costs.

    At most `most` routes of at most `longest` moves, in the order of the moves.
    """
    routes, costs = np.full((most, longest), -1, np.int64), np.empty(most)
    state, next_move = np.zeros(longest + 1, np.int64), np.zeros(longest + 1, np.int64)
    route, spent = np.full(longest, -1, np.int64), np.zeros(longest + 1)
    leaves_s = np.full(longest + 1, robot.starts_s)
    moves, found, depth = robot.moves, 0, 0
    entered = True
    while depth >= 0:
        here = state[depth]
        if entered:
            next_move[depth] = robot.first_move[here]
            whole = spent[depth] + priced.end_cost[here]
            home_s = leaves_s[depth] + robot.end_s[here]
            if whole <= ceiling and home_s <= robot.ends_by_s + CHECK_S:
                if found == most:
                    break
                routes[found, :depth], costs[found] = route[:depth], whole
                found += 1
        move = next_move[depth]
        entered = False
        if move == robot.first_move[here + 1]:
            depth -= 1
            continue
        next_move[depth] += 1
        arrives_s = leaves_s[depth] + robot.travel_s[move]
        if arrives_s > moves.arrives_by_s[move] + CHECK_S:
            continue
        over_s = max(arrives_s + moves.lasts_s[move], moves.over_from_s[move])
        after = moves.target[move]
        cost = spent[depth] + priced.move_cost[move]
        if cost + rest_of(stairs, after, over_s) <= ceiling:
            route[depth] = move
            depth += 1
            state[depth], leaves_s[depth], spent[depth] = after, over_s, cost
            entered = True
    return routes[:found], costs[:found]
