"""When one route ends at the earliest, as if its robot never had to wait for another."""

from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Route
from mend.fleet.scheduling.timing import service_s, task_window
from mend.fleet.scheduling.tolerance import CHECK_S, LOAD


def earliest_end_s(problem: Problem, robot: int, route: Route) -> float | None:
    """A lower bound in seconds; None where the route breaks a window, the capacity or the shift
    for certain."""
    described, trip = problem.robots[robot], problem.travel.trip
    load = sum(item.load for item in problem.items if item.aboard == robot)
    place, time_s = described.start, described.shift.earliest_s
    for task in route:
        load += problem.items[task.item].load * (1 if task.action.loads else -1)
        if load > described.capacity + LOAD:
            return None
        time_s = trip(place, task.place, time_s, described.speed).arrival_s
        window = task_window(problem, task)
        if window is not None:
            time_s = max(time_s, window.earliest_s)
            if time_s > window.latest_s + CHECK_S:
                return None
        place, time_s = task.place, time_s + service_s(problem, task)
    if described.end is not None:
        time_s = trip(place, described.end, time_s, described.speed).arrival_s
    return time_s if time_s <= described.shift.latest_s + CHECK_S else None
