"""A building with two floors and three robots for tests of a fleet at work."""

from random import Random

from office_building import BuildingPlan, building_deliveries

from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.problem_file import navigation_graph, problem_of
from mend.fleet.scheduling.replanning.open_ways import OpenWays
from mend.fleet.scheduling.replanning.running_fleet import RunningFleet
from mend.maps.navigation import NavigationGraph

PLAN = BuildingPlan(floors=2, offices=6, robots=3, items=2, shift_s=2400.0)


def small_building() -> tuple[Problem, NavigationGraph]:
    """The problem with all places of the building, and its graph."""
    document = building_deliveries(PLAN, Random(5))
    assert document.travel.graph is not None
    return problem_of(document, whole=True), navigation_graph(document.travel.graph)


def fleet_in_building() -> tuple[RunningFleet, NavigationGraph]:
    """Its robots at work, with two items planned."""
    problem, graph = small_building()
    return RunningFleet(problem, ways=OpenWays(graph, 1.0)), graph
