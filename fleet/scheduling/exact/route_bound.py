"""A bound from routes: the cheapest mix of whole routes in which everything is done just once.

Dantzig and Wolfe's decomposition with column generation: a linear program chooses shares of routes
(one robot's from start to end), its prices say which routes are still missing. Left out is only
that robots wait for each other, and that routes are whole. What a schedule costs more than the
bound limits how dear each of its routes can be at these prices: few are left.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from math import inf, isfinite

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import csc_array

from mend.fleet.scheduling.exact.robot_states import RobotStates, states_of
from mend.fleet.scheduling.exact.route_costs import (
    PricedMoves,
    Staircases,
    routes_below,
    staircases,
)
from mend.fleet.scheduling.exact.state_expansion import Floats, Integers
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit
from mend.fleet.scheduling.tolerance import CHECK_S, error, safe_bound
from mend.fleet.scheduling.travel import Travel

SMOOTHING = 0.5
"""How much of the best prices so far is in the prices that routes are looked for with."""
MOST_PRICED, MOST_ADDED = 400, 60
"""Routes looked at and added for a robot and a round."""
MOST_STEPS_IN_ALL = 6_000_000
"""On all staircases of a robot."""


@dataclass(frozen=True, slots=True, eq=False)
class RobotRoute:
    """One robot's way: the nodes it visits in order, with what it gives and takes there (bits)."""

    nodes: tuple[int, ...]
    gives: tuple[int, ...]
    takes: tuple[int, ...]
    cost: float


class RouteBound:
    """The bound of a problem, and the routes that a schedule up to some cost can be made of."""

    def __init__(self, problem: Problem, states: list[RobotStates]) -> None:
        self.problem = problem
        self._items, self._places = len(problem.items), len(problem.transfers.places)
        self._robots = [_Robot(problem, each) for each in states]
        self._sides = self._right_sides()
        self._prices = np.zeros(len(self._sides))
        self._proved = -inf
        self._columns: list[tuple[float, dict[int, float]]] = []
        self._known: set[tuple[int, bytes]] = set()
        visits = 2 * self._items + self._places + 1
        self.dearest = 1.0 + sum(visits * robot.dearest_move for robot in self._robots)
        """More than any schedule costs."""

    @property
    def bound(self) -> float:
        """What no schedule costs less than, as far as it is proved; infinite if there is none."""
        safe = safe_bound(self._proved)
        return safe if safe <= self.dearest else inf

    def prove(self, seconds: float, clock: Callable[[], float]) -> None:
        """Raise the bound as far as it goes in the time, or as there is room."""
        until_s = clock() + seconds
        smooth = False
        while True:
            value, prices = self._solve_master()
            tried = prices
            if smooth and isfinite(self._proved):
                tried = SMOOTHING * self._prices + (1.0 - SMOOTHING) * prices
            added, proved = self._price(tried)
            if proved > self._proved:
                self._proved, self._prices = proved, tried
            smooth = added > 0
            done = value - self._proved <= error(value)
            if done or not isfinite(proved) or clock() > until_s:
                break

    def routes(self, cost: float, most: int) -> list[list[RobotRoute]] | None:
        """Every robot's routes in schedules up to a cost; None where they are more than `most`."""
        spare = cost - self._proved + error(cost)
        found: list[list[RobotRoute]] = []
        left = most
        for robot in self._robots:
            priced = robot.priced(self._prices, self._items, self._places)
            stairs = robot.staircases(priced)
            if not len(stairs.first):
                return None
            least = robot.cheapest(stairs)
            rows, _ = robot.routes_below(stairs, priced, least + spare, left + 1)
            if len(rows) > left:
                return None
            left -= len(rows)
            found.append([robot.route(row) for row in rows])
        return found

    def _right_sides(self) -> Floats:
        """Pickups and deliveries are made once, what is given is taken, a robot has one route."""
        picked = [float(item.aboard is None) for item in self.problem.items]
        exchanges = [0.0] * (self._items * self._places)
        return np.array([*picked, *[1.0] * self._items, *exchanges, *[1.0] * len(self._robots)])

    def _solve_master(self) -> tuple[float, Floats]:
        """The cheapest mix of the routes so far, in which what is not done is dear; the prices."""
        costs = [cost for cost, _ in self._columns] + [self.dearest] * len(self._sides)
        entries = [
            (row, column, factor)
            for column, (_, terms) in enumerate(self._columns)
            for row, factor in terms.items()
        ]
        entries += [(row, len(self._columns) + row, 1.0) for row in range(len(self._sides))]
        rows, columns, factors = zip(*entries, strict=True)
        shape = (len(self._sides), len(costs))
        result = linprog(
            np.array(costs),
            A_eq=csc_array((factors, (rows, columns)), shape=shape),
            b_eq=self._sides,
            method="highs",
        )
        return float(result.fun), np.asarray(result.eqlin.marginals)

    def _price(self, prices: Floats) -> tuple[int, float]:
        """Add routes that are cheap at these prices: how many, and the bound that the prices prove;
        minus infinity where there was not enough room for it."""
        bound, added = float(prices @ self._sides), 0
        for number, robot in enumerate(self._robots):
            priced = robot.priced(prices, self._items, self._places)
            stairs = robot.staircases(priced)
            if not len(stairs.first):
                return 0, -inf
            own = len(self._sides) - len(self._robots) + number
            least = robot.cheapest(stairs)
            bound += least - float(prices[own])
            below = float(prices[own]) - error(0.0)
            rows, costs = robot.routes_below(stairs, priced, below, MOST_PRICED)
            for index in np.argsort(costs, kind="stable")[:MOST_ADDED]:
                added += self._add(number, own, rows[index])
        return added, bound

    def _add(self, number: int, own: int, row: Integers) -> bool:
        key = (number, row.tobytes())
        if key in self._known:
            return False
        self._known.add(key)
        route = self._robots[number].route(row)
        terms = {own: 1.0}
        for node, given, taken in zip(route.nodes, route.gives, route.takes, strict=True):
            if node < 2 * self._items:
                terms[node] = 1.0
                continue
            for item in range(self._items):
                sign = ((given >> item) & 1) - ((taken >> item) & 1)
                if sign:
                    place = node - 2 * self._items
                    terms[2 * self._items + item * self._places + place] = float(sign)
        self._columns.append((route.cost, terms))
        return True


