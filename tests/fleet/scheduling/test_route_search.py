"""The optimum by way of routes: against constraints alone, and what the bound leaves."""

import random
from dataclasses import replace
from math import inf

import numpy as np
import pytest
from benchmark_instances import DATA
from delivery_problems import corridor, drawn_problem, parcel
from even_clock import EvenClock
from sampled import sample

from mend.fleet.scheduling.exact.constraint_search import Effort, search
from mend.fleet.scheduling.exact.model import Rounding
from mend.fleet.scheduling.exact.robot_states import MOST_ITEMS
from mend.fleet.scheduling.exact.route_bound import RouteBound, route_bound
from mend.fleet.scheduling.exact.route_costs import add_step
from mend.fleet.scheduling.exact.route_search import solve_by_routes
from mend.fleet.scheduling.instances.transfer_benchmark import read_transfer_benchmark
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Weights, Window
from mend.fleet.scheduling.schedule import Action
from mend.fleet.scheduling.solution import Progress, Status

EFFORT = Effort(600.0, 1, 2)
"""More than it ever takes, on however busy a machine."""


def drawn_with_distances(seed: int) -> Problem:
    """Windows, loads, ends, shifts and durations differ by seed; only distance and robots cost."""
    problem, rng = drawn_problem(seed), random.Random(seed)
    robots = tuple(
        replace(
            robot,
            capacity=float(rng.randint(1, 4)),
            max_duration_s=rng.choice((inf, inf, 150.0)),
            shift=Window(float(rng.randint(0, 20)), float(rng.randint(60, 300))),
        )
        for robot in problem.robots
    )
    weights = rng.choice((Weights(lateness=0.0), Weights(2.0, lateness=0.0, robots=15.0)))
    return replace(problem, robots=robots, weights=weights)


def proved_bound(problem: Problem) -> RouteBound:
    found = route_bound(problem)
    assert found is not None
    found.prove(60.0, EvenClock())
    return found


@pytest.mark.slow
@pytest.mark.parametrize("seed", sample((1, 2, 3, 4, 5, 6, 8, 10), range(16)))
def test_optimum_is_that_of_constraints_alone(seed: int) -> None:
    problem = drawn_with_distances(seed)
    alone = search(problem, Rounding.UP, EFFORT)
    routed = solve_by_routes(problem, EFFORT, None, EvenClock())
    assert routed.status is alone.status
    if alone.cost is not None:
        assert routed.cost is not None
        assert routed.cost.total == pytest.approx(alone.cost.total, abs=0.01)
        assert proved_bound(problem).bound <= alone.cost.total + 0.01


def test_routes_of_the_optimum_are_among_those_up_to_its_cost() -> None:
    items = (parcel("there"), parcel("back", 4, 0), parcel("on", 1, 3))
    shifts = (Robot("left", 0, 0, 2.0, Window(0.0, 90.0)), Robot("right", 4, 4, 2.0))
    problem = corridor(items=items, robots=shifts)
    best = search(problem, Rounding.UP, EFFORT)
    assert best.cost is not None
    assert best.schedule is not None
    possible = proved_bound(problem).routes(best.cost.total, 1000)
    assert possible is not None
    for route, choices in zip(best.schedule.routes, possible, strict=True):
        picked = [task.item for task in route if task.action is Action.PICK]
        assert any([node for node in each.nodes if node < 3] == picked for each in choices)


def test_bound_of_one_robot_with_one_item_is_the_optimum() -> None:
    robots = (Robot("only", 2, 2, 1.0),)
    problem = corridor(items=(parcel(),), robots=robots, transfers=Transfers())
    assert proved_bound(problem).bound == pytest.approx(80.0, rel=1e-4)


def test_higher_ceilings_allow_more_routes() -> None:
    bound = proved_bound(corridor(items=(parcel(), parcel("other", 3, 1))))
    few, many = bound.routes(bound.bound, 10_000), bound.routes(bound.bound + 60.0, 10_000)
    assert few is not None
    assert many is not None
    assert sum(map(len, few)) < sum(map(len, many))
    assert bound.routes(bound.bound + 60.0, sum(map(len, many)) - 1) is None


