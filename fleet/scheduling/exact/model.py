"""The constraint model: one circuit a robot, what it has on board at every node, when it is there.

Any number of transfers per item. A robot visits each transfer place at most once, gives and takes
there whatever it wants. Times and distances are whole thousandths.
"""

from dataclasses import dataclass, field
from enum import Enum
from itertools import product
from math import ceil, floor, inf, isfinite

from ortools.sat.python import cp_model

from mend.fleet.scheduling.exact.nodes import Node, NodeKind, arcs, nodes_of, travel
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Action
from mend.fleet.scheduling.tolerance import WHOLE

SCALE = 1000

Literal = cp_model.IntVar | bool


class Rounding(Enum):
    """Times are rounded up, so that every schedule found can be carried out; or down, so that
    what is infeasible then is infeasible for certain."""

    UP = "up"
    DOWN = "down"


@dataclass
class RobotVariables:
    """One robot's part of the model; lists and keys by node."""

    nodes: list[Node]
    arcs: dict[tuple[int, int], cp_model.IntVar] = field(default_factory=dict)
    visited: dict[int, Literal] = field(default_factory=dict)
    begin: dict[int, cp_model.IntVar] = field(default_factory=dict)
    """When the service begins; at a transfer place: when the robot arrives."""
    ready: dict[int, cp_model.LinearExprT] = field(default_factory=dict)
    """When the robot may drive on."""
    arrives_with: dict[tuple[int, int], Literal] = field(default_factory=dict)
    leaves_with: dict[tuple[int, int], Literal] = field(default_factory=dict)
    """By node and item: whether it is on board."""
    gives: dict[tuple[int, int], cp_model.IntVar] = field(default_factory=dict)
    takes: dict[tuple[int, int], cp_model.IntVar] = field(default_factory=dict)
    """By transfer node and item: whether it changes robots here."""
    exchange_begin: dict[tuple[int, Action, int], cp_model.IntVar] = field(default_factory=dict)
    """By transfer node, GIVE or TAKE, and item: when, where that takes time."""


