"""How robots get from place to place in the kernels: at once, or when doors let them through."""

from math import inf

from mend.fleet.scheduling.alns.problem_arrays import UNREACHABLE, ProblemArrays
from mend.fleet.scheduling.compiled import inlined
from mend.fleet.scheduling.tolerance import DOOR_S


@inlined
def trip(
    problem: ProblemArrays, robot: int, origin: int, destination: int, leaves_s: float
) -> tuple[float, float]:
    """When a robot that may leave then is there at the earliest, and how far it drives (metres)."""
    if problem.epochs.size == 0 or origin == destination:
        lasts_s = problem.time_s[origin, destination] * problem.robots[robot].pace
        return leaves_s + lasts_s, problem.distance_m[origin, destination]
    there_s = far_m = UNREACHABLE
    for epoch in range(problem.epochs.size):
        lasts_s = problem.epoch_time_s[epoch, origin, destination] * problem.robots[robot].pace
        arrival_s = max(leaves_s, problem.epochs[epoch].from_s) + lasts_s
        metres = problem.epoch_distance_m[epoch, origin, destination]
        if arrival_s <= problem.epochs[epoch].until_s + DOOR_S and (
            arrival_s < there_s or (arrival_s == there_s and metres < far_m)
        ):
            there_s, far_m = arrival_s, metres
    return there_s, far_m


@inlined
def arrival(
    problem: ProblemArrays, robot: int, origin: int, destination: int, leaves_s: float
) -> float:
    """When a robot that may leave then is there at the earliest."""
    if problem.epochs.size == 0:
        return leaves_s + problem.time_s[origin, destination] * problem.robots[robot].pace  # type: ignore[no-any-return]
    return trip(problem, robot, origin, destination, leaves_s)[0]


@inlined
def latest_leave(
    problem: ProblemArrays, robot: int, origin: int, destination: int, there_by_s: float
) -> float:
    """By when a robot must leave to be there in time; minus infinity if it never is."""
    if problem.epochs.size == 0 or origin == destination:
        return there_by_s - problem.time_s[origin, destination] * problem.robots[robot].pace  # type: ignore[no-any-return]
    latest_s = -inf
    for epoch in range(problem.epochs.size):
        lasts_s = problem.epoch_time_s[epoch, origin, destination] * problem.robots[robot].pace
        leave_s = min(there_by_s, problem.epochs[epoch].until_s) - lasts_s
        if leave_s >= problem.epochs[epoch].from_s - DOOR_S:
            latest_s = max(latest_s, leave_s)
    return latest_s
