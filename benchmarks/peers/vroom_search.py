"""VROOM's heuristics and local search."""

from collections.abc import Callable
from datetime import timedelta
from math import ceil, isfinite

import numpy as np
import vroom
from peers.scheduling_answer import answer
from peers.whole_numbers import SCALE, WholeNumbers

from mend.fleet.scheduling.problem import Problem, Visit
from mend.fleet.scheduling.schedule import Action, Schedule
from mend.fleet.scheduling.solution import Progress, Solution, UnsupportedError

EXPLORATION = 5
"""The most thorough search that it has."""


def solve_by_vroom(
    problem: Problem,
    *,
    seconds: float,
    seed: int = 0,  # noqa: ARG001 - every solver takes one; this one draws nothing
    start: Schedule | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    clock: Callable[[], float],
) -> Solution:
    """A schedule without transfers; not worse than `start`. Raises `UnsupportedError`."""
    began_s = clock()
    given = _input(problem)
    found = given.solve(EXPLORATION, nb_threads=1, timeout=timedelta(seconds=seconds))
    visits: list[list[tuple[int, Action]]] = [[] for _ in problem.robots]
    kinds = {"pickup": Action.PICK, "delivery": Action.DROP}
    for route in found.to_dict()["routes"]:
        visits[route["vehicle"]] = [
            (step["id"], kinds[step["type"]]) for step in route["steps"] if step["type"] in kinds
        ]
    return answer(problem, visits, clock() - began_s, start, on_progress)


def _input(problem: Problem) -> vroom.Input:
    numbers = WholeNumbers(problem, "VROOM")
    if any(isfinite(item.max_on_board_s) for item in problem.items):
        raise UnsupportedError("VROOM cannot bound the time on board")
    if any(isfinite(robot.max_duration_s) for robot in problem.robots):
        raise UnsupportedError("VROOM cannot bound how long a robot is away")
    given = vroom.Input()
    for speed in {robot.speed for robot in problem.robots}:
        given.set_durations_matrix(f"speed {speed}", numbers.time(speed).astype(np.uint32))
        given.set_costs_matrix(f"speed {speed}", numbers.cost.astype(np.uint32))
    for number, robot in enumerate(problem.robots):
        given.add_vehicle(
            vroom.Vehicle(
                number,
                start=robot.start,
                end=robot.end,
                profile=f"speed {robot.speed}",
                capacity=[int(min(robot.capacity * SCALE + 1e-6, 2**31))],
                time_window=vroom.TimeWindow(*numbers.window(robot.shift)),
                costs=vroom.VehicleCosts(fixed=round(problem.weights.robots * SCALE)),
            )
        )
    for number, item in enumerate(problem.items):
        given.add_shipment(
            _step(numbers, number, item.pickup),
            _step(numbers, number, item.delivery),
            amount=vroom.Amount([ceil(item.load * SCALE - 1e-6)]),
        )
    return given


def _step(numbers: WholeNumbers, number: int, visit: Visit) -> vroom.ShipmentStep:
    return vroom.ShipmentStep(
        number,
        visit.place,
        default_service=ceil(visit.service_s * SCALE - 1e-6),
        time_windows=[vroom.TimeWindow(*numbers.window(visit.window))],
    )
