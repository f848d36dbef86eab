"""From routes to a schedule: the earliest times that all constraints allow."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise

from mend.fleet.scheduling.constraint import Constraint, ConstraintKind, sentences
from mend.fleet.scheduling.itinerary import ItineraryLeg, itineraries
from mend.fleet.scheduling.problem import Problem, Window
from mend.fleet.scheduling.schedule import Action, RobotSchedule, Route, Schedule, Stop, Task
from mend.fleet.scheduling.temporal_network import ORIGIN, Conflict, TemporalNetwork
from mend.fleet.scheduling.tolerance import TIMING_S

MAX_ROUNDS = 1000
"""How often the times of routes may be moved because of doors."""


@dataclass(frozen=True, slots=True)
class Untimeable:
    """Why routes cannot be given times: the constraints that cannot hold together."""

    constraints: tuple[Constraint, ...]

    def sentence(self, problem: Problem) -> str:
        """The reason as one sentence."""
        return f"these cannot hold together: {sentences(problem, self.constraints)}"


def earliest_schedule(problem: Problem, routes: Sequence[Route]) -> Schedule | Untimeable:
    """The earliest times for the routes. Raises `BrokenItineraryError`."""
    timed = TimedRoutes(problem, routes)
    if timed.conflict is not None:
        return Untimeable(timed.conflict.reasons)
    return timed.schedule()


class TimedRoutes:
    """The temporal network of some routes, and which of its events is which.

    `leaves` and `ends` by robot, `begins` by robot and number of the task. `items`: those that the
    routes deliver; all if None. Unless they go `homeward`, robots have no ends. Raises
    `BrokenItineraryError`.
    """

    def __init__(
        self,
        problem: Problem,
        routes: Sequence[Route],
        items: Sequence[int] | None = None,
        *,
        homeward: bool = True,
    ) -> None:
        self.problem = problem
        self.routes: list[list[Task]] = []
        self.network: TemporalNetwork[Constraint] = TemporalNetwork()
        self.leaves: list[int] = []
        self.ends: dict[int, int] = {}
        self.begins: list[list[int]] = []
        self.conflict: Conflict[Constraint] | None = None
        ways = itineraries(problem, routes, items)
        for robot, route in enumerate(routes):
            self._add_robot(robot, route)
            if homeward:
                self.go_home(robot)
        for item, legs in ways.items():
            self._join(item, legs)
        self.wait_for_doors()

    def schedule(self) -> Schedule:
        """The earliest schedule. Raises `ValueError` when there is a conflict."""
        if self.conflict is not None:
            raise ValueError("routes with a conflict have no schedule")
        return Schedule(tuple(self._robot_schedule(robot) for robot in range(len(self.routes))))

    # --- more to do -------------------------------------------------------------------------------

    @contextmanager
    def trial(self) -> Iterator[None]:
        """What is added meanwhile is taken back in the end."""
        mark, ends, conflict = self.network.mark(), dict(self.ends), self.conflict
        lengths = [len(route) for route in self.routes]
        try:
            yield
        finally:
            self.network.undo(mark)
            self.ends, self.conflict = ends, conflict
            for length, route, begins in zip(lengths, self.routes, self.begins, strict=True):
                del route[length:], begins[length:]

    def append(self, robot: int, item: int) -> None:
        """Last of all a robot without an end does what its route leaves to be done with an item."""
        described, route = self.problem.items[item], self.routes[robot]
        load = next((at for at, task in enumerate(route) if task.item == item), None)
        if load is None and described.aboard is None:
            load = len(route)
            self._add_task(robot, Task(described.pickup.place, Action.PICK, item))
        self._add_task(robot, Task(described.delivery.place, Action.DROP, item))
        self._join(item, (ItineraryLeg(robot, load, len(route) - 1),))

    def go_home(self, robot: int) -> None:
        """After its last task a robot goes to its end, in time."""
        described = self.problem.robots[robot]
        before, place, gap_s = self._last(robot)
        ends = self.ends[robot] = self.network.add_event()
        if described.end is not None:
            gap_s += self.problem.travel_time_s(robot, place, described.end)
        shift_end = Constraint(ConstraintKind.SHIFT_END, robot)
        duration = Constraint(ConstraintKind.DURATION, robot)
        self._demand(ends, before, gap_s, Constraint(ConstraintKind.HOMEWARD, robot))
        self._demand(ORIGIN, ends, -described.shift.latest_s, shift_end)
        self._demand(self.leaves[robot], ends, -described.max_duration_s, duration)

    def wait_for_doors(self) -> None:
        """Move every arrival to when doors let the robot through, until nothing moves any more.

        Later departures never arrive earlier, so that the first times at which nothing moves are
        the earliest ones. Routes whose times creep on for `MAX_ROUNDS` are taken to have none.
        """
        if not self.problem.travel.epochs:
            return
        for _ in range(MAX_ROUNDS):
            late = [trip for robot in range(len(self.routes)) for trip in self._late_trips(robot)]
            if not late:
                return
            for trip in late:
                self._delay(trip)
            if self.conflict is not None:
                return
        self.conflict = Conflict(tuple(trip.reason for trip in late), 0.0)

    # --- constraints ------------------------------------------------------------------------------

    def _demand(self, later: int, earlier: int, gap_s: float, reason: Constraint) -> None:
        if self.conflict is None:
            self.conflict = self.network.after(later, earlier, gap_s, reason)

    def _add_robot(self, robot: int, route: Route) -> None:
        leaves = self.network.add_event()
        shift_begin = Constraint(ConstraintKind.SHIFT_BEGIN, robot)
        self._demand(leaves, ORIGIN, self.problem.robots[robot].shift.earliest_s, shift_begin)
        self.leaves.append(leaves)
        self.begins.append([])
        self.routes.append([])
        for task in route:
            self._add_task(robot, task)

    def _add_task(self, robot: int, task: Task) -> None:
        before, place, busy_s = self._last(robot)
        begin = self.network.add_event()
        gap_s = busy_s + self.problem.travel_time_s(robot, place, task.place)
        self._demand(begin, before, gap_s, Constraint(ConstraintKind.TRAVEL, robot, task))
        self._demand_window(begin, task)
        self.begins[robot].append(begin)
        self.routes[robot].append(task)

    def _last(self, robot: int) -> tuple[int, int, float]:
        """When a robot begins the last thing that it does, where, and how long that takes."""
        if not self.routes[robot]:
            return self.leaves[robot], self.problem.robots[robot].start, 0.0
        task = self.routes[robot][-1]
        return self.begins[robot][-1], task.place, service_s(self.problem, task)

    def _demand_window(self, begin: int, task: Task) -> None:
        window = task_window(self.problem, task)
        if window is not None:
            opens = Constraint(ConstraintKind.WINDOW_BEGIN, None, task)
            closes = Constraint(ConstraintKind.WINDOW_END, None, task)
            self._demand(begin, ORIGIN, window.earliest_s, opens)
            self._demand(ORIGIN, begin, -window.latest_s, closes)

    def _join(self, item: int, legs: Sequence[ItineraryLeg]) -> None:
        """Bind an item's tasks on different robots: give before take, and its time on board."""
        transfers = self.problem.transfers
        for giving, taking in pairwise(legs):
            assert taking.load is not None
            give = self.begins[giving.robot][giving.unload]
            take = self.begins[taking.robot][taking.load]
            task = self.routes[taking.robot][taking.load]
            reason = Constraint(ConstraintKind.TRANSFER, taking.robot, task)
            self._demand(take, give, 0.0 if transfers.together else transfers.service_s, reason)
            if transfers.together:
                self._demand(give, take, 0.0, reason)
        described = self.problem.items[item]
        first, last = legs[0], legs[-1]
        loaded, loading_s = ORIGIN, 0.0
        if first.load is not None:
            loaded = self.begins[first.robot][first.load]
            loading_s = described.pickup.service_s
        drop = self.begins[last.robot][last.unload]
        reason = Constraint(
            ConstraintKind.ON_BOARD, last.robot, self.routes[last.robot][last.unload]
        )
        self._demand(loaded, drop, -described.max_on_board_s - loading_s, reason)

    def _late_trips(self, robot: int) -> Iterator["_LateTrip"]:
        """The trips of a robot that doors make longer than the network knows so far."""
        described = self.problem.robots[robot]
        travel, earliest_s = self.problem.travel, self.network.earliest_s
        before, place, busy_s = self.leaves[robot], described.start, 0.0
        legs: list[tuple[int, Task | None]] = list(
            zip(self.begins[robot], self.routes[robot], strict=True)
        )
        if robot in self.ends:
            legs.append((self.ends[robot], None))
        for event, task in legs:
            destination = described.end if task is None else task.place
            if destination is None:
                return
            leaves_s = earliest_s(before) + busy_s
            arrival_s = travel.trip(place, destination, leaves_s, described.speed).arrival_s
            if arrival_s > earliest_s(event) + TIMING_S:
                lasts_s = travel.shortest_lasting_s(place, destination, leaves_s, described.speed)
                reason = Constraint(ConstraintKind.OPENING, robot, task)
                yield _LateTrip(before, event, busy_s + lasts_s, arrival_s, reason)
            if task is not None:
                before, place, busy_s = event, task.place, service_s(self.problem, task)

    def _delay(self, trip: "_LateTrip") -> None:
        self._demand(trip.arrives, trip.leaves, trip.gap_s, trip.reason)
        self._demand(trip.arrives, ORIGIN, trip.arrival_s, trip.reason)

    def _robot_schedule(self, robot: int) -> RobotSchedule:
        earliest_s = self.network.earliest_s
        described = self.problem.robots[robot]
        place = described.start
        free_s = leaves_s = earliest_s(self.leaves[robot])
        stops: list[Stop] = []
        for task, event in zip(self.routes[robot], self.begins[robot], strict=True):
            arrival_s = self._arrival_s(robot, place, task.place, free_s)
            begin_s = max(arrival_s, earliest_s(event))
            free_s = begin_s + service_s(self.problem, task)
            stops.append(Stop(task, arrival_s, begin_s, free_s))
            place = task.place
        ends_s = free_s
        if described.end is not None:
            ends_s = self._arrival_s(robot, place, described.end, free_s)
        return RobotSchedule(tuple(stops), leaves_s, ends_s)

    def _arrival_s(self, robot: int, origin: int, destination: int, leaves_s: float) -> float:
        problem = self.problem
        if not problem.travel.epochs:
            return leaves_s + problem.travel_time_s(robot, origin, destination)
        speed = problem.robots[robot].speed
        return problem.travel.trip(origin, destination, leaves_s, speed).arrival_s


@dataclass(frozen=True, slots=True)
class _LateTrip:
    """Event `arrives` is at `arrival_s` or later, and ever at least `gap_s` after `leaves`."""

    leaves: int
    arrives: int
    gap_s: float
    arrival_s: float
    reason: Constraint


def task_window(problem: Problem, task: Task) -> Window | None:
    """When a task may begin; None where any time will do."""
    match task.action:
        case Action.PICK:
            return problem.items[task.item].pickup.window
        case Action.DROP:
            return problem.items[task.item].delivery.window
        case Action.GIVE | Action.TAKE:
            return None


def service_s(problem: Problem, task: Task) -> float:
    """How long a task takes, in seconds."""
    item = problem.items[task.item]
    match task.action:
        case Action.PICK:
            return item.pickup.service_s
        case Action.DROP:
            return item.delivery.service_s
        case Action.GIVE | Action.TAKE:
            return problem.transfers.service_s
