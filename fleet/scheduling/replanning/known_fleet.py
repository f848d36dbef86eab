"""What is known of a fleet, and what its plan says: asked, and never changed."""

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress

from mend.fleet.scheduling.partial_routes import items_in
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.replanning import observed_stops
from mend.fleet.scheduling.replanning.fleet_state import Done, FleetState
from mend.fleet.scheduling.replanning.item_state import TrackedItem
from mend.fleet.scheduling.replanning.live_plan import LivePlan, NextStop
from mend.fleet.scheduling.replanning.robot_state import TrackedRobot
from mend.fleet.scheduling.replanning.transfer_saving import TransferSaving, transfer_saving
from mend.fleet.scheduling.schedule import Schedule
from mend.fleet.scheduling.tolerance import CHECK_S


class KnownFleet:
    """Robots, items and the plan, as they are now; times are seconds on the problem's clock."""

    def __init__(self, state: FleetState) -> None:
        self._state = state
        self._plan: LivePlan | None = None
        """None where no robot works."""

    @property
    def now_s(self) -> float:
        """The time of the last event."""
        return self._state.now_s

    @property
    def items(self) -> Mapping[str, TrackedItem]:
        """All items that there ever were, by name."""
        return {item.item.name: item for item in self._state.items}

    @property
    def robots(self) -> Mapping[str, TrackedRobot]:
        """All robots by name."""
        return {robot.robot.name: robot for robot in self._state.robots}

    @property
    def log(self) -> Sequence[Done]:
        """The stops that were made."""
        return self._state.log

    def plan(self) -> tuple[Problem, Schedule] | None:
        """The problem that was left at the last replanning, and its schedule, checked anew.

        None where no robot works. Raises `ScheduleError` if the plan were wrong.
        """
        return None if self._plan is None else self._plan.checked()

    def stops(self) -> dict[str, tuple[NextStop, ...]]:
        """What every robot is still to do, with the slack of each stop."""
        left: dict[str, tuple[NextStop, ...]] = dict.fromkeys(self.robots, ())
        return left if self._plan is None else {**left, **self._plan.stops()}

    def transfer_savings(self, names: Iterable[str]) -> dict[str, TransferSaving]:
        """What it saves that these items change robots, as far as they are in a plan that holds."""
        left, savings = self._state.residual_problem(), dict[str, TransferSaving]()
        if left is None:
            return savings
        numbers = {self._state.items[n].item.name: number for number, n in enumerate(left.items)}
        planned = set(items_in(left.routes))
        for name in names:
            if numbers.get(name) in planned:
                with suppress(ValueError):
                    savings[name] = transfer_saving(left, numbers[name])
        return savings

    def leaves_s(self, name: str, stop: NextStop) -> float:
        """When a robot has to leave, at the latest, to begin its next stop as planned."""
        state, robot = self._state, self.robots[name]
        from_s, place = robot.available_s(state.now_s), state.place_number(stop.place)
        speed = robot.robot.speed
        later_s = stop.begin_s - state.travel.shortest_lasting_s(robot.place, place, from_s, speed)
        arrival_s = state.travel.trip(robot.place, place, later_s, speed).arrival_s
        return max(from_s, later_s) if arrival_s <= stop.begin_s + CHECK_S else from_s

    def lasts_s(self, name: str, place: str) -> float:
        """How long a robot would drive from where it is, or is about to be; inf without a way."""
        state, robot = self._state, self.robots[name]
        from_s, there = robot.available_s(state.now_s), state.place_number(place)
        return state.travel.trip(robot.place, there, from_s, robot.robot.speed).arrival_s - from_s

    def passes(self, name: str) -> list[str]:
        """The places that a robot passes from stop to stop, once it is where it is on its way to.

        Only its stops where the ways between them are not known.
        """
        state, robot = self._state, self.robots[name]
        at, leaves_s, speed = robot.place, robot.available_s(state.now_s), robot.robot.speed
        passed = [at]
        for stop in self.stops()[name]:
            trip = (at, state.place_number(stop.place))
            arrival_s = state.travel.trip(*trip, leaves_s, speed).arrival_s
            ways = state.ways
            path = () if ways is None else ways.path(trip, arrival_s, leaves_s, speed)
            passed += [place for place, _ in path] or [trip[1]]
            at, leaves_s = trip[1], stop.done_s
        return [state.building.places[place] for place in passed]

    def is_there(self, name: str) -> bool:
        """Whether what a robot has set out to load is there for it, as far as is known.

        Raises `EventError` where it has not set out for anything.
        """
        return observed_stops.is_there(self._state, self._state.robot_number(name))

    def may_have_loaded(self, name: str) -> bool:
        """Whether a robot may have got what it has set out to load: `is_there`, or it was in the
        basket of a robot that has worked again since.

        Raises `EventError` where it has not set out for anything.
        """
        return observed_stops.may_have_loaded(self._state, self._state.robot_number(name))

    def taken_out(self) -> dict[str, frozenset[str]]:
        """By robot, what was taken out of its basket for others, which it may not know yet.

        What it is about to load it is not told of: it may have it again at any moment.
        """
        robots = enumerate(self._state.robots)
        return {
            robot.robot.name: frozenset(
                item.item.name
                for n, item in enumerate(self._state.items)
                if number in item.taken_from and (robot.doing is None or robot.doing.item != n)
            )
            for number, robot in robots
        }

    def closed_until_s(self) -> Mapping[frozenset[str], float]:
        """The ways that are blocked or closed for now, and until when they count as that."""
        return {} if self._state.ways is None else self._state.ways.closed_until_s
