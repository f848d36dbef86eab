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
    TAKE,
    ProblemArrays,
    give_node,
)
from mend.fleet.scheduling.itinerary import itineraries
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Action, Route, Task

CHAIN = 3
"""The most transfers of one item, unless routes have more already."""
ACTIONS = {PICK: Action.PICK, DROP: Action.DROP, GIVE: Action.GIVE, TAKE: Action.TAKE}


def longest_chain(routes: Sequence[Route]) -> int:
    """How often one item may change robots in a search that begins with these routes."""
    given = Counter(task.item for task in chain.from_iterable(routes) if task.action is Action.GIVE)
    return max((CHAIN, *given.values()))


def routes_in(problem: ProblemArrays, plan: Plan) -> tuple[Route, ...]:
    """What every robot does in a plan; items in the bank are in no route, but if they are begun."""
    return tuple(_route(problem, plan, row) for row in range(problem.robots.size))


def _route(problem: ProblemArrays, plan: Plan, row: int) -> Route:
    nodes = plan.stops.node[row, 1 : plan.rows.length[row] - 1]
    # Column by column, as to read a record takes as long as to read a column.
    columns = (
        plan.tasks.place[nodes],
        problem.nodes.kind[nodes],
        problem.nodes.item_of[nodes],
        plan.tasks.row[nodes ^ 1],
    )
    return tuple(
        Task(place, ACTIONS[kind], item, partner if kind in (GIVE, TAKE) else None)
        for place, kind, item, partner in zip(*(each.tolist() for each in columns), strict=True)
    )


def plan_of(problem: ProblemArrays, described: Problem, routes: Sequence[Route]) -> Plan:
    """The plan of routes, whose times are not known. Items that the routes only begin with are in
    the bank. Raises `BrokenItineraryError`."""
    plan = empty_plan(problem)
    nodes: dict[tuple[int, int], int] = {}
    count, carrier = len(described.items), problem.items.carrier.tolist()
    actions: dict[int, list[Action]] = defaultdict(list)
    for task in chain.from_iterable(routes):
        actions[task.item].append(task.action)
    whole = [
        item for item, done in actions.items() if carrier[item] == NOBODY or done != [Action.PICK]
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
        length = len(route)
        done = [nodes.get((robot, at), task.item) for at, task in enumerate(route)]
        plan.stops.node[robot, length + 1] = plan.stops.node[robot, 1]
        plan.stops.node[robot, 1 : length + 1] = done
        plan.rows.length[robot] = length + 2
        plan.tasks.place[done] = [task.place for task in route]
        plan.tasks.row[done] = robot
    return plan
