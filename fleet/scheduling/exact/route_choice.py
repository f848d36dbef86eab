"""Routes as part of the constraint model: every robot has one of those that are possible at all."""

from collections import defaultdict
from itertools import pairwise

from ortools.sat.python import cp_model

from mend.fleet.scheduling.exact.model import ExactModel, RobotVariables
from mend.fleet.scheduling.exact.nodes import NodeKind
from mend.fleet.scheduling.exact.route_bound import RobotRoute

Choices = dict[tuple[int, int], list[cp_model.IntVar]]


def choose_routes(exact: ExactModel, routes: list[list[RobotRoute]]) -> None:
    """Let every robot have one of its routes, with the arcs, gives and takes that are in it."""
    for number, (robot, possible) in enumerate(zip(exact.robots, routes, strict=True)):
        _choose(exact, robot, number, possible)


def _choose(
    exact: ExactModel, robot: RobotVariables, number: int, routes: list[RobotRoute]
) -> None:
    model = exact.model
    along: Choices = defaultdict(list)
    gives: Choices = defaultdict(list)
    takes: Choices = defaultdict(list)
    items = range(len(exact.problem.items))
    at = _model_nodes(exact, robot)
    chosen = [model.new_bool_var(f"r{number} route {each}") for each in range(len(routes))]
    for choice, route in zip(chosen, routes, strict=True):
        nodes = [at[node] for node in route.nodes]
        for arc in pairwise([0, *nodes, 1]):
            along[arc].append(choice)
        for node, given, taken in zip(nodes, route.gives, route.takes, strict=True):
            for item in items:
                if (given >> item) & 1:
                    gives[node, item].append(choice)
                elif (taken >> item) & 1:
                    takes[node, item].append(choice)
    model.add_exactly_one(chosen)
    for variables, choices in ((robot.arcs, along), (robot.gives, gives), (robot.takes, takes)):
        for key, variable in variables.items():
            model.add(variable == sum(choices[key]))


def _model_nodes(exact: ExactModel, robot: RobotVariables) -> dict[int, int]:
    """The model's numbers of a route's nodes: pickups, deliveries, transfer places."""
    items, places = len(exact.problem.items), len(exact.problem.transfers.places)
    first = len(robot.nodes) - places
    numbers = {2 * items + place: first + place for place in range(places)}
    for number, node in enumerate(robot.nodes):
        if node.item is not None:
            before = items if node.kind is NodeKind.DROP else 0
            numbers[before + node.item] = number
    return numbers
