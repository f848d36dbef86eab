"""The plan that a fleet carries out: stops are made as time goes by, delays move what follows."""

from dataclasses import dataclass
from math import inf

from mend.fleet.scheduling.checker import require_valid
from mend.fleet.scheduling.constraint import Constraint, ConstraintKind
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.replanning.fleet_state import FleetState
from mend.fleet.scheduling.replanning.residual_problem import ResidualProblem, is_given
from mend.fleet.scheduling.replanning.robot_state import TrackedRobot, Trip
from mend.fleet.scheduling.schedule import Action, Schedule, Task
from mend.fleet.scheduling.timing import TimedRoutes, service_s
from mend.fleet.scheduling.tolerance import CHECK_S


@dataclass(frozen=True, slots=True)
class NextStop:
    """A stop that is to be made; it may be `slack_s` late before anything breaks.

    `partner`: who takes what is given here, or is still to give what is taken here.
    """

    place: str
    action: Action
    item: str
    begin_s: float
    slack_s: float
    done_s: float
    partner: str | None = None


class LivePlan:
    """The temporal network of what remained when it was planned, and how far that has come.

    Raises `ScheduleError` where the plan is not valid.
    """

    def __init__(self, state: FleetState, residual: ResidualProblem) -> None:
        self._state = state
        self._residual = residual
        self._timed = TimedRoutes(residual.problem, residual.routes)
        self._made = [0] * len(state.robots)
        self._departed: set[int] = set()
        self._task_of = {
            event: task
            for events, route in zip(self._timed.begins, residual.routes, strict=True)
            for event, task in zip(events, route, strict=True)
        }
        self.checked()

    def checked(self) -> tuple[Problem, Schedule]:
        """The problem and its schedule, which the checker has passed just now."""
        return self._residual.problem, require_valid(self._residual.problem, self._timed.schedule())

    def stops(self) -> dict[str, tuple[NextStop, ...]]:
        """What every robot is still to do, with the slack of each stop."""
        state, network = self._state, self._timed.network
        return {
            state.robots[robot].robot.name: tuple(
                NextStop(
                    state.building.places[task.place],
                    task.action,
                    state.items[task.item].item.name,
                    begin_s := network.earliest_s(event),
                    network.slack_s(event),
                    begin_s + service_s(self._residual.problem, left),
                    self._partner(robot, task),
                )
                for task, left, event in zip(
                    state.routes[robot],
                    self._residual.routes[number][self._made[robot] :],
                    self._timed.begins[number][self._made[robot] :],
                    strict=True,
                )
            )
            for number, robot in enumerate(self._residual.robots)
        }

    def _partner(self, robot: int, task: Task) -> str | None:
        routes = self._state.routes
        if task.partner is None or (task.action is Action.TAKE and is_given(routes, robot, task)):
            return None
        return self._state.robots[task.partner].robot.name

    # --- time goes by -----------------------------------------------------------------------------

    def carry_out(self) -> None:
        """Make the stops that are due, and leave for the next ones."""
        self._make_stops()
        for number in self._residual.robots:
            self._set_out(number)

    def _make_stops(self) -> None:
        """In an order in which what is taken was given before."""
        goes_on = True
        while goes_on:
            goes_on = False
            for number, robot in enumerate(self._residual.robots):
                while self._is_due(number, robot):
                    at = self._made[robot]
                    begin_s = self._timed.network.earliest_s(self._timed.begins[number][at])
                    lasts_s = service_s(self._residual.problem, self._residual.routes[number][at])
                    task, *others = self._state.routes[robot]
                    self._state.record(robot, task, begin_s, begin_s + lasts_s)
                    self._state.routes[robot] = tuple(others)
                    self._made[robot] += 1
                    goes_on = True

    def _is_due(self, number: int, robot: int) -> bool:
        route = self._state.routes[robot]
        if not route:
            return False
        begin_s = self._timed.network.earliest_s(self._timed.begins[number][self._made[robot]])
        if begin_s > self._state.now_s + CHECK_S:
            return False
        return route[0].action is not Action.TAKE or is_given(self._state.routes, robot, route[0])

    def _set_out(self, number: int) -> None:
        """A robot that is free leaves for its next stop, or home when its shift is about to end."""
        robot, now_s = self._state.robots[number], self._state.now_s
        if robot.trip is not None:
            if robot.trip.keeps or robot.free_s > now_s:
                return
            robot.trip = None
        if not self._state.routes[number]:
            self._go_home(robot)
            return
        leaves_s = robot.free_s
        if self._made[number] == 0:
            leaves = self._timed.leaves[self._residual.robots.index(number)]
            leaves_s = max(leaves_s, self._timed.network.earliest_s(leaves))
        if leaves_s > now_s:
            return
        place, travel = self._state.routes[number][0].place, self._residual.problem.travel
        arrival_s = travel.trip(robot.place, place, leaves_s, robot.robot.speed).arrival_s
        robot.trip, robot.place, robot.free_s = Trip(robot.place, leaves_s), place, arrival_s
        robot.left_s = leaves_s if robot.left_s is None else robot.left_s
        self._departed.add(number)

    def _go_home(self, robot: TrackedRobot) -> None:
        """Go home in the last moment, and not before: there may be more to do."""
        ends_s, home = robot.shift_ends_s(), robot.robot.end
        travel, now_s = self._state.travel, self._state.now_s
        if home is None or robot.place == home or robot.free_s > now_s:
            return
        if robot.home_s(travel, robot.free_s) <= ends_s < robot.home_s(travel, now_s):
            robot.place, robot.free_s = home, ends_s

    # --- delays -----------------------------------------------------------------------------------

    def depart(self, number: int) -> set[int] | None:
        """A robot has left for its next stop: what `delay` returns."""
        self._departed.add(number)
        return self.delay(number)

    def keep_up(self) -> set[int] | None:
        """What has not happened yet is not before now; the items that are late since then.

        None where a constraint breaks.
        """
        state, late = self._state, set[int]()
        for place, number in enumerate(self._residual.robots):
            robot = state.robots[number]
            if robot.doing is not None:
                lasts_s = 0.0
                if robot.held and robot.begun_s is not None:
                    task = self._residual.routes[place][0]
                    lasts_s = service_s(self._residual.problem, task)
                robot.free_s = max(robot.free_s, state.now_s - lasts_s)
            moved = self._push(number, robot.available_s(state.now_s), newly=True)
            if moved is None:
                return None
            late |= moved
        self._timed.wait_for_doors()
        return None if self._timed.conflict is not None else late

    def delay(self, number: int) -> set[int] | None:
        """Tell the network when a robot is free now; the items that are late for it.

        None, and the network as it was, where a constraint breaks.
        """
        return self._push(number, self._state.robots[number].free_s, newly=False)

    def _push(self, number: int, free_s: float, *, newly: bool) -> set[int] | None:
        place = self._residual.robots.index(number)
        event, task = self._timed.leaves[place], None
        if self._made[number] > 0 or number in self._departed:
            if not self._state.routes[number]:
                return set()
            event = self._timed.begins[place][self._made[number]]
            task = self._residual.routes[place][self._made[number]]
        network, reason = self._timed.network, Constraint(ConstraintKind.TRAVEL, place, task)
        mark = network.mark()
        if network.earliest_s(event) >= free_s:
            return set()
        if network.not_before(event, free_s, reason) is not None:
            return None
        return {
            self._residual.items[moved.item]
            for at, before_s in network.moved_since(mark).items()
            if (moved := self._task_of.get(at)) is not None
            and network.earliest_s(at) > (due_s := _due_s(self._residual.problem, moved)) + CHECK_S
            and not (newly and before_s > due_s + CHECK_S)
        }


def _due_s(problem: Problem, task: Task) -> float:
    """After when a task costs something, if that counts."""
    item = problem.items[task.item]
    if not problem.weights.lateness or task.action not in (Action.PICK, Action.DROP):
        return inf
    return (item.pickup if task.action is Action.PICK else item.delivery).due_s
