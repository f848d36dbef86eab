"""A fleet at work: time goes by, things happen, and the plan for the rest holds again.

Robots do what is planned when it is planned unless an event says otherwise. What a robot is on its
way to do it does; an event changes the routes of those robots only whose plan rested on what is not
so any more.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import inf

from fleet.scheduling.checker import require_valid
from fleet.scheduling.constraint import Constraint, ConstraintKind
from fleet.scheduling.partial_routes import without_items
from fleet.scheduling.problem import Item, Problem, ProblemError
from fleet.scheduling.replanning.events import (
    Cancelled,
    DoorClosed,
    Event,
    EventError,
    NewItem,
    RobotBack,
    RobotDelayed,
    RobotFailed,
    TimePassed,
    WayBlocked,
    WayOpen,
)
from fleet.scheduling.replanning.item_state import ItemState, TrackedItem
from fleet.scheduling.replanning.open_ways import OpenWays
from fleet.scheduling.replanning.rest import Building, Rest, is_given, rest_of
from fleet.scheduling.replanning.robot_state import TrackedRobot, Trip
from fleet.scheduling.replanning.settling import Settling
from fleet.scheduling.schedule import Action, Route, Schedule, Task
from fleet.scheduling.timing import TimedRoutes, service_s
from fleet.scheduling.travel import Travel

TOLERANCE_S = 1e-6
RECONSIDERED = 6
"""How many items are offered again where a way opens or a robot comes back."""


@dataclass(frozen=True, slots=True)
class Done:
    """A stop that was made."""

    robot: str
    action: Action
    item: str
    place: str
    begin_s: float


@dataclass(frozen=True, slots=True)
class NextStop:
    """A stop that is to be made; it may be `slack_s` late before anything breaks."""

    place: str
    action: Action
    item: str
    begin_s: float
    slack_s: float


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of the plan. By item or robot, a sentence each.

    `changed`: robots with other stops than before; `late`: times that cannot be kept;
    `refused`: new items that are not taken; `put_off`: items without a place for now;
    `overtime`: robots that work longer than their shift.
    """

    changed: frozenset[str] = frozenset()
    late: Mapping[str, str] = field(default_factory=dict)
    refused: Mapping[str, str] = field(default_factory=dict)
    put_off: Mapping[str, str] = field(default_factory=dict)
    overtime: Mapping[str, str] = field(default_factory=dict)


