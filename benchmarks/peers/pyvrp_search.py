"""PyVRP's iterated local search."""

import warnings
from collections.abc import Callable
from math import ceil, isfinite

import pyvrp
from peers.scheduling_answer import answer
from peers.whole_numbers import SCALE, WholeNumbers

from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Action, Schedule
from mend.fleet.scheduling.solution import Progress, Solution, UnsupportedError


def solve_by_pyvrp(
    problem: Problem,
    *,
    seconds: float,
    seed: int = 0,
    start: Schedule | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    clock: Callable[[], float],
) -> Solution:
    """A schedule without transfers; not worse than `start`. Raises `UnsupportedError`."""
    began_s = clock()
    data = _data(problem)
    with warnings.catch_warnings():
        # A robot that costs far more than its way is what it warns of; that is wanted here.
        warnings.simplefilter("ignore", pyvrp.exceptions.PenaltyBoundWarning)
        result = pyvrp.solve(data, pyvrp.stop.MaxRuntime(seconds), seed=seed, display=False)
    visits = _visits(problem, result.best) if result.is_feasible() else None
    return answer(problem, visits, clock() - began_s, start, on_progress)


def _data(problem: Problem) -> pyvrp.ProblemData:
    numbers = WholeNumbers(problem, "PyVRP")
    if any(isfinite(item.max_on_board_s) for item in problem.items):
        raise UnsupportedError("PyVRP cannot bound the time on board")
    model = pyvrp.Model()
    locations = [model.add_location(0, 0) for _ in range(numbers.anywhere + 1)]
    speeds = sorted({robot.speed for robot in problem.robots})
    profiles = {speed: model.add_profile() for speed in speeds}
    depots = {
        place: model.add_depot(locations[place])
        for robot in problem.robots
        for place in sorted({robot.start, numbers.end(robot.end)})
    }
    for robot in problem.robots:
        earliest, latest = numbers.window(robot.shift)
        longest = robot.max_duration_s * SCALE + 1e-6
        model.add_vehicle_type(
            capacity=int(min(robot.capacity * SCALE + 1e-6, 2**31)),
            start_depot=depots[robot.start],
            end_depot=depots[numbers.end(robot.end)],
            fixed_cost=round(problem.weights.robots * SCALE),
            tw_early=earliest,
            tw_late=latest,
            shift_duration=int(min(longest, numbers.horizon)),
            profile=profiles[robot.speed],
        )
    for item in problem.items:
        pick, drop = numbers.window(item.pickup.window), numbers.window(item.delivery.window)
        model.add_shipment(
            locations[item.pickup.place],
            locations[item.delivery.place],
            *pick,
            ceil(item.pickup.service_s * SCALE - 1e-6),
            *drop,
            ceil(item.delivery.service_s * SCALE - 1e-6),
            ceil(item.load * SCALE - 1e-6),
        )
    return model.data(missing_value=0).replace(
        distance_matrices=[numbers.cost for _ in speeds],
        duration_matrices=[numbers.time(speed) for speed in speeds],
    )


def _visits(problem: Problem, best: pyvrp.Solution) -> list[list[tuple[int, Action]]]:
    """Every robot is a type of its own, in order."""
    visits: list[list[tuple[int, Action]]] = [[] for _ in problem.robots]
    for route in best.routes():
        for activity in route:
            if activity.is_pickup() or activity.is_delivery():
                action = Action.PICK if activity.is_pickup() else Action.DROP
                visits[route.vehicle_type()].append((activity.idx, action))
    return visits
