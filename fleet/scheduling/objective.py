"""What a schedule costs, recomputed from its stops."""

from dataclasses import dataclass
from itertools import pairwise

from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Action, Schedule


@dataclass(frozen=True, slots=True)
class Cost:
    """The parts of a schedule's cost, and their weighted sum `total`."""

    distance_m: float
    makespan_s: float
    completion_s: float
    lateness_s: float
    robots: int
    total: float


def cost(problem: Problem, schedule: Schedule) -> Cost:
    """The cost of a schedule by the problem's weights."""
    distance_m = sum(route_distance_m(problem, k, schedule) for k in range(len(problem.robots)))
    used = [robot for robot in schedule.robots if robot.used]
    makespan_s = max((robot.ends_s for robot in used), default=0.0)
    completion_s = lateness_s = 0.0
    for robot in schedule.robots:
        for stop in robot.stops:
            item = problem.items[stop.task.item]
            if stop.task.action is Action.DROP:
                completion_s += stop.departure_s
                lateness_s += max(0.0, stop.begin_s - item.delivery.due_s)
            elif stop.task.action is Action.PICK:
                lateness_s += max(0.0, stop.begin_s - item.pickup.due_s)
    weights = problem.weights
    total = (
        weights.distance * distance_m
        + weights.makespan * makespan_s
        + weights.completion * completion_s
        + weights.lateness * lateness_s
        + weights.robots * len(used)
    )
    return Cost(distance_m, makespan_s, completion_s, lateness_s, len(used), total)


def route_distance_m(problem: Problem, robot: int, schedule: Schedule) -> float:
    """How far one robot drives, to its end included (metres)."""
    described, stops = problem.robots[robot], schedule.robots[robot].stops
    places = [described.start, *(stop.task.place for stop in stops)]
    if described.end is not None:
        places.append(described.end)
    if not problem.travel.epochs:
        return float(problem.travel.distance_m[places[:-1], places[1:]].sum())
    leaves_s = (schedule.robots[robot].leaves_s, *(stop.departure_s for stop in stops))
    return sum(
        problem.travel.trip(*trip, time_s, described.speed).distance_m
        for trip, time_s in zip(pairwise(places), leaves_s, strict=False)
    )