class RunningFleet:
    """Robots, items and the plan. Times are seconds on the problem's clock and are passed in.

    `ways`: the graph behind the problem's travel, with the same places, where ways may be blocked.
    The items of the problem are planned at once, along `start` if there is one.
    """

    def __init__(
        self, problem: Problem, *, ways: OpenWays | None = None, start: Schedule | None = None
    ) -> None:
        self._building = Building(problem.name, problem.places, problem.transfers, problem.weights)
        self._travel: Travel = problem.travel
        self._ways = ways
        self._robots = [
            TrackedRobot(robot, robot.start, robot.shift.earliest_s) for robot in problem.robots
        ]
        self._items = [_tracked(item) for item in problem.items]
        self._routes: list[Route] = [()] * len(problem.robots)
        if start is not None:
            self._routes = list(require_valid(problem, start).routes)
        self._now_s = 0.0
        self._at: list[int] = []
        self._rest: Rest | None = None
        self._timed: TimedRoutes | None = None
        self._moved_by: dict[str, set[int]] = {}
        self._departed: set[int] = set()
        self._task_of: dict[int, Task] = {}
        self._before = list(self._routes)
        self.log: list[Done] = []
        unplanned = set(range(len(self._items))) - {t.item for r in self._routes for t in r}
        self.first = self._replan(sorted(unplanned), new=())

    # --- what is known ----------------------------------------------------------------------------

    @property
    def now_s(self) -> float:
        """The time of the last event."""
        return self._now_s

    @property
    def items(self) -> Mapping[str, TrackedItem]:
        """All items that there ever were, by name."""
        return {item.item.name: item for item in self._items}

    @property
    def robots(self) -> Mapping[str, TrackedRobot]:
        """All robots by name."""
        return {robot.robot.name: robot for robot in self._robots}

    def plan(self) -> tuple[Problem, Schedule] | None:
        """The problem that is left since the last replanning, and its schedule, checked anew.

        None where no robot works. Raises `ScheduleError` if the plan were wrong.
        """
        if self._rest is None or self._timed is None:
            return None
        return self._rest.problem, require_valid(self._rest.problem, self._timed.schedule())

    def stops(self) -> dict[str, tuple[NextStop, ...]]:
        """What every robot is still to do, with the slack of each stop."""
        left: dict[str, tuple[NextStop, ...]] = {each.robot.name: () for each in self._robots}
        if self._rest is None or self._timed is None:
            return left
        network = self._timed.network
        for number, robot in enumerate(self._rest.robots):
            events = self._timed.begins[number][self._at[robot] :]
            left[self._robots[robot].robot.name] = tuple(
                NextStop(
                    self._building.places[task.place],
                    task.action,
                    self._items[task.item].item.name,
                    network.earliest_s(event),
                    network.slack_s(event),
                )
                for task, event in zip(self._routes[robot], events, strict=True)
            )
        return left

    # --- what happens -----------------------------------------------------------------------------

    def apply(self, event: Event, now_s: float) -> Outcome:
        """Let time pass until `now_s` and let the event happen.

        Raises `EventError` for an event that makes no sense, which changes nothing but the time.
        """
        self.advance(now_s)
        self._before = list(self._routes)
        match event:
            case NewItem():
                return self._new_item(event.item)
            case Cancelled():
                return self._cancel(event.item)
            case RobotDelayed():
                return self._delay(self._robot(event.robot), event.by_s)
            case RobotFailed():
                return self._fail(self._robot(event.robot), event.lost)
            case RobotBack():
                return self._come_back(self._robot(event.robot), event.place)
            case WayBlocked():
                return self._close(event.between, inf)
            case DoorClosed():
                if not event.retry_s > 0:
                    raise EventError("a door must be tried again after more than 0 s")
                return self._close(event.between, self._now_s + event.retry_s)
            case WayOpen():
                return self._open(event.between)
            case TimePassed():
                return self._replan(self._put_off())

    def advance(self, now_s: float) -> None:
        """Let robots do what is planned until `now_s`. Raises `EventError` for a time before."""
        if not self._now_s - TOLERANCE_S <= now_s < inf:
            raise EventError(f"it is {self._now_s:g} s already, so nothing happens at {now_s:g} s")
        self._now_s = max(self._now_s, now_s)
        self._make_stops()
        for number, robot in enumerate(self._robots):
            if robot.works:
                self._set_out(number, robot)
        if self._ways is not None and self._ways.forget_reopened(self._now_s):
            # What was closed counts as open now; travel said so from the beginning.
            self._travel = self._ways.travel()

    def _make_stops(self) -> None:
        """Make the stops that are due, in an order in which what is taken was given before."""
        rest, timed = self._rest, self._timed
        if rest is None or timed is None:
            return
        goes_on = True
        while goes_on:
            goes_on = False
            for number, robot in enumerate(rest.robots):
                while self._routes[robot]:
                    at, task = self._at[robot], self._routes[robot][0]
                    begin_s = timed.network.earliest_s(timed.begins[number][at])
                    taken = task.action is Action.TAKE
                    if begin_s > self._now_s + TOLERANCE_S or (
                        taken and not is_given(self._routes, robot, task)
                    ):
                        break
                    lasts_s = service_s(rest.problem, timed.routes[number][at])
                    self._make_stop(robot, task, begin_s, begin_s + lasts_s)
                    goes_on = True

    def _make_stop(self, number: int, task: Task, begin_s: float, done_s: float) -> None:
        robot, item = self._robots[number], self._items[task.item]
        name, place = item.item.name, self._building.places[task.place]
        self.log.append(Done(robot.robot.name, task.action, name, place, begin_s))
        match task.action:
            case Action.PICK | Action.TAKE:
                item.load(number, done_s)
            case Action.GIVE:
                item.leave(task.place, done_s)
            case Action.DROP:
                item.close(ItemState.CANCELLED if item.returns else ItemState.DELIVERED)
        if robot.left_s is None:
            robot.left_s = begin_s if robot.trip is None else robot.trip.leaves_s
        robot.place, robot.free_s, robot.trip = task.place, done_s, None
        self._routes[number] = self._routes[number][1:]
        self._at[number] += 1

    def _set_out(self, number: int, robot: TrackedRobot) -> None:
        """A robot that is free leaves for its next stop, or home when its shift is about to end."""
        if robot.trip is not None:
            if robot.trip.keeps or robot.free_s > self._now_s:
                return
            robot.trip = None
        leaves_s = robot.free_s
        if not self._routes[number]:
            self._go_home(robot)
            return
        assert self._rest is not None, "somebody works"
        assert self._timed is not None, "somebody works"
        if self._at[number] == 0:
            leaves = self._timed.leaves[self._rest.robots.index(number)]
            leaves_s = max(leaves_s, self._timed.network.earliest_s(leaves))
        if leaves_s > self._now_s:
            return
        place = self._routes[number][0].place
        speed = robot.robot.speed
        travel = self._rest.problem.travel
        robot.free_s = travel.trip(robot.place, place, leaves_s, speed).arrival_s
        robot.trip, robot.place = Trip(robot.place, leaves_s), place
        self._departed.add(number)
        robot.left_s = leaves_s if robot.left_s is None else robot.left_s

    def _go_home(self, robot: TrackedRobot) -> None:
        """Go home in the last moment, and not before: there may be more to do."""
        ends_s, home = robot.shift_ends_s(), robot.robot.end
        if home is None or robot.place == home or robot.free_s > self._now_s:
            return
        if robot.home_s(self._travel, robot.free_s) <= ends_s:
            now_home_s = robot.home_s(self._travel, self._now_s)
            if now_home_s > ends_s:
                robot.place, robot.free_s = home, ends_s

    # --- events -----------------------------------------------------------------------------------

    def _robot(self, name: str) -> int:
        for number, robot in enumerate(self._robots):
            if robot.robot.name == name:
                return number
        raise EventError(f"there is no robot '{name}'")

    def _new_item(self, item: Item) -> Outcome:
        if item.name in self.items:
            raise EventError(f"there is an item '{item.name}' already")
        if item.aboard is not None:
            raise EventError(f"item '{item.name}' is new; nobody can have it aboard already")
        robots = tuple(robot.robot for robot in self._robots)
        try:
            Problem("new", self._building.places, self._travel, robots, (item,))
        except ProblemError as error:
            raise EventError(str(error)) from error
        self._items.append(TrackedItem(item))
        number = len(self._items) - 1
        return self._replan([number], new=(number,))

    def _cancel(self, name: str) -> Outcome:
        number = next((n for n, i in enumerate(self._items) if i.item.name == name), None)
        if number is None or not self._items[number].open:
            raise EventError(f"there is no item '{name}' that could be cancelled")
        item = self._items[number]
        if item.returns:
            raise EventError(f"item '{name}' is cancelled already")
        self._take_out(number)
        if item.under_way:
            item.send_back()
            item.put_off = None
            return self._replan([number, *self._put_off()])
        item.close(ItemState.CANCELLED)
        return self._replan(self._put_off())

    def _delay(self, number: int, by_s: float) -> Outcome:
        robot = self._robots[number]
        if not robot.works:
            raise EventError(f"robot '{robot.robot.name}' does not work; it cannot be late")
        if not 0 <= by_s < inf:
            raise EventError("a delay must be at least 0 s and finite")
        before_s = robot.free_s
        robot.free_s = max(robot.free_s, self._now_s) + by_s
        busy = robot.trip is None and before_s > self._now_s
        if busy:
            self._delay_handling(number, before_s, robot.free_s)
        if busy or self._travel.epochs:
            return self._replan([])
        late = self._propagate(number)
        if late is None or late:
            return self._replan([], again=late or ())
        return Outcome()

    def _delay_handling(self, number: int, before_s: float, now_free_s: float) -> None:
        """What the robot is just putting down or taking up is ready later, too."""
        place = self._robots[number].place
        for item in self._items:
            if item.place == place and item.ready_s == before_s:
                item.ready_s = now_free_s
            if item.robot == number and item.loaded_s == before_s:
                item.loaded_s = now_free_s

    def _propagate(self, number: int) -> set[int] | None:
        """Tell the temporal network that a robot is free later; the items that are late for it.

        None where a constraint breaks.
        """
        assert self._rest is not None, "somebody works"
        assert self._timed is not None, "somebody works"
        place, robot = self._rest.robots.index(number), self._robots[number]
        event, task = self._timed.leaves[place], None
        if self._at[number] > 0 or number in self._departed:
            if not self._routes[number]:
                return set()
            event = self._timed.begins[place][self._at[number]]
            task = self._timed.routes[place][self._at[number]]
        network, reason = self._timed.network, Constraint(ConstraintKind.TRAVEL, place, task)
        mark = network.mark()
        if network.not_before(event, robot.free_s, reason) is not None:
            return None
        return {
            self._rest.items[moved.item]
            for at in network.moved_since(mark)
            if (moved := self._task_of.get(at)) is not None
            and network.earliest_s(at) > _due_s(self._rest.problem, moved) + TOLERANCE_S
        }

    def _fail(self, number: int, lost: frozenset[str]) -> Outcome:
        robot = self._robots[number]
        if not robot.works:
            raise EventError(f"robot '{robot.robot.name}' has failed already")
        aboard = {item.item.name for item in self._items if item.robot == number}
        if not lost <= aboard:
            names = ", ".join(sorted(lost - aboard))
            raise EventError(f"robot '{robot.robot.name}' does not have {names} on board")
        self._stand_still(robot)
        moved = {task.item for task in self._routes[number]}
        robot.works, robot.trip = False, None
        for n, item in enumerate(self._items):
            if item.state is ItemState.ABOARD and item.robot == number:
                item.put_off = None
                if item.item.name in lost:
                    moved.discard(n)
                    self._take_out(n)
                    item.close(ItemState.LOST)
                else:
                    moved.add(n)
                    item.leave(robot.place, self._now_s)
        for n in moved:
            self._take_out(n, keep_pickups=True)
        self._routes[number] = ()
        self._moved_by[robot.robot.name] = moved
        return self._replan(sorted(moved))

    def _stand_still(self, robot: TrackedRobot) -> None:
        """A robot on its way stops at the place of its way that it has passed or is nearest to."""
        if robot.trip is None or robot.free_s <= self._now_s:
            robot.free_s = self._now_s
            return
        passed = self._passed(robot)
        if passed is not None:
            robot.place = passed[0]
        elif robot.free_s - self._now_s > self._now_s - robot.trip.leaves_s:
            robot.place = robot.trip.origin
        robot.free_s = self._now_s

    def _passed(self, robot: TrackedRobot) -> tuple[int, float] | None:
        """The last place of the graph that a robot on its way has passed, and when."""
        passed = [each for each in self._path(robot) if each[1] <= self._now_s]
        return passed[-1] if passed else None

    def _path(self, robot: TrackedRobot) -> tuple[tuple[int, float], ...]:
        assert robot.trip is not None, "it is on its way"
        if self._ways is None:
            return ()
        trip = (robot.trip.origin, robot.place)
        return self._ways.path(trip, robot.free_s, robot.trip.leaves_s, robot.robot.speed)

    def _come_back(self, number: int, place: str) -> Outcome:
        robot = self._robots[number]
        if robot.works:
            raise EventError(f"robot '{robot.robot.name}' works already")
        if place not in self._building.places:
            raise EventError(f"there is no place '{place}'")
        robot.works, robot.place = True, self._building.places.index(place)
        robot.free_s = max(self._now_s, robot.robot.shift.earliest_s)
        moved = self._moved_by.pop(robot.robot.name, set())
        return self._replan(self._put_off(), again=moved)

    def _close(self, between: tuple[str, str], until_s: float) -> Outcome:
        ways = self._known_ways()
        stopped = ways.numbers(between)
        turned = [
            (robot, turn)
            for robot in self._robots
            if robot.works and robot.trip is not None and robot.free_s > self._now_s
            for turn in self._turn(robot, stopped)
        ]
        ways.close(between, until_s)
        self._travel = ways.travel()
        for robot, (place, free_s) in turned:
            robot.place, robot.free_s, robot.trip = place, free_s, None
        return self._replan([])

    def _turn(self, robot: TrackedRobot, stopped: frozenset[int]) -> list[tuple[int, float]]:
        """Where a robot leaves its way for what is closed on it: at the next place, or it returns
        to the one before; nothing where it does not come through there any more."""
        path = self._path(robot)
        if path and path[0][1] >= self._now_s:
            path = ((path[0][0], self._now_s), *path[1:])
        for (place, there_s), (following, then_s) in pairwise(path):
            if {place, following} == stopped and then_s > self._now_s:
                if there_s <= self._now_s:
                    return [(place, 2 * self._now_s - there_s)]
                ahead = next((each for each in path if each[1] >= self._now_s), path[0])
                return [ahead]
        return []

    def _open(self, between: tuple[str, str]) -> Outcome:
        ways = self._known_ways()
        before = self._travel
        ways.open(between)
        self._travel = ways.travel()
        shorter = {
            task.item
            for number, route in enumerate(self._routes)
            for origin, task in zip(
                (self._robots[number].place, *(t.place for t in route)), route, strict=False
            )
            if self._travel.time_s[origin, task.place] < before.time_s[origin, task.place]
        }
        return self._replan(self._put_off(), again=shorter)

    def _known_ways(self) -> OpenWays:
        if self._ways is None:
            raise EventError("the ways between the places are not known, only how long they take")
        return self._ways

    def _put_off(self) -> list[int]:
        """The items that have no place for now, to be tried again."""
        waiting = [n for n, item in enumerate(self._items) if item.open and item.put_off]
        for number in waiting:
            self._items[number].put_off = None
        return waiting

    def _take_out(self, item: int, *, keep_pickups: bool = False) -> None:
        """Remove an item from all routes; whoever is on its way to it goes there all the same."""
        for number, route in enumerate(self._routes):
            if not any(task.item == item for task in route):
                continue
            robot = self._robots[number]
            held = robot.held and route[0].item == item
            if held and keep_pickups and robot.works and route[0].action is Action.PICK:
                self._routes[number] = (route[0], *without_items([route[1:]], {item})[0])
                continue
            if held:
                robot.let_go()
            self._routes[number] = without_items([route], {item})[0]

    # --- the plan ---------------------------------------------------------------------------------

    def _replan(
        self, selling: Sequence[int], *, new: Sequence[int] = (), again: Iterable[int] = ()
    ) -> Outcome:
        """Make the rest hold with some items sold; `again`: items offered where that is cheaper."""
        longer = self._stay_longer()
        rest = self._rest_now()
        if rest is None:
            self._rest = self._timed = None
            why = "no robot works"
            for number in selling:
                self._items[number].put_off = why
            return self._refuse(dict.fromkeys(new, why), {n: why for n in selling if n not in new})
        number_of = {fleet: number for number, fleet in enumerate(rest.items)}
        under_way = [self._items[n].under_way for n in rest.items]
        settling = Settling(rest.problem, rest.routes, rest.held, under_way)
        for item in selling:
            settling.resell(number_of[item])
        settling.settle()
        settling.reconsider([number_of[n] for n in again if n in number_of][:RECONSIDERED])
        self._take_over(rest, settling)
        put_off = {rest.items[n]: why for n, why in settling.put_off.items()}
        refused = {n: put_off.pop(n) for n in new if n in put_off}
        outcome = self._refuse(refused, put_off)
        self._time_anew()
        return Outcome(
            self._changed(),
            {self._items[rest.items[n]].item.name: why for n, why in settling.late.items()},
            outcome.refused,
            outcome.put_off,
            {
                **longer,
                **{
                    self._robots[rest.robots[k]].robot.name: w for k, w in settling.overtime.items()
                },
            },
        )

    def _stay_longer(self) -> dict[str, str]:
        """The robots that cannot be at their ends in time any more, with a sentence each."""
        found = {
            robot.robot.name: robot.stay_longer(self._travel, self._now_s)
            for robot in self._robots
            if robot.works
        }
        return {name: why for name, why in found.items() if why is not None}

    def _changed(self) -> frozenset[str]:
        """The robots that have other stops than before the event."""
        return frozenset(
            robot.robot.name
            for robot, now, before in zip(self._robots, self._routes, self._before, strict=True)
            if _stops(now) != _stops(before)
        )

    def _rest_now(self) -> Rest | None:
        return rest_of(
            self._building, self._travel, self._robots, self._items, self._routes, self._now_s
        )

    def _take_over(self, rest: Rest, settling: Settling) -> None:
        self._routes = rest.fleet_routes(settling.routes, len(self._robots))
        for number, robot in enumerate(rest.robots):
            if not settling.held[number]:
                self._robots[robot].let_go()
            if number in settling.overtime:
                self._robots[robot].overtime_until_s = settling.problem.robots[
                    number
                ].shift.latest_s
        for number in settling.late:
            self._items[rest.items[number]].overdue = True
        for number, why in settling.put_off.items():
            self._items[rest.items[number]].put_off = why

    def _refuse(self, refused: Mapping[int, str], put_off: Mapping[int, str]) -> Outcome:
        for number in refused:
            self._items[number].close(ItemState.REFUSED)
        return Outcome(
            refused={self._items[n].item.name: why for n, why in refused.items()},
            put_off={self._items[n].item.name: why for n, why in put_off.items()},
        )

    def _time_anew(self) -> None:
        self._at, self._departed = [0] * len(self._robots), set()
        self._rest = self._rest_now()
        assert self._rest is not None, "somebody works"
        self._timed = TimedRoutes(self._rest.problem, self._rest.routes)
        require_valid(self._rest.problem, self._timed.schedule())
        self._task_of = {
            event: task
            for events, route in zip(self._timed.begins, self._timed.routes, strict=True)
            for event, task in zip(events, route, strict=True)
        }


def _due_s(problem: Problem, task: Task) -> float:
    """After when a task costs something, if that counts."""
    item = problem.items[task.item]
    if not problem.weights.lateness or task.action not in (Action.PICK, Action.DROP):
        return inf
    return (item.pickup if task.action is Action.PICK else item.delivery).due_s


def _stops(route: Route) -> list[tuple[int, int, bool]]:
    """What is loaded and unloaded where, whoever has a part in it."""
    return [(task.place, task.item, task.action.loads) for task in route]


def _tracked(item: Item) -> TrackedItem:
    if item.aboard is None:
        return TrackedItem(item)
    return TrackedItem(item, ItemState.ABOARD, item.aboard, loaded_s=0.0)
