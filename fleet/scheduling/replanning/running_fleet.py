"""A fleet at work: time goes by, things happen, and the plan for the rest holds again.

Robots do what is planned when it is planned unless an event says otherwise; or, where they are
observed, only what an event says. What a robot is on its way to do it does; an event changes the
routes of those robots only whose plan rested on what is not so any more.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from math import inf

from mend.fleet.scheduling.checker import require_valid
from mend.fleet.scheduling.problem import Item, Problem, ProblemError
from mend.fleet.scheduling.replanning import observed_stops, robot_failures
from mend.fleet.scheduling.replanning.events import (
    Cancelled,
    DoorClosed,
    Event,
    EventError,
    Fetched,
    ItemLost,
    LetGo,
    NewItem,
    NewItems,
    RobotBack,
    RobotDelayed,
    RobotFailed,
    RobotMoved,
    SetOut,
    StopBegun,
    StopFailed,
    StopMade,
    Stranded,
    TimePassed,
    WayBlocked,
    WayOpen,
)
from mend.fleet.scheduling.replanning.fleet_state import FleetState
from mend.fleet.scheduling.replanning.item_state import ItemState, ItemStateError, TrackedItem
from mend.fleet.scheduling.replanning.known_fleet import KnownFleet
from mend.fleet.scheduling.replanning.live_plan import LivePlan
from mend.fleet.scheduling.replanning.on_the_way import turn_before
from mend.fleet.scheduling.replanning.open_ways import OpenWays
from mend.fleet.scheduling.replanning.plan_repair import PlanRepair
from mend.fleet.scheduling.replanning.residual_problem import ResidualProblem
from mend.fleet.scheduling.schedule import Route, Schedule
from mend.fleet.scheduling.tolerance import CHECK_S

RECONSIDERED = 6
"""How many items are offered again where a way opens, a robot comes back or something is late."""
NOBODY = "no robot works"


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


class RunningFleet(KnownFleet):
    """Robots, items and the plan. Times are seconds on the problem's clock and are passed in.

    `ways`: the graph behind the problem's travel, with the same places, where ways may be blocked.
    The items of the problem are planned at once, along `start` if there is one; `first` says what
    came of that. `observed`: stops are made when events say so, and what has not happened yet is
    never before now. Raises `ScheduleError` for a `start` that is not valid.
    """

    def __init__(
        self,
        problem: Problem,
        *,
        ways: OpenWays | None = None,
        start: Schedule | None = None,
        observed: bool = False,
    ) -> None:
        if start is not None:
            require_valid(problem, start)
        state = FleetState.beginning(problem, ways, start)
        self._take(state, observed)
        planned = {task.item for task in chain.from_iterable(state.routes)}
        self.first = self._replan([n for n in range(len(problem.items)) if n not in planned])

    @classmethod
    def resumed(cls, state: FleetState, *, observed: bool = True) -> "RunningFleet":
        """The fleet whose state was kept. Raises `ScheduleError` where its plan is not valid."""
        fleet = cls.__new__(cls)
        fleet._take(state, observed)
        fleet._plan_the_rest()
        fleet.first = Outcome()
        return fleet

    def _take(self, state: FleetState, observed: bool) -> None:
        super().__init__(state)
        self._observed = observed
        self._before: list[Route] = list(state.routes)

    def state(self) -> FleetState:
        """All that is known, by itself; `resumed` makes an equal fleet of it."""
        return self._state.copy()

    def fork(self) -> "RunningFleet":
        """An equal fleet on which something can be tried."""
        return RunningFleet.resumed(self._state.copy(), observed=self._observed)

    # --- what happens -----------------------------------------------------------------------------

    def advance(self, now_s: float) -> Outcome:
        """Let robots do what is planned until `now_s`. Raises `EventError` for a time before.

        Where they are observed, what they have not done yet is later, and so may be the rest.
        """
        state = self._state
        if not state.now_s - CHECK_S <= now_s < inf:
            raise EventError(f"it is {state.now_s:g} s already, so nothing happens at {now_s:g} s")
        state.now_s = max(state.now_s, now_s)
        self._before = list(state.routes)
        if self._plan is not None and not self._observed:
            self._plan.carry_out()
        if state.ways is not None and state.ways.forget_reopened(state.now_s):
            # What was closed counts as open now; the plan said so from the beginning.
            state.travel = state.ways.travel()
        return self._keep_up() if self._observed else Outcome()

    def _keep_up(self) -> Outcome:
        late = set[int]() if self._plan is None else self._plan.keep_up()
        return self._replan([], again=late or ()) if late is None or late else Outcome()

    def forget_closed(self) -> None:
        """Forget items with which nothing remains to be done, and the log of stops."""
        self._state.forget_closed()
        self._plan_the_rest()

    def apply(self, event: Event, now_s: float) -> Outcome:
        """Let time pass until `now_s` and let the event happen.

        Raises `EventError` for an event that makes no sense, which changes nothing but the time.
        """
        self.advance(now_s)
        self._before = list(self._state.routes)
        match event:
            case NewItem():
                return self._new_items((event.item,))
            case NewItems():
                return self._new_items(event.items)
            case Cancelled():
                return self._cancel(event.item)
            case RobotDelayed():
                return self._delay(self._state.robot_number(event.robot), event.by_s)
            case RobotFailed():
                return self._replan(robot_failures.fail(self._state, event))
            case RobotBack():
                return self._come_back(event)
            case RobotMoved():
                return self._move(self._state.robot_number(event.robot), event.place)
            case WayBlocked():
                return self._close(event.between, inf)
            case DoorClosed():
                if not event.retry_s > 0:
                    raise EventError("a door must be tried again after more than 0 s")
                return self._close(event.between, self._state.now_s + event.retry_s)
            case WayOpen():
                return self._open(event.between)
            case TimePassed():
                return self._replan(self._state.retry())
            case SetOut() | StopBegun() | StopMade() | StopFailed() | LetGo():
                return self._observe(event)
            case ItemLost():
                return self._end(event.item, ItemState.LOST)
            case Stranded():
                return self._end(event.item, ItemState.STRANDED)
            case Fetched():
                return self._end(event.item, ItemState.CANCELLED)

    def _observe(self, event: SetOut | StopBegun | StopMade | StopFailed | LetGo) -> Outcome:
        if not self._observed:
            raise EventError("these robots are not observed: they do what is planned")
        state, number = self._state, self._state.robot_number(event.robot)
        match event:
            case SetOut():
                return self._set_out(number)
            case StopBegun():
                observed_stops.begin(state, number)
                selling = []
            case StopMade():
                selling = observed_stops.make(state, number, event.closes)
            case StopFailed():
                place = state.place_number(event.at)
                selling = observed_stops.fail(state, number, place, event.again_s)
            case LetGo():
                selling = observed_stops.let_go(state, number, state.place_number(event.at))
        return self._replan(selling)

    def _set_out(self, number: int) -> Outcome:
        observed_stops.set_out(self._state, number)
        assert self._plan is not None, "it works"
        late = self._plan.depart(number)
        return self._replan([], again=late or ()) if late is None or late else Outcome()

    def _end(self, name: str, becomes: ItemState) -> Outcome:
        """No robot does anything more with an item."""
        state, number = self._state, self._state.item_number(name)
        item = state.items[number]
        if item.state not in (ItemState.ABOARD, ItemState.LEFT, ItemState.STRANDED):
            raise EventError(f"item '{name}' is {item.state}: no robot has it, and it lies nowhere")
        try:
            item.strand() if becomes is ItemState.STRANDED else item.close(becomes)
        except ItemStateError as error:
            raise EventError(str(error)) from error
        state.take_out(number)
        return self._replan(state.retry())

    def _new_items(self, items: Sequence[Item]) -> Outcome:
        state, known = self._state, set(self.items)
        for item in items:
            if item.name in known:
                raise EventError(f"there is an item '{item.name}' already")
            if item.aboard is not None:
                raise EventError(f"item '{item.name}' is new; nobody can have it aboard already")
            known.add(item.name)
        robots = tuple(robot.robot for robot in state.robots)
        try:
            Problem("new", state.building.places, state.travel, robots, tuple(items))
        except ProblemError as error:
            raise EventError(str(error)) from error
        first = len(state.items)
        state.items.extend(TrackedItem(item) for item in items)
        numbers = range(first, len(state.items))
        return self._replan(numbers, new=numbers)

    def promise(self, name: str, due_s: float) -> None:
        """An item was said to be delivered by then: from now on it costs to be later."""
        tracked = next(each for each in self._state.items if each.item.name == name)
        delivery = replace(tracked.item.delivery, due_s=due_s)
        tracked.item = replace(tracked.item, delivery=delivery)

    def _cancel(self, name: str) -> Outcome:
        state = self._state
        number = next((n for n, i in enumerate(state.items) if i.item.name == name), None)
        if number is None or not state.items[number].open:
            raise EventError(f"there is no item '{name}' that could be cancelled")
        item = state.items[number]
        if item.returns:
            raise EventError(f"item '{name}' is cancelled already")
        state.take_out(number)
        if not item.under_way and state.about_to(number) is not None:
            item.withdrawn, item.put_off = True, None
            return self._replan(state.retry())
        if item.under_way:
            item.send_back()
            item.put_off = None
            return self._replan([number, *state.retry()])
        item.close(ItemState.CANCELLED)
        return self._replan(state.retry())

    def _delay(self, number: int, by_s: float) -> Outcome:
        state, robot = self._state, self._state.robots[number]
        if not robot.works:
            raise EventError(f"robot '{robot.robot.name}' does not work; it cannot be late")
        if not 0 <= by_s < inf:
            raise EventError("a delay must be at least 0 s and finite")
        assert self._plan is not None, "somebody works"
        before_s = robot.free_s
        robot.free_s = max(before_s, state.now_s) + by_s
        if robot.trip is None and before_s > state.now_s:
            self._delay_handling(number, before_s, robot.free_s)
            return self._replan([])
        if state.travel.epochs:
            return self._replan([])
        late = self._plan.delay(number)
        if late is None or late:
            return self._replan([], again=late or ())
        return Outcome()

    def _delay_handling(self, number: int, before_s: float, now_free_s: float) -> None:
        """What the robot is just putting down or taking up is ready later, too."""
        place = self._state.robots[number].place
        for item in self._state.items:
            if item.place == place and item.ready_s == before_s:
                item.ready_s = now_free_s
            if item.robot == number and item.loaded_s == before_s:
                item.loaded_s = now_free_s

    def _come_back(self, event: RobotBack) -> Outcome:
        state = self._state
        selling = dict.fromkeys([*robot_failures.come_back(state, event), *state.retry()])
        again = state.moved_by.pop(state.robot_number(event.robot), ())
        return self._replan([*selling], again=again)

    def _move(self, number: int, place: str) -> Outcome:
        state, robot = self._state, self._state.robots[number]
        if not robot.works:
            found = robot_failures.be_elsewhere(state, number, state.place_number(place))
            return self._replan(found)
        if robot.doing is not None or robot.trip is not None:
            raise EventError(f"robot '{robot.robot.name}' does not stand there with nothing to do")
        robot.stand_at(state.place_number(place), max(state.now_s, robot.free_s))
        return self._replan([])

    def _close(self, between: tuple[str, str], until_s: float) -> Outcome:
        state, ways = self._state, self._state.known_ways()
        stopped = ways.numbers(between)
        turns = [turn_before(robot, ways, stopped, state.now_s) for robot in state.robots]
        state.travel = ways.close(between, until_s)
        for robot, turn in zip(state.robots, turns, strict=True):
            if turn is not None:
                robot.turn_at(turn, state.travel)
        return self._replan([])

    def _open(self, between: tuple[str, str]) -> Outcome:
        state, ways = self._state, self._state.known_ways()
        before = state.travel
        state.travel = ways.open(between)
        shorter = set()
        for robot, route in zip(state.robots, state.routes, strict=True):
            place = robot.place
            for task in route:
                if state.travel.time_s[place, task.place] < before.time_s[place, task.place]:
                    shorter.add(task.item)
                place = task.place
        return self._replan(state.retry(), again=shorter)

    # --- the plan ---------------------------------------------------------------------------------

    def _replan(
        self, selling: Sequence[int], *, new: Sequence[int] = (), again: Iterable[int] = ()
    ) -> Outcome:
        """Make the rest hold with some items sold; `again`: items offered where that is cheaper."""
        state = self._state
        longer = state.stay_longer()
        residual = state.residual_problem()
        if residual is None:
            self._plan = None
            return self._outcome(new, put_off=dict.fromkeys(selling, NOBODY))
        number_of = {fleet: number for number, fleet in enumerate(residual.items)}
        under_way = [state.items[n].under_way for n in residual.items]
        repair = PlanRepair(residual.problem, residual.routes, residual.held, under_way)
        for item in selling:
            repair.resell(number_of[item])
        repair.repair()
        repair.reconsider([number_of[n] for n in again if n in number_of][:RECONSIDERED])
        self._take_over(residual, repair)
        late = {residual.items[n]: why for n, why in repair.late.items()}
        put_off = {residual.items[n]: why for n, why in repair.put_off.items()}
        for number, why in repair.overtime.items():
            longer[residual.problem.robots[number].name] = why
        outcome = self._outcome(new, put_off, late, longer)
        self._plan_the_rest()
        return outcome

    def _plan_the_rest(self) -> None:
        left = self._state.residual_problem()
        self._plan = None if left is None else LivePlan(self._state, left)

    def _take_over(self, residual: ResidualProblem, repair: PlanRepair) -> None:
        """Let robots and items know what was repaired."""
        state = self._state
        state.routes = residual.fleet_routes(repair.routes, len(state.robots))
        for number, robot in enumerate(residual.robots):
            if not repair.held[number]:
                state.robots[robot].let_go()
            if observed_stops.does_next(state, robot):
                state.robots[robot].take_up()
            if number in repair.overtime:
                ends_s = repair.problem.robots[number].shift.latest_s
                state.robots[robot].overtime_until_s = ends_s
        for number in repair.late:
            state.items[residual.items[number]].overdue = True

    def _outcome(
        self,
        new: Sequence[int],
        put_off: Mapping[int, str],
        late: Mapping[int, str] | None = None,
        overtime: Mapping[str, str] | None = None,
    ) -> Outcome:
        """Refuse or put off what has no place, and say what became of everything."""
        items, refused = self._state.items, {}
        for number, why in put_off.items():
            if number in new:
                refused[items[number].item.name] = why
                items[number].close(ItemState.REFUSED)
            else:
                items[number].put_off = why
        return Outcome(
            self._state.changed_since(self._before),
            {items[n].item.name: why for n, why in (late or {}).items()},
            refused,
            {items[n].item.name: why for n, why in put_off.items() if n not in new},
            overtime or {},
        )
