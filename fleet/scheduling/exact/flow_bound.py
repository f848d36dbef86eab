"""A bound from flows: a mixed integer program that every schedule satisfies, solved by HiGHS.

Robots flow along arcs, items along the robots' arcs; at transfer places items may change robots.
Left out is what only makes schedules rarer: that robots wait for each other, durations, and when
they are at transfer places, where they may come as often as they want. So what is proved here
holds for every schedule. Where windows are wide, it is proved sooner than by constraints.
"""

from collections import defaultdict
from math import inf, isfinite

import numpy as np

from mend.fleet.scheduling.exact.linear_program import LinearProgram
from mend.fleet.scheduling.exact.nodes import Node, NodeKind, arcs, nodes_of, travel
from mend.fleet.scheduling.problem import Problem, Visit
from mend.fleet.scheduling.tolerance import safe_bound
from mend.fleet.scheduling.travel import shortest_ways

WIDE = 0.98
"""The share of all ways between visits that wide windows leave."""
ANYBODY = -1

Terms = dict[int, float]
"""Factors by variable."""


def windows_are_wide(problem: Problem) -> bool:
    """Whether most visits may be made right after most others: then the bound is worth its time."""
    nodes = nodes_of(problem, 0)
    visits = [number for number, node in enumerate(nodes) if node.item is not None]
    possible = sum(i in visits and j in visits for i, j in arcs(problem, 0, nodes))
    # Nobody goes from a delivery to its own pickup.
    most = len(visits) * (len(visits) - 1) - (len(visits) - len(problem.items))
    return possible >= WIDE * most


def flow_bound(problem: Problem, seconds: float) -> float | None:
    """What no schedule can cost less than; None where nothing could be proved in time.

    Infinite where there can be no schedule, apart from rounding.
    """
    if not problem.items:
        return None
    proved = _FlowProgram(problem).program.bound(seconds)
    if proved is None or not isfinite(proved):
        return proved
    return max(0.0, safe_bound(proved))


