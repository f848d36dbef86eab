"""What is known of a fleet at work: where robots and items are, and who is to do what."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from mend.fleet.scheduling.partial_routes import without_items
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.replanning.events import EventError
from mend.fleet.scheduling.replanning.item_state import ItemState, TrackedItem
from mend.fleet.scheduling.replanning.open_ways import OpenWays
from mend.fleet.scheduling.replanning.residual_problem import (
    Building,
    ResidualProblem,
    residual_problem,
)
from mend.fleet.scheduling.replanning.robot_state import TrackedRobot
from mend.fleet.scheduling.schedule import Action, Route, Schedule, Task
from mend.fleet.scheduling.travel import Travel


@dataclass(frozen=True, slots=True)
class Done:
    """A stop that was made."""

    robot: str
    action: Action
    item: str
    place: str
    begin_s: float


@dataclass(slots=True)
class FleetState:
    """Robots, items and the routes that are left, all by number; the stops that were made.

    `moved_by`: by robot that has failed, the items that others got then.
    """

    building: Building
    travel: Travel
    ways: OpenWays | None
    robots: list[TrackedRobot]
    items: list[TrackedItem]
    routes: list[Route]
    now_s: float = 0.0
    log: list[Done] = field(default_factory=list)
    moved_by: dict[int, set[int]] = field(default_factory=dict)

    @classmethod
    def beginning(
        cls, problem: Problem, ways: OpenWays | None, start: Schedule | None
    ) -> "FleetState":
        """Nothing has been done yet."""
        items = [
            TrackedItem(item)
            if item.aboard is None
            else TrackedItem(item, ItemState.ABOARD, item.aboard, loaded_s=0.0)
            for item in problem.items
        ]
        return cls(
            Building(problem.name, problem.places, problem.transfers, problem.weights),
            problem.travel,
            ways,
            [TrackedRobot(each, each.start, each.shift.earliest_s) for each in problem.robots],
            items,
            [()] * len(problem.robots) if start is None else list(start.routes),
        )

    def copy(self) -> "FleetState":
        """The same by itself, without what was done: what happens to one leaves the other."""
        return replace(
            self,
            ways=None if self.ways is None else self.ways.copy(),
            robots=[replace(robot) for robot in self.robots],
            items=[item.copy() for item in self.items],
            routes=list(self.routes),
            log=[],
            moved_by={number: set(items) for number, items in self.moved_by.items()},
        )

    def robot_number(self, name: str) -> int:
        """The number of a robot. Raises `EventError`."""
        for number, robot in enumerate(self.robots):
            if robot.robot.name == name:
                return number
        raise EventError(f"there is no robot '{name}'")

    def item_number(self, name: str) -> int:
        """The number of an item. Raises `EventError`."""
        for number, item in enumerate(self.items):
            if item.item.name == name:
                return number
        raise EventError(f"there is no item '{name}'")

    def place_number(self, name: str) -> int:
        """The number of a place. Raises `EventError`."""
        if name not in self.building.places:
            raise EventError(f"there is no place '{name}'")
        return self.building.places.index(name)

    def known_ways(self) -> OpenWays:
        """The ways that can be closed. Raises `EventError` where they are not known."""
        if self.ways is None:
            raise EventError("the ways between the places are not known, only how long they take")
        return self.ways

    def residual_problem(self) -> ResidualProblem | None:
        """What remains to be done; None where no robot works."""
        return residual_problem(
            self.building, self.travel, self.robots, self.items, self.routes, self.now_s
        )

    def record(self, number: int, task: Task, begin_s: float, done_s: float) -> None:
        """A robot has made a stop. Raises `ItemStateError` where it cannot have."""
        item = self.items[task.item]
        match task.action:
            case Action.PICK | Action.TAKE:
                item.load(number, done_s)
            case Action.GIVE:
                item.leave(task.place, done_s)
            case Action.DROP:
                back = item.returns and task.place == item.item.delivery.place
                item.close(ItemState.CANCELLED if back else ItemState.DELIVERED)
        self.note_made(number, task, begin_s, done_s)

    def note_made(self, number: int, task: Task, begin_s: float, done_s: float) -> None:
        """A robot stands where it has made a stop, of which the item knows."""
        robot, item = self.robots[number], self.items[task.item]
        place = self.building.places[task.place]
        self.log.append(Done(robot.robot.name, task.action, item.item.name, place, begin_s))
        if robot.left_s is None:
            robot.left_s = begin_s if robot.trip is None else robot.trip.leaves_s
        robot.stand_at(task.place, done_s)

    def about_to(self, item: int) -> int | None:
        """The number of a robot that has set out for something with an item."""
        for number, robot in enumerate(self.robots):
            if robot.doing is not None and robot.doing.item == item:
                return number
        return None

    def forget_closed(self) -> None:
        """Forget items with which nothing remains to be done, and the stops that were made."""
        kept = [
            number
            for number, item in enumerate(self.items)
            if item.open or item.state is ItemState.STRANDED or self.about_to(number) is not None
        ]
        number_of = {old: new for new, old in enumerate(kept)}

        def renumbered(task: Task) -> Task:
            return replace(task, item=number_of[task.item])

        self.items = [self.items[number] for number in kept]
        self.routes = [tuple(renumbered(task) for task in route) for route in self.routes]
        for robot in self.robots:
            robot.doing = None if robot.doing is None else renumbered(robot.doing)
        self.moved_by = {
            robot: {number_of[item] for item in items if item in number_of}
            for robot, items in self.moved_by.items()
        }
        self.log.clear()

    def retry(self) -> list[int]:
        """The items that have no place for now, which are to be tried again."""
        waiting = [n for n, item in enumerate(self.items) if item.open and item.put_off]
        for number in waiting:
            self.items[number].put_off = None
        return waiting

    def take_out(self, item: int, *, keep_pickups: bool = False) -> None:
        """Remove an item from all routes; whoever is on its way to it goes there all the same.

        `keep_pickups`: who is on its way to pick it up still does so.
        """
        for number, route in enumerate(self.routes):
            if not any(task.item == item for task in route):
                continue
            robot = self.robots[number]
            held = robot.held and route[0].item == item
            if held and keep_pickups and robot.works and route[0].action is Action.PICK:
                self.routes[number] = (route[0], *without_items([route[1:]], {item})[0])
                continue
            if held:
                robot.let_go()
            self.routes[number] = without_items([route], {item})[0]

    def stay_longer(self) -> dict[str, str]:
        """The robots that cannot be at their ends in time any more, with a sentence each."""
        found = {
            robot.robot.name: robot.stay_longer(self.travel, self.now_s)
            for robot in self.robots
            if robot.works
        }
        # Who has nothing to do and is nowhere to go is not kept by anything.
        busy = {
            robot.robot.name
            for robot, route in zip(self.robots, self.routes, strict=True)
            if route or robot.trip is not None or robot.robot.end is not None
        }
        return {name: why for name, why in found.items() if why is not None and name in busy}

    def changed_since(self, before: Sequence[Route]) -> frozenset[str]:
        """The robots that have other stops than with those routes."""
        return frozenset(
            robot.robot.name
            for robot, now, then in zip(self.robots, self.routes, before, strict=True)
            if _stops(now) != _stops(then)
        )


def _stops(route: Route) -> list[tuple[int, int, bool]]:
    """What is loaded and unloaded where, whoever has a part in it."""
    return [(task.place, task.item, task.action.loads) for task in route]