class ExactModel:
    """A CP-SAT model of a problem; `robots` holds its variables."""

    def __init__(self, problem: Problem, rounding: Rounding = Rounding.UP) -> None:
        self.problem = problem
        self.rounding = rounding
        self.model = cp_model.CpModel()
        self._horizon = self._find_horizon()
        self._pick_begin: dict[int, cp_model.IntVar] = {}
        self._drop_begin: dict[int, cp_model.IntVar] = {}
        self._make_item_times()
        self.robots = [self._make_robot(robot) for robot in range(len(problem.robots))]
        self._share_items()
        self._exchange()
        self._minimize()

    # --- scaling ------------------------------------------------------------------------------

    def _lasting(self, seconds: float) -> int:
        """A duration that something takes."""
        if self.rounding is Rounding.UP:
            return ceil(seconds * SCALE - WHOLE)
        return floor(seconds * SCALE + WHOLE)

    def _until(self, seconds: float) -> int:
        """A latest time or longest duration."""
        if not isfinite(seconds):
            return self._horizon
        return min(self._horizon, floor(seconds * SCALE + WHOLE))

    def _find_horizon(self) -> int:
        """A time by which everything is over, in thousandths of seconds."""
        problem = self.problem
        shifts = [robot.shift.latest_s for robot in problem.robots]
        if all(isfinite(latest_s) for latest_s in shifts):
            return floor(max(shifts) * SCALE + WHOLE)
        finite = problem.travel.time_s[problem.travel.time_s < inf]
        slowest = min(robot.speed for robot in problem.robots)
        visits = [visit for item in problem.items for visit in (item.pickup, item.delivery)]
        legs = 2 * len(visits) + 2 * len(problem.robots) * (1 + len(problem.transfers.places))
        latest_s = (
            max((visit.window.earliest_s for visit in visits), default=0.0)
            + max(robot.shift.earliest_s for robot in problem.robots)
            + legs * (float(finite.max(initial=0.0)) / slowest + problem.transfers.service_s)
            + sum(visit.service_s for visit in visits)
        )
        return ceil(latest_s * SCALE)

    # --- robots -------------------------------------------------------------------------------

    def _make_item_times(self) -> None:
        """One begin per pickup and delivery, whichever robot it is."""
        model = self.model
        for number, item in enumerate(self.problem.items):
            drop_window = item.delivery.window
            self._drop_begin[number] = model.new_int_var(
                min(self._lasting(drop_window.earliest_s), self._horizon),
                max(0, self._until(drop_window.latest_s)),
                f"drop {number}",
            )
            if item.aboard is not None:
                latest = self._until(item.max_on_board_s)
                model.add(self._drop_begin[number] <= latest)
                continue
            window = item.pickup.window
            self._pick_begin[number] = model.new_int_var(
                min(self._lasting(window.earliest_s), self._horizon),
                max(0, self._until(window.latest_s)),
                f"pick {number}",
            )
            loaded = self._pick_begin[number] + self._lasting(item.pickup.service_s)
            model.add(self._drop_begin[number] >= loaded)
            if isfinite(item.max_on_board_s):
                model.add(self._drop_begin[number] - loaded <= self._until(item.max_on_board_s))

    def _make_robot(self, robot: int) -> RobotVariables:
        variables = RobotVariables(nodes_of(self.problem, robot))
        self._make_route(robot, variables)
        for number, node in enumerate(variables.nodes):
            self._make_times(robot, variables, number, node)
            self._make_cargo(robot, variables, number, node)
        self._make_loads(robot, variables)
        self._drive(robot, variables)
        return variables

    def _make_route(self, robot: int, variables: RobotVariables) -> None:
        model = self.model
        literals: list[tuple[int, int, cp_model.LiteralT]] = []
        for i, j in arcs(self.problem, robot, variables.nodes):
            chosen = model.new_bool_var(f"r{robot} {i}->{j}")
            variables.arcs[i, j] = chosen
            literals.append((i, j, chosen))
        literals.append((1, 0, model.new_constant(1)))
        for number, node in enumerate(variables.nodes):
            if node.kind in (NodeKind.START, NodeKind.END):
                variables.visited[number] = True
                continue
            visited = model.new_bool_var(f"r{robot} at {number}")
            variables.visited[number] = visited
            literals.append((number, number, ~visited))
        model.add_circuit(literals)

    def _make_times(self, robot: int, variables: RobotVariables, number: int, node: Node) -> None:
        shift = self.problem.robots[robot].shift
        low, high = self._lasting(shift.earliest_s), self._until(shift.latest_s)
        if node.kind is NodeKind.PICK:
            assert node.item is not None
            begin = self._pick_begin[node.item]
        elif node.kind is NodeKind.DROP:
            assert node.item is not None
            begin = self._drop_begin[node.item]
        else:
            begin = self.model.new_int_var(min(low, high), high, f"r{robot} begin {number}")
        variables.begin[number] = begin
        if node.kind is NodeKind.TRANSFER:
            variables.ready[number] = self.model.new_int_var(
                min(low, high), high, f"r{robot} ready {number}"
            )
        else:
            variables.ready[number] = begin + self._lasting(node.service_s)

    def _make_cargo(self, robot: int, variables: RobotVariables, number: int, node: Node) -> None:
        """What is on board before and after the node; transfers are free, all else is fixed."""
        model, visited = self.model, variables.visited[number]
        for item, described in enumerate(self.problem.items):
            key = (number, item)
            arrives: Literal
            leaves: Literal
            if node.kind is NodeKind.START:
                arrives, leaves = False, described.aboard == robot
            elif node.kind is NodeKind.END:
                arrives = leaves = False
            elif node.item == item:
                arrives = visited if node.kind is NodeKind.DROP else False
                leaves = visited if node.kind is NodeKind.PICK else False
            else:
                arrives = model.new_bool_var(f"r{robot} to {number} with {item}")
                leaves = arrives
                model.add_implication(arrives, visited)
                if node.kind is NodeKind.TRANSFER:
                    leaves = model.new_bool_var(f"r{robot} from {number} with {item}")
                    model.add_implication(leaves, visited)
                    self._make_transfer(robot, variables, key, arrives, leaves)
            variables.arrives_with[key] = arrives
            variables.leaves_with[key] = leaves

    def _make_transfer(
        self,
        robot: int,
        variables: RobotVariables,
        key: tuple[int, int],
        arrives: cp_model.IntVar,
        leaves: cp_model.IntVar,
    ) -> None:
        gives = self.model.new_bool_var(f"r{robot} gives {key}")
        takes = self.model.new_bool_var(f"r{robot} takes {key}")
        self.model.add(arrives + takes == leaves + gives)
        self.model.add_implication(gives, arrives)
        self.model.add_implication(takes, leaves)
        self.model.add_implication(gives, ~leaves)
        variables.gives[key], variables.takes[key] = gives, takes

    def _make_loads(self, robot: int, variables: RobotVariables) -> None:
        capacity = self.problem.robots[robot].capacity
        items = range(len(self.problem.items))
        loads = [round(item.load * SCALE) for item in self.problem.items]
        if not isfinite(capacity) or sum(loads) <= capacity * SCALE:
            return
        limit = floor(capacity * SCALE + WHOLE)
        for number in range(len(variables.nodes)):
            for state in (variables.arrives_with, variables.leaves_with):
                self.model.add(sum(loads[i] * state[number, i] for i in items) <= limit)

    def _drive(self, robot: int, variables: RobotVariables) -> None:
        model, nodes = self.model, variables.nodes
        for (i, j), chosen in variables.arcs.items():
            _, time_s = travel(self.problem, robot, nodes[i], nodes[j])
            moved = variables.ready[i] + self._lasting(time_s)
            model.add(variables.begin[j] >= moved).only_enforce_if(chosen)
            for item in range(len(self.problem.items)):
                before = variables.leaves_with[i, item]
                after = variables.arrives_with[j, item]
                if isinstance(before, bool) and isinstance(after, bool):
                    if before != after:
                        model.add(chosen == 0)
                else:
                    model.add(before == after).only_enforce_if(chosen)
        longest_s = self.problem.robots[robot].max_duration_s
        if isfinite(longest_s):
            model.add(variables.begin[1] - variables.begin[0] <= self._until(longest_s))

    # --- between robots -----------------------------------------------------------------------

    def _share_items(self) -> None:
        """Every pickup and every delivery is made once."""
        for number in range(len(self.problem.items)):
            for kind in (NodeKind.PICK, NodeKind.DROP):
                visits = [
                    robot.visited[at]
                    for robot in self.robots
                    for at, node in enumerate(robot.nodes)
                    if node.kind is kind and node.item == number
                ]
                if visits:
                    self.model.add_exactly_one(visits)
                if kind is NodeKind.PICK and not self.problem.transfers.places:
                    self._keep_together(number)

    def _keep_together(self, item: int) -> None:
        """Without transfers the robot that picks an item drops it."""
        for robot in self.robots:
            visits = [robot.visited[at] for at, node in enumerate(robot.nodes) if node.item == item]
            if len(visits) == 2:
                self.model.add(visits[0] == visits[1])

    def _exchange(self) -> None:
        """What is given at a place is taken there by another robot, and not before."""
        transfers = self.problem.transfers
        first = len(self.robots[0].nodes) - len(transfers.places)
        for at, item in product(
            range(first, first + len(transfers.places)), range(len(self.problem.items))
        ):
            gives = [robot.gives[at, item] for robot in self.robots]
            takes = [robot.takes[at, item] for robot in self.robots]
            self.model.add(sum(gives) == sum(takes))
            self.model.add_at_most_one(gives)
            self.model.add_at_most_one(takes)
        for at in range(first, first + len(transfers.places)):
            if transfers.service_s > 0 or transfers.together:
                self._exchange_in_turn(at)
            else:
                self._exchange_at_once(at)

    def _exchange_at_once(self, at: int) -> None:
        """Giving takes no time: it is done on arrival, and taking just before leaving."""
        for robot in self.robots:
            self.model.add(robot.ready[at] >= robot.begin[at])
        for giver, taker in product(self.robots, self.robots):
            if giver is taker:
                continue
            for item in range(len(self.problem.items)):
                self.model.add(giver.begin[at] <= taker.ready[at]).only_enforce_if(
                    giver.gives[at, item], taker.takes[at, item]
                )

    def _exchange_in_turn(self, at: int) -> None:
        """Each give and each take has its time; a robot does one after the other."""
        model, service = self.model, self._lasting(self.problem.transfers.service_s)
        items = range(len(self.problem.items))
        for number, robot in enumerate(self.robots):
            model.add(robot.ready[at] >= robot.begin[at])
            intervals = []
            for item in items:
                for action, chosen in ((Action.GIVE, robot.gives), (Action.TAKE, robot.takes)):
                    name = f"r{number} {action} {item} at {at}"
                    begin = model.new_int_var(0, self._horizon, name)
                    robot.exchange_begin[at, action, item] = begin
                    done = chosen[at, item]
                    model.add(begin >= robot.begin[at]).only_enforce_if(done)
                    model.add(begin + service <= robot.ready[at]).only_enforce_if(done)
                    intervals.append(
                        model.new_optional_fixed_size_interval_var(begin, service, done, "")
                    )
            if service:
                model.add_no_overlap(intervals)
            self._order_within_stop(number, at, service)
        for giver, taker, item in product(self.robots, self.robots, items):
            if giver is taker:
                continue
            both = (giver.gives[at, item], taker.takes[at, item])
            give = giver.exchange_begin[at, Action.GIVE, item]
            take = taker.exchange_begin[at, Action.TAKE, item]
            if self.problem.transfers.together:
                model.add(take == give).only_enforce_if(both)
            else:
                model.add(take >= give + service).only_enforce_if(both)

    def _order_within_stop(self, number: int, at: int, service: int) -> None:
        """A robot that takes before it has given must have room for both."""
        model, robot = self.model, self.robots[number]
        items = range(len(self.problem.items))
        gives_first = model.new_bool_var(f"r{number} gives first at {at}")
        for given, taken in product(items, items):
            give = robot.exchange_begin[at, Action.GIVE, given]
            take = robot.exchange_begin[at, Action.TAKE, taken]
            model.add(take >= give + service).only_enforce_if(
                robot.gives[at, given], robot.takes[at, taken], gives_first
            )
        capacity = self.problem.robots[number].capacity
        if isfinite(capacity):
            loads = [round(item.load * SCALE) for item in self.problem.items]
            full = sum(loads[i] * (robot.arrives_with[at, i] + robot.takes[at, i]) for i in items)
            limit = floor(capacity * SCALE + WHOLE)
            model.add(full <= limit).only_enforce_if(~gives_first)

    # --- objective ----------------------------------------------------------------------------

    def _minimize(self) -> None:
        """The weighted cost, in thousandths."""
        weights = self.problem.weights
        terms: list[cp_model.LinearExprT] = []
        for number, robot in enumerate(self.robots):
            for (i, j), chosen in robot.arcs.items():
                distance_m, _ = travel(self.problem, number, robot.nodes[i], robot.nodes[j])
                terms.append(round(weights.distance * distance_m * SCALE) * chosen)
            if weights.robots and (0, 1) in robot.arcs:
                terms.append(round(weights.robots * SCALE) * (1 - robot.arcs[0, 1]))
        terms.extend(self._time_terms())
        self.model.minimize(sum(terms))

    def _time_terms(self) -> list[cp_model.LinearExprT]:
        weights, model = self.problem.weights, self.model
        terms: list[cp_model.LinearExprT] = []
        if weights.makespan:
            makespan = model.new_int_var(0, self._horizon, "makespan")
            for robot in self.robots:
                used = ~robot.arcs[0, 1] if (0, 1) in robot.arcs else True
                model.add(makespan >= robot.begin[1]).only_enforce_if(used)
            terms.append(weights.makespan * makespan)
        for number, item in enumerate(self.problem.items):
            if weights.completion:
                terms.append(weights.completion * self._drop_begin[number])
                terms.append(round(weights.completion * self._lasting(item.delivery.service_s)))
            for visit, begins in (
                (item.pickup, self._pick_begin),
                (item.delivery, self._drop_begin),
            ):
                if weights.lateness and isfinite(visit.due_s) and number in begins:
                    late = model.new_int_var(0, self._horizon, "late")
                    model.add(late >= begins[number] - self._until(visit.due_s))
                    terms.append(weights.lateness * late)
        return terms