class _FlowProgram:
    """The program of a problem; nodes are numbered as in `nodes_of`."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.program = LinearProgram()
        self._nodes = [nodes_of(problem, robot) for robot in range(len(problem.robots))]
        self._drives: dict[tuple[int, int, int], int] = {}
        """By robot and two nodes: how often it drives from one to the other."""
        for robot in range(len(problem.robots)):
            self._add_route(robot)
        self._share_visits()
        self._driven = self._by_arc()
        self._loads: dict[tuple[int, int, int], Terms] = defaultdict(dict)
        """By arc: what is carried along it."""
        for item in range(len(problem.items)):
            self._add_item(item)
        self._limit_loads()
        self._horizon_s = _horizon_s(problem)
        self._picks = [self._begin(item.pickup) for item in problem.items]
        self._drops = [self._begin(item.delivery) for item in problem.items]
        self._order_times()
        self._price_times()

    def _add_route(self, robot: int) -> None:
        """A robot leaves its start, comes to its end, and leaves whatever else it comes to."""
        program, weights, nodes = self.program, self.problem.weights, self._nodes[robot]
        comes: dict[int, Terms] = defaultdict(dict)
        leaves: dict[int, Terms] = defaultdict(dict)
        for i, j in arcs(self.problem, robot, nodes):
            distance_m, _ = travel(self.problem, robot, nodes[i], nodes[j])
            uses = weights.robots if i == 0 and j != 1 else 0.0
            often = nodes[i].kind is nodes[j].kind is NodeKind.TRANSFER
            drives = self.program.variable(
                0.0,
                inf if often else 1.0,
                cost=weights.distance * distance_m + uses,
                whole=True,
            )
            self._drives[robot, i, j] = drives
            leaves[i][drives] = comes[j][drives] = 1.0
        program.row(leaves[0], 1.0, 1.0)
        program.row(comes[1], 1.0, 1.0)
        for number in range(2, len(nodes)):
            program.row(_difference(comes[number], leaves[number]), 0.0, 0.0)

    def _by_arc(self) -> dict[tuple[int, int, int], dict[int, int]]:
        """Who drives along an arc, with the variables for it; starts are told apart by robot."""
        driven: dict[tuple[int, int, int], dict[int, int]] = defaultdict(dict)
        for (robot, i, j), drives in self._drives.items():
            driven[robot if i == 0 else ANYBODY, i, j][drives] = robot
        return driven

    def _share_visits(self) -> None:
        """Every pickup and every delivery is made once."""
        visits: dict[tuple[NodeKind, int], Terms] = defaultdict(dict)
        for (robot, _, j), drives in self._drives.items():
            node = self._nodes[robot][j]
            if node.item is not None:
                visits[node.kind, node.item][drives] = 1.0
        for item, described in enumerate(self.problem.items):
            kinds = (NodeKind.PICK, NodeKind.DROP)
            for kind in kinds if described.aboard is None else kinds[1:]:
                self.program.row(visits[kind, item], 1.0, 1.0)

    def _add_item(self, item: int) -> None:
        """An item goes only where some robot goes, from its pickup to its delivery.

        As one robot alone comes to each pickup and delivery, it need not be said with whom.
        """
        stays: dict[int, Terms] = defaultdict(dict)
        for arc, driven in self._driven.items():
            if self._may_carry(item, *arc):
                carried = self.program.variable(0.0, 1.0)
                self.program.row({carried: 1.0, **dict.fromkeys(driven, -1.0)}, high=0.0)
                self._loads[arc][carried] = self.problem.items[item].load
                stays[arc[1]][carried] = -1.0
                stays[arc[2]][carried] = 1.0
        for number, terms in stays.items():
            node = self._nodes[0][number]
            more = 0.0
            if node.kind is NodeKind.START or (node.item, node.kind) == (item, NodeKind.PICK):
                more = -1.0
            elif (node.item, node.kind) == (item, NodeKind.DROP):
                more = 1.0
            self.program.row(terms, more, more)

    def _may_carry(self, item: int, robot: int, i: int, j: int) -> bool:
        before, after, described = self._nodes[0][i], self._nodes[0][j], self.problem.items[item]
        if after.kind is NodeKind.END:
            return False
        if before.kind is NodeKind.START and described.aboard != robot:
            return False
        to_pickup = (after.item, after.kind) == (item, NodeKind.PICK)
        return not to_pickup and (before.item, before.kind) != (item, NodeKind.DROP)

    def _limit_loads(self) -> None:
        total = sum(item.load for item in self.problem.items)
        for arc, terms in self._loads.items():
            room = {
                drives: -min(self.problem.robots[robot].capacity, total)
                for drives, robot in self._driven[arc].items()
            }
            self.program.row({**terms, **room}, high=0.0)

    # --- times of pickups and deliveries --------------------------------------------------------

    def _begin(self, visit: Visit) -> int:
        """When a visit begins."""
        latest_s = min(visit.window.latest_s, self._horizon_s)
        return self.program.variable(min(visit.window.earliest_s, latest_s), latest_s)

    def _order_times(self) -> None:
        """A visit begins when a robot can be there from the visit before, or from its start."""
        problem, program = self.problem, self.program
        fastest = max(robot.speed for robot in problem.robots)
        shortest_s = shortest_ways(problem.travel.time_s) / fastest
        for item, described in enumerate(problem.items):
            pick, drop = self._picks[item], self._drops[item]
            if described.aboard is None:
                way = (described.pickup.place, described.delivery.place)
                least_s = described.pickup.service_s + float(shortest_s[way])
                longest_s = described.pickup.service_s + described.max_on_board_s
                program.row({drop: 1.0, pick: -1.0}, least_s, longest_s)
            else:
                program.row({drop: 1.0}, high=described.max_on_board_s)
        together: dict[tuple[int, int], Terms] = defaultdict(dict)
        lasts_s: dict[tuple[int, int], float] = {}
        for (robot, i, j), drives in self._drives.items():
            before, after = self._nodes[robot][i], self._nodes[robot][j]
            if before.item is None or after.item is None:
                continue
            pair = self._visit_begin(before), self._visit_begin(after)
            together[pair][drives] = 1.0
            _, time_s = travel(problem, robot, before, after)
            lasts_s[pair] = min(lasts_s.get(pair, inf), before.service_s + time_s)
        for (before_s, after_s), terms in together.items():
            slack_s = program.high(before_s) + lasts_s[before_s, after_s] - program.low(after_s)
            if slack_s > 0:
                terms = dict.fromkeys(terms, -slack_s)
                least_s = lasts_s[before_s, after_s] - slack_s
                program.row({after_s: 1.0, before_s: -1.0, **terms}, least_s)

    def _visit_begin(self, node: Node) -> int:
        assert node.item is not None, "only pickups and deliveries have times"
        return (self._picks if node.kind is NodeKind.PICK else self._drops)[node.item]

    def _price_times(self) -> None:
        """What the times cost; the last robot is not at its end before the last delivery."""
        weights, program = self.problem.weights, self.program
        makespan = program.variable(0.0, inf, cost=weights.makespan)
        for item, described in enumerate(self.problem.items):
            drop = self._drops[item]
            program.row({makespan: 1.0, drop: -1.0}, described.delivery.service_s)
            if weights.completion:
                done = program.variable(0.0, inf, cost=weights.completion)
                program.row({done: 1.0, drop: -1.0}, described.delivery.service_s)
            visits = [(described.delivery, drop)]
            if described.aboard is None:
                visits.append((described.pickup, self._picks[item]))
            for visit, begin in visits:
                if weights.lateness and isfinite(visit.due_s):
                    late = program.variable(0.0, inf, cost=weights.lateness)
                    program.row({late: 1.0, begin: -1.0}, -visit.due_s)


def _difference(some: Terms, others: Terms) -> Terms:
    """What is in one of the two sums only, with its sign."""
    return {**some, **{variable: -factor for variable, factor in others.items()}}


def _horizon_s(problem: Problem) -> float:
    """A time by which some optimal schedule has begun everything."""
    shifts = [robot.shift.latest_s for robot in problem.robots]
    if all(isfinite(latest_s) for latest_s in shifts):
        return max(shifts)
    finite_s = problem.travel.time_s[np.isfinite(problem.travel.time_s)]
    slowest = min(robot.speed for robot in problem.robots)
    visits = [visit for item in problem.items for visit in (item.pickup, item.delivery)]
    stops = len(visits) * (1 + 2 * len(problem.transfers.places)) + 2
    return (
        max(visit.window.earliest_s for visit in visits)
        + max(robot.shift.earliest_s for robot in problem.robots)
        + sum(visit.service_s for visit in visits)
        + stops * (float(finite_s.max(initial=0.0)) / slowest + 2 * problem.transfers.service_s)
    )