def test_what_nobody_can_reach_in_time_is_proved_infeasible() -> None:
    late = Item("late", 1.0, Visit(0), Visit(4, Window(0.0, 30.0)))
    problem = corridor(items=(late,))
    assert proved_bound(problem).bound == inf
    assert solve_by_routes(problem, EFFORT, None, EvenClock()).status is Status.INFEASIBLE


def test_robots_that_would_have_to_wait_too_long_for_each_other_are_proved_infeasible() -> None:
    """Each has a route in time, but what one takes the other does not have yet."""
    robots = (
        Robot("left", 0, None, 1.0, Window(0.0, 50.0)),
        Robot("right", 4, 4, 1.0, Window(0.0, 55.0)),
    )
    first = Item("first", 1.0, Visit(1, Window(0.0, 10.0)), Visit(0, Window(0.0, 20.0)))
    problem = corridor(items=(parcel(), first), robots=robots)
    bound = proved_bound(problem)
    assert bound.bound < inf
    assert solve_by_routes(problem, EFFORT, None, EvenClock()).status is Status.INFEASIBLE


@pytest.mark.parametrize(
    "weights",
    [Weights(makespan=1.0), Weights(completion=1.0)],
    ids=["makespan", "completion"],
)
def test_what_times_cost_is_left_to_constraints(weights: Weights) -> None:
    problem = replace(corridor(items=(parcel(),)), weights=weights)
    assert route_bound(problem) is None
    found = solve_by_routes(problem, EFFORT, None, EvenClock())
    assert (found.status, found.bound) == (Status.UNKNOWN, None)


def test_lateness_counts_only_where_something_is_due() -> None:
    problem = corridor(items=(parcel(),))
    assert route_bound(problem) is not None
    due = Item("due", 1.0, Visit(0), Visit(4, due_s=10.0))
    assert route_bound(replace(problem, items=(due,))) is None


def test_too_many_items_are_left_to_constraints() -> None:
    many = tuple(parcel(f"parcel {number}") for number in range(MOST_ITEMS + 1))
    assert route_bound(corridor(items=many)) is None


def test_no_bound_below_that_from_routes_is_told() -> None:
    problem = corridor(items=(parcel(), parcel("back", 4, 0)))
    told: list[Progress] = []
    effort = replace(EFFORT, on_progress=told.append)
    solve_by_routes(problem, effort, None, EvenClock())
    bounds = [each.bound for each in told if each.bound is not None]
    assert len(bounds) > 1
    assert min(bounds) == bounds[0]


def test_staircase_keeps_what_is_later_or_cheaper_than_all_others() -> None:
    by_s, cost = np.empty(8), np.empty(8)
    count = 0
    for step in ((10.0, 5.0), (20.0, 9.0), (15.0, 9.5), (12.0, 5.0), (30.0, 1.0)):
        before = count
        count = add_step(by_s, cost, count, *step)
        assert count <= before + 1
    assert list(zip(by_s[:count], cost[:count], strict=True)) == [(30.0, 1.0)]


@pytest.mark.slow
@pytest.mark.skipif(not DATA.is_dir(), reason="the folder of benchmark instances is not here")
@pytest.mark.parametrize(
    ("name", "optimum"),
    [*sample([], [("5R-4K-4T-240M-1", 512.570)]), ("5R-4K-4T-300L-3", 500.621)],
)
def test_five_items_are_settled_by_routes_alone(name: str, optimum: float) -> None:
    (path,) = DATA.glob(f"*/{name}.txt")
    problem = read_transfer_benchmark(path.read_text(), name)
    effort = replace(EFFORT, seconds=120.0)
    bound = proved_bound(problem)
    assert 0.85 * optimum < bound.bound < optimum
    possible = bound.routes(optimum + 0.01, 20_000)
    assert possible is not None
    found = search(problem, Rounding.UP, effort, routes=possible)
    assert found.status is Status.OPTIMAL
    assert found.cost is not None
    assert found.cost.total == pytest.approx(optimum, abs=0.01)


def test_time_limit_of_the_bound_leaves_what_is_proved_until_then() -> None:
    problem = corridor(items=(parcel(), parcel("back", 4, 0), parcel("on", 1, 3)))
    hurried = route_bound(problem)
    assert hurried is not None
    hurried.prove(0.0, EvenClock())
    assert hurried.bound <= proved_bound(problem).bound + 1e-6
