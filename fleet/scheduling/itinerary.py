"""The itinerary of an item through the routes: which robot carries it from where to where."""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Action, Route, Task


class BrokenItineraryError(Exception):
    """The routes do not bring the item from its pickup to its delivery; says where it breaks."""


@dataclass(frozen=True, slots=True)
class ItineraryLeg:
    """A robot carries the item from its task number `load` to its task number `unload`.

    `load` is None where the robot had the item from the beginning.
    """

    robot: int
    load: int | None
    unload: int


def itinerary_of(problem: Problem, routes: Sequence[Route], item: int) -> tuple[ItineraryLeg, ...]:
    """The legs of an item that is delivered, in order. Raises `BrokenItineraryError`."""
    return itineraries(problem, routes, (item,))[item]


def itineraries(
    problem: Problem, routes: Sequence[Route], items: Sequence[int] | None = None
) -> dict[int, tuple[ItineraryLeg, ...]]:
    """The itineraries of all items, or of some. Raises `BrokenItineraryError`."""
    wanted = range(len(problem.items)) if items is None else items
    tasks: dict[int, list[tuple[int, int, Task]]] = defaultdict(list)
    for robot, route in enumerate(routes):
        for index, task in enumerate(route):
            tasks[task.item].append((robot, index, task))
    return {item: _Walk(problem, item, tasks[item]).legs() for item in wanted}


class _Walk:
    """Walks along one item's tasks; each may be used once."""

    def __init__(self, problem: Problem, item: int, tasks: list[tuple[int, int, Task]]) -> None:
        self._problem = problem
        self._item = item
        self._left: dict[int, list[tuple[int, Task]]] = defaultdict(list)
        for robot, index, task in tasks:
            self._left[robot].append((index, task))

    def legs(self) -> tuple[ItineraryLeg, ...]:
        robot, load = self._beginning()
        legs: list[ItineraryLeg] = []
        while True:
            unload, task = self._next(robot, after=-1 if load is None else load)
            legs.append(ItineraryLeg(robot, load, unload))
            if task.action is Action.DROP:
                break
            robot, load = self._taker(robot, task)
        left = [task for tasks in self._left.values() for _, task in tasks]
        if left:
            raise self._broken(f"there is still a {left[0].action} after its delivery")
        return tuple(legs)

    def _beginning(self) -> tuple[int, int | None]:
        aboard = self._problem.items[self._item].aboard
        if aboard is not None:
            return aboard, None
        picks = [
            (robot, index)
            for robot, tasks in self._left.items()
            for index, task in tasks
            if task.action is Action.PICK
        ]
        if len(picks) != 1:
            raise self._broken(f"it is picked up {len(picks)} times")
        robot, index = picks[0]
        taken = self._left[robot].pop(0)
        if taken[0] != index:
            raise self._broken(f"{self._name(robot)} has a {taken[1].action} of it before its pick")
        return robot, index

    def _next(self, robot: int, after: int) -> tuple[int, Task]:
        tasks = self._left[robot]
        if not tasks or tasks[0][0] <= after:
            raise self._broken(f"{self._name(robot)} never gives or drops it")
        index, task = tasks.pop(0)
        if task.action.loads:
            raise self._broken(f"{self._name(robot)} has it already when it is to {task.action} it")
        return index, task

    def _taker(self, giver: int, give: Task) -> tuple[int, int]:
        taker = give.partner
        if taker is None or not 0 <= taker < len(self._problem.robots):
            raise self._broken(f"{self._name(giver)} gives it to nobody")
        if taker == giver:
            raise self._broken(f"{self._name(giver)} gives it to itself")
        tasks = self._left[taker]
        if not tasks or tasks[0][1].action is not Action.TAKE:
            raise self._broken(f"{self._name(taker)} does not take it from {self._name(giver)}")
        index, take = tasks.pop(0)
        if take.partner != giver or take.place != give.place:
            raise self._broken(
                f"{self._name(giver)} gives it at {self._problem.places[give.place]}, but "
                f"{self._name(taker)} takes it elsewhere or from somebody else"
            )
        return taker, index

    def _name(self, robot: int) -> str:
        return self._problem.robots[robot].name

    def _broken(self, why: str) -> BrokenItineraryError:
        return BrokenItineraryError(f"item '{self._problem.items[self._item].name}': {why}")
