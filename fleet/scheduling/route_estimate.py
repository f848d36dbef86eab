"""What one route costs by itself, as if its robot never had to wait for another."""

from typing import NamedTuple

from mend.fleet.scheduling.problem import Problem, Visit
from mend.fleet.scheduling.schedule import Action, Route
from mend.fleet.scheduling.timing import service_s
from mend.fleet.scheduling.tolerance import CHECK_S, LOAD


class RouteEstimate(NamedTuple):
    """Lower bounds on a route's times; its distance where doors do not change it."""

    distance_m: float
    ends_s: float
    completion_s: float
    lateness_s: float


def estimate(problem: Problem, robot: int, route: Route) -> RouteEstimate | None:
    """The estimate; None where the route breaks a window, the capacity or the shift for certain."""
    described, trip = problem.robots[robot], problem.travel.trip
    load = sum(item.load for item in problem.items if item.aboard == robot)
    place, time_s = described.start, described.shift.earliest_s
    distance_m = completion_s = lateness_s = 0.0
    for task in route:
        load += problem.items[task.item].load * (1 if task.action.loads else -1)
        arrived = trip(place, task.place, time_s, described.speed)
        distance_m += arrived.distance_m
        place, time_s = task.place, arrived.arrival_s
        visit = _visit(problem, task.action, task.item)
        if visit is not None:
            time_s = max(time_s, visit.window.earliest_s)
            lateness_s += max(0.0, time_s - visit.due_s)
            if time_s > visit.window.latest_s + CHECK_S:
                return None
        time_s += service_s(problem, task)
        completion_s += time_s if task.action is Action.DROP else 0.0
        if load > described.capacity + LOAD:
            return None
    if described.end is not None:
        time_s, homeward_m = trip(place, described.end, time_s, described.speed)
        distance_m += homeward_m
    if not time_s <= described.shift.latest_s + CHECK_S:
        return None
    return RouteEstimate(distance_m, time_s, completion_s, lateness_s)


def _visit(problem: Problem, action: Action, item: int) -> Visit | None:
    if action is Action.PICK:
        return problem.items[item].pickup
    return problem.items[item].delivery if action is Action.DROP else None
