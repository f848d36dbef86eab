"""From a plan of the search to routes of the problem, and back."""

from collections.abc import Sequence
from itertools import pairwise

from mend.fleet.scheduling.itinerary import itineraries
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Action, Route, Task
from mend.fleet.scheduling.vlns.arrays import (
    DROP,
    GIVE,
    PICK,
    Plan,
    ProblemArrays,
    empty_plan,
    give_node,
)


def routes_in(problem: ProblemArrays, plan: Plan) -> tuple[Route, ...]:
    """What every robot does in a plan; items in the bank are in no route."""
    return tuple(
        tuple(_task(problem, plan, int(node)) for node in plan.route[robot, :length])
        for robot, length in enumerate(plan.length)
    )


def _task(problem: ProblemArrays, plan: Plan, node: int) -> Task:
    place, item = int(plan.place[node]), int(problem.item[node])
    kind = problem.kind[node]
    if kind == PICK:
        return Task(place, Action.PICK, item)
    if kind == DROP:
        return Task(place, Action.DROP, item)
    action = Action.GIVE if kind == GIVE else Action.TAKE
    return Task(place, action, item, int(plan.robot[node ^ 1]))


def plan_of(problem: ProblemArrays, described: Problem, routes: Sequence[Route]) -> Plan:
    """The plan of complete routes, without its value. Raises `BrokenItineraryError`."""
    plan = empty_plan(problem)
    nodes: dict[tuple[int, int], int] = {}
    items = len(described.items)
    for item, legs in itineraries(described, routes).items():
        first, last = legs[0], legs[-1]
        if first.load is not None:
            nodes[first.robot, first.load] = item
        nodes[last.robot, last.unload] = items + item
        for number, (giving, taking) in enumerate(pairwise(legs)):
            assert taking.load is not None, "only the first leg may begin without a load"
            give = give_node(problem, item, number)
            nodes[giving.robot, giving.unload] = give
            nodes[taking.robot, taking.load] = give + 1
        plan.transfers[item] = len(legs) - 1
    for robot, route in enumerate(routes):
        plan.length[robot] = len(route)
        for at, task in enumerate(route):
            node = nodes[robot, at]
            plan.route[robot, at] = node
            plan.place[node] = task.place
            plan.robot[node] = robot
    return plan
