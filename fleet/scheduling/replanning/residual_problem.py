"""What remains to be done, as a problem by itself that every scheduler and the checker know."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from mend.fleet.scheduling.problem import Item, Problem, Transfers, Weights
from mend.fleet.scheduling.replanning.item_state import ItemState, TrackedItem
from mend.fleet.scheduling.replanning.robot_state import TrackedRobot
from mend.fleet.scheduling.schedule import Action, Route, Task
from mend.fleet.scheduling.travel import Travel


@dataclass(frozen=True, slots=True)
class Building:
    """What does not belong to a robot or an item."""

    name: str
    places: tuple[str, ...]
    transfers: Transfers
    weights: Weights


@dataclass(frozen=True, slots=True)
class ResidualProblem:
    """The remaining problem with its routes; `robots` and `items` are the fleet's numbers.

    `held`: by robot, how many of its first tasks are what it does next.
    """

    problem: Problem
    robots: tuple[int, ...]
    items: tuple[int, ...]
    routes: tuple[Route, ...]
    held: tuple[int, ...]

    def fleet_routes(self, routes: Sequence[Route], count: int) -> list[Route]:
        """Routes of the residual problem with the fleet's numbers, for `count` robots."""
        numbered: list[Route] = [()] * count
        for robot, route in zip(self.robots, routes, strict=True):
            numbered[robot] = tuple(self._fleet_task(task) for task in route)
        return numbered

    def _fleet_task(self, task: Task) -> Task:
        partner = None if task.partner is None else self.robots[task.partner]
        return replace(task, item=self.items[task.item], partner=partner)


def residual_problem(
    building: Building,
    travel: Travel,
    robots: Sequence[TrackedRobot],
    items: Sequence[TrackedItem],
    routes: Sequence[Route],
    now_s: float,
) -> ResidualProblem | None:
    """What remains at a time; items that were put off are not in it. None where no robot works."""
    working = tuple(number for number, robot in enumerate(robots) if robot.works)
    if not working:
        return None
    planned = tuple(n for n, item in enumerate(items) if item.open and item.put_off is None)
    robot_number = {fleet: number for number, fleet in enumerate(working)}
    item_number = {fleet: number for number, fleet in enumerate(planned)}
    stuck = [0.0] * len(robots)
    for item in items:
        stays = item.put_off is not None or item.state is ItemState.STRANDED
        if stays and item.robot is not None:
            stuck[item.robot] += item.item.load

    def residual_task(robot: int, task: Task) -> Task:
        number = item_number[task.item]
        if task.action is Action.TAKE and is_given(routes, robot, task):
            return Task(task.place, Action.PICK, number)
        partner = None if task.partner is None else robot_number[task.partner]
        return replace(task, item=number, partner=partner)

    problem = Problem(
        building.name,
        building.places,
        travel,
        tuple(robots[k].residual(travel, now_s, stuck[k]) for k in working),
        tuple(
            _residual_item(items[n], robot_number, building.transfers.service_s) for n in planned
        ),
        building.transfers,
        building.weights,
    )
    return ResidualProblem(
        problem,
        working,
        planned,
        tuple(tuple(residual_task(k, task) for task in routes[k]) for k in working),
        tuple(1 if robots[k].held and routes[k] else 0 for k in working),
    )


def is_given(routes: Sequence[Route], robot: int, take: Task) -> bool:
    """Whether what a robot is to take lies there already: nobody is still to give it."""
    assert take.partner is not None, "a take has a partner"
    return not any(
        task.action is Action.GIVE and task.item == take.item and task.partner == robot
        for task in routes[take.partner]
    )


def _residual_item(item: TrackedItem, robot_number: dict[int, int], handling_s: float) -> Item:
    robot = None if item.robot is None else robot_number[item.robot]
    return item.residual(robot, handling_s)
