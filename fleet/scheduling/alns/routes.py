"""From a plan of the search to routes of the problem, and back."""

from collections import Counter, defaultdict
from collections.abc import Sequence
from itertools import chain, pairwise

from mend.fleet.scheduling.alns.plan import Plan, empty_plan
from mend.fleet.scheduling.alns.problem_arrays import (
    DROP,
    GIVE,
    NOBODY,
    PICK,
    ProblemArrays,
    give_node,
)
from mend.fleet.scheduling.itinerary import itineraries
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Action, Route, Task

CHAIN = 3
"""The most transfers of one item, unless routes have more already."""


def longest_chain(routes: Sequence[Route]) -> int:
    """How often one item may change robots in a search that begins with these routes."""
    given = Counter(task.item for task in chain.from_iterable(routes) if task.action is Action.GIVE)
    return max((CHAIN, *given.values()))


def routes_in(problem: ProblemArrays, plan: Plan) -> tuple[Route, ...]:
    """What every robot does in a plan; items in the bank are in no route, but if they are begun."""
    return tuple(
        tuple(
            _task(problem, plan, int(node))
            for node in plan.stops.node[row, 1 : plan.rows[row].length - 1]
        )
        for row in range(problem.robots.size)
    )


def _task(problem: ProblemArrays, plan: Plan, node: int) -> Task:
    place, item = int(plan.tasks[node].place), int(problem.nodes[node].item_of)
    kind = problem.nodes[node].kind
    if kind == PICK:
        return Task(place, Action.PICK, item)
    if kind == DROP:
        return Task(place, Action.DROP, item)
    action = Action.GIVE if kind == GIVE else Action.TAKE
    return Task(place, action, item, int(plan.tasks[node ^ 1].row))


def plan_of(problem: ProblemArrays, described: Problem, routes: Sequence[Route]) -> Plan:
    """The plan of routes, whose times are not known. Items that the routes only begin with are in
    the bank. Raises `BrokenItineraryError`."""
    plan = empty_plan(problem)
    nodes: dict[tuple[int, int], int] = {}
    count = len(described.items)
    actions: dict[int, list[Action]] = defaultdict(list)
    for task in chain.from_iterable(routes):
        actions[task.item].append(task.action)
    whole = [
        item
        for item, done in actions.items()
        if problem.items[item].carrier == NOBODY or done != [Action.PICK]
    ]
    for item, legs in itineraries(described, routes, whole).items():
        first, last = legs[0], legs[-1]
        if first.load is not None:
            nodes[first.robot, first.load] = item
        nodes[last.robot, last.unload] = count + item
        for number, (giving, taking) in enumerate(pairwise(legs)):
            assert taking.load is not None, "only the first leg may begin without a load"
            give = give_node(problem, item, number)
            nodes[giving.robot, giving.unload] = give
            nodes[taking.robot, taking.load] = give + 1
        plan.transfers[item] = len(legs) - 1
        plan.handed[0] += len(legs) - 1
    for robot, route in enumerate(routes):
        plan.stops[robot, len(route) + 1].node = plan.stops[robot, 1].node
        plan.rows[robot].length = len(route) + 2
        for at, task in enumerate(route):
            node = nodes.get((robot, at), task.item)
            plan.stops[robot, at + 1].node = node
            plan.tasks[node].place = task.place
            plan.tasks[node].row = robot
    return plan
