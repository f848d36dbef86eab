"""How robots get from place to place in the kernels: at once, or when doors let them through."""

from math import inf

from mend.fleet.scheduling.alns.problem_arrays import UNREACHABLE, ProblemArrays
from mend.fleet.scheduling.compiled import compiled
from mend.fleet.scheduling.tolerance import DOOR_S


@compiled
def trip(
    problem: ProblemArrays, robot: int, origin: int, destination: int, leaves_s: float
) -> tuple[float, float]:
    """When a robot that may leave then is there at the earliest, and how far it drives (metres)."""
    if problem.epoch_from_s.size == 0 or origin == destination:
        lasts_s = problem.time_s[origin, destination] * problem.pace[robot]
        return leaves_s + lasts_s, problem.distance_m[origin, destination]
    there_s = far_m = UNREACHABLE
    for epoch in range(problem.epoch_from_s.size):
        lasts_s = problem.epoch_time_s[epoch, origin, destination] * problem.pace[robot]
        arrival_s = max(leaves_s, problem.epoch_from_s[epoch]) + lasts_s
        metres = problem.epoch_distance_m[epoch, origin, destination]
        if arrival_s <= problem.epoch_until_s[epoch] + DOOR_S and (
            arrival_s < there_s or (arrival_s == there_s and metres < far_m)
        ):
            there_s, far_m = arrival_s, metres
    return there_s, far_m


@compiled
def arrival(
    problem: ProblemArrays, robot: int, origin: int, destination: int, leaves_s: float
) -> float:
    """When a robot that may leave then is there at the earliest."""
    if problem.epoch_from_s.size == 0:
        return leaves_s + problem.time_s[origin, destination] * problem.pace[robot]  # type: ignore[no-any-return]
    return trip(problem, robot, origin, destination, leaves_s)[0]


@compiled
def latest_leave(
    problem: ProblemArrays, robot: int, origin: int, destination: int, there_by_s: float
) -> float:
    """By when a robot must leave to be there in time; minus infinity if it never is."""
    if problem.epoch_from_s.size == 0 or origin == destination:
        return there_by_s - problem.time_s[origin, destination] * problem.pace[robot]  # type: ignore[no-any-return]
    latest_s = -inf
    for epoch in range(problem.epoch_from_s.size):
        lasts_s = problem.epoch_time_s[epoch, origin, destination] * problem.pace[robot]
        leave_s = min(there_by_s, problem.epoch_until_s[epoch]) - lasts_s
        if leave_s >= problem.epoch_from_s[epoch] - DOOR_S:
            latest_s = max(latest_s, leave_s)
    return latest_s