class _Robot:
    """One robot's states, with what its moves cost."""

    def __init__(self, problem: Problem, states: RobotStates) -> None:
        weights = problem.weights
        self._states = states
        # No way home stays infinitely far where distance costs nothing.
        reachable = np.isfinite(states.end_m)
        self._end_cost = np.where(
            reachable, weights.distance * np.where(reachable, states.end_m, 0.0), inf
        )
        self._cost = weights.distance * states.travel_m
        self._cost[: states.first_move[1]] += weights.robots
        self._longest = 2 * len(problem.items) + len(problem.transfers.places)
        ends = self._end_cost[np.isfinite(self._end_cost)]
        self.dearest_move = float(max(self._cost.max(initial=0.0), ends.max(initial=0.0)))

    def priced(self, prices: Floats, items: int, places: int) -> PricedMoves:
        """What the moves cost less what they earn."""
        moves, cost = self._states.moves, self._cost.copy()
        visits = moves.node < 2 * items
        cost[visits] -= prices[moves.node[visits]]
        at = moves.node[~visits] - 2 * items
        for item in range(items):
            signs = ((moves.gives[~visits] >> item) & 1) - ((moves.takes[~visits] >> item) & 1)
            cost[~visits] -= signs * prices[2 * items + item * places + at]
        return PricedMoves(cost, self._end_cost)

    def staircases(self, priced: PricedMoves) -> Staircases:
        """What the rest of a route costs from every state."""
        return staircases(self._states, priced, MOST_STEPS_IN_ALL)

    def cheapest(self, stairs: Staircases) -> float:
        """What the cheapest route costs."""
        steps = slice(stairs.first[0], stairs.first[0] + stairs.steps[0])
        costs = stairs.cost[steps][stairs.leave_by_s[steps] >= self._states.starts_s - CHECK_S]
        return float(costs.min(initial=inf))

    def routes_below(
        self, stairs: Staircases, priced: PricedMoves, ceiling: float, most: int
    ) -> tuple[Integers, Floats]:
        """Routes that cost no more than a ceiling, by their moves."""
        return routes_below(self._states, priced, stairs, ceiling, most, self._longest)

    def route(self, row: Integers) -> RobotRoute:
        """The route of some moves."""
        moves = row[row >= 0]
        last = self._states.moves.target[moves[-1]] if len(moves) else 0
        cost = float(self._cost[moves].sum() + self._end_cost[last])
        every = self._states.moves
        return RobotRoute(
            tuple(every.node[moves].tolist()),
            tuple(every.gives[moves].tolist()),
            tuple(every.takes[moves].tolist()),
            cost,
        )


def route_bound(problem: Problem) -> RouteBound | None:
    """The bound of a problem, yet to be proved; None where it does not suit the problem.

    It suits where only distance and the number of robots cost anything, and where windows, or the
    number of items, leave few enough states.
    """
    weights = problem.weights
    visits = [visit for item in problem.items for visit in (item.pickup, item.delivery)]
    late = weights.lateness > 0 and any(isfinite(visit.due_s) for visit in visits)
    if late or weights.makespan or weights.completion or not problem.items:
        return None
    states = states_of(problem)
    return None if states is None else RouteBound(problem, states)


@cache
def prepare() -> None:
    """Compile the kernels, or load them from the disk; once in a process."""
    travel = Travel.euclidean(((0.0, 0.0), (1.0, 0.0)))
    robots = (Robot("a", 0, 0, 1.0), Robot("b", 1, 1, 1.0))
    item = Item("parcel", 1.0, Visit(0), Visit(1))
    bound = route_bound(Problem("warm-up", ("a", "b"), travel, robots, (item,), Transfers((0, 1))))
    assert bound is not None, "so small a problem suits"
    bound.prove(inf, lambda: 0.0)
    bound.routes(bound.dearest, MOST_PRICED)
