"""Greedy: whoever can do something soonest does it next; nobody hands anything over."""

from collections.abc import Callable, Iterator
from dataclasses import replace

from mend.fleet.scheduling.cheapest_insertion import insert_items
from mend.fleet.scheduling.checker import require_valid
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.partial_routes import items_in, renumbered, without_items
from mend.fleet.scheduling.problem import Item, Problem
from mend.fleet.scheduling.route_estimate import earliest_end_s
from mend.fleet.scheduling.schedule import Action, Route, Schedule, Task
from mend.fleet.scheduling.solution import Progress, Solution, unproved
from mend.fleet.scheduling.timing import Untimeable, earliest_schedule, service_s, task_window


def solve_by_nearest_next(
    problem: Problem,
    *,
    seconds: float,
    seed: int = 0,  # noqa: ARG001 - every solver takes one; nothing is drawn here
    start: Schedule | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    clock: Callable[[], float],
) -> Solution:
    """Robots go for what they reach first; what is left over is inserted where it costs least.

    Never worse than `start`. `clock` tells seconds; status `UNKNOWN` where an item has no place.
    """
    began_s = clock()
    alone = problem.without_transfers()
    routes, left = _Greedy(alone).routes()
    placed, _ = insert_items(alone, routes, left, lambda: clock() - began_s < seconds)
    best = start
    if placed is not None:
        timed = earliest_schedule(problem, placed)
        if not isinstance(timed, Untimeable):
            require_valid(problem, timed)
            better = start is None or cost(problem, timed).total < cost(problem, start).total
            best = timed if better else start
    solution = unproved(problem, best, clock() - began_s)
    if on_progress is not None and solution.cost is not None:
        on_progress(Progress(solution.cost.total, None, solution.seconds))
    return solution


class _Greedy:
    """Routes as they grow; a robot picks only what it can still deliver with all it has."""

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._routes: list[Route] = [()] * len(problem.robots)
        self._free: list[tuple[int, float]] = [
            (robot.start, robot.shift.earliest_s) for robot in problem.robots
        ]
        self._carried: list[set[int]] = [set() for _ in problem.robots]
        self._waiting = {n for n, item in enumerate(problem.items) if item.aboard is None}
        for number, item in enumerate(problem.items):
            if item.aboard is not None:
                self._carried[item.aboard].add(number)

    def routes(self) -> tuple[tuple[Route, ...], list[int]]:
        """The routes and the items that are in none."""
        while True:
            options = sorted(
                (*self._done(robot, task), robot, task.item, task.action)
                for robot in range(len(self._routes))
                for task in self._tasks(robot)
            )
            for _, _, robot, item, action in options:
                if self._do(robot, self._task(action, item)):
                    break
            else:
                return self._without_carried()

    def _tasks(self, robot: int) -> Iterator[Task]:
        for item in sorted(self._carried[robot]):
            yield self._task(Action.DROP, item)
        for item in sorted(self._waiting):
            yield self._task(Action.PICK, item)

    def _task(self, action: Action, item: int) -> Task:
        visits = self._problem.items[item]
        visit = visits.pickup if action is Action.PICK else visits.delivery
        return Task(visit.place, action, item)

    def _done(self, robot: int, task: Task) -> tuple[float, float]:
        """When the robot would begin, and how far it would drive."""
        place, free_s = self._free[robot]
        speed = self._problem.robots[robot].speed
        arrival_s, distance_m = self._problem.travel.trip(place, task.place, free_s, speed)
        window = task_window(self._problem, task)
        return max(arrival_s, window.earliest_s if window else 0.0), distance_m

    def _do(self, robot: int, task: Task) -> bool:
        """Append the task, if all that is on board then can still be delivered."""
        carried = self._carried[robot] ^ {task.item}
        route = (*self._routes[robot], task)
        if not self._can_deliver(robot, route, carried):
            return False
        begin_s, _ = self._done(robot, task)
        self._routes[robot] = route
        self._carried[robot] = carried
        self._free[robot] = (task.place, begin_s + service_s(self._problem, task))
        self._waiting.discard(task.item)
        return True

    def _can_deliver(self, robot: int, route: Route, carried: set[int]) -> bool:
        """Whether it fits to deliver what is on board by the ends of the windows."""
        items = self._problem.items
        urgent = sorted(carried, key=lambda item: (items[item].delivery.window.latest_s, item))
        drops = tuple(self._task(Action.DROP, item) for item in urgent)
        whole = (*route, *drops)
        ends_s = earliest_end_s(self._problem, robot, whole)
        return ends_s is not None and self._timeable(robot, whole)

    def _timeable(self, robot: int, route: Route) -> bool:
        """Also durations and times on board, which show only in the times of the whole route."""
        problem = self._problem
        items = items_in((route,))
        part = Problem(
            problem.name, problem.places, problem.travel, (problem.robots[robot],),
            tuple(_alone(problem.items[item]) for item in items),
        )  # fmt: skip
        own = renumbered((route,), {item: number for number, item in enumerate(items)})
        return not isinstance(earliest_schedule(part, own), Untimeable)

    def _without_carried(self) -> tuple[tuple[Route, ...], list[int]]:
        """Take out what was never delivered."""
        left = sorted(self._waiting.union(*self._carried))
        return without_items(self._routes, left), left


def _alone(item: Item) -> Item:
    """The item where there is but one robot."""
    return item if item.aboard is None else replace(item, aboard=0)
