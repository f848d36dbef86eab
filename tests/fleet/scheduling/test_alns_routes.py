"""The search without transfers: against the exact solver and plain Python; its promises."""

import csv
import random
import time
from dataclasses import replace
from itertools import product
from math import inf

import numpy as np
import pytest
from benchmark_instances import DATA
from delivery_problems import HANDED_OVER, corridor, corridor_items, parcel
from even_clock import EvenClock
from hypothesis import given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.fleet.scheduling.alns.itineraries import Allowed, find_itineraries, follow, unroll
from mend.fleet.scheduling.alns.problem_arrays import problem_arrays
from mend.fleet.scheduling.alns.propagation import update
from mend.fleet.scheduling.alns.routes import routes_in
from mend.fleet.scheduling.alns.solve import solve_alns
from mend.fleet.scheduling.alns.state import state_for
from mend.fleet.scheduling.checker import check
from mend.fleet.scheduling.exact.solve import solve_exactly
from mend.fleet.scheduling.instances.li_lim import read_li_lim
from mend.fleet.scheduling.methods import solve, suited_method
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Weights, Window
from mend.fleet.scheduling.rng import rng_from
from mend.fleet.scheduling.schedule import Action, Route, Schedule, Task
from mend.fleet.scheduling.solution import Progress, Solution, Status
from mend.fleet.scheduling.timing import earliest_schedule
from mend.fleet.scheduling.travel import Travel


def drawn_problem(seed: int, items: int = 4, spare_s: float = 0.0) -> Problem:
    """Items in a field with windows; robots that differ in speed, capacity, shift and end.

    `spare_s`: how much later everything may be than where hardly all is possible.
    """
    rng = random.Random(seed)
    points = tuple((rng.uniform(0, 50), rng.uniform(0, 50)) for _ in range(8))

    def visit() -> Visit:
        begin_s = rng.randint(0, 100)
        window = Window(float(begin_s), begin_s + rng.randint(60, 200) + spare_s)
        return Visit(rng.randrange(8), window, service_s=float(rng.randint(0, 5)))

    drawn = tuple(Item(f"item{n}", float(rng.randint(1, 2)), visit(), visit())
                  for n in range(items))  # fmt: skip
    robots = tuple(
        Robot(f"robot{n}", 0, rng.choice((0, 0, None)), float(rng.randint(2, 4)),
              Window(0.0, rng.randint(250, 400) + spare_s), speed=rng.choice((1.0, 2.0)))
        for n in range(3)
    )  # fmt: skip
    weights = Weights(rng.choice((1.0, 0.5)), robots=rng.choice((0.0, 20.0, 1000.0)))
    names = tuple(f"p{n}" for n in range(8))
    return Problem("drawn", names, Travel.euclidean(points), robots, drawn, weights=weights)


def solved(problem: Problem, seconds: float = 6.0, **options: object) -> Solution:
    """A search that does the same work in every run."""
    return solve_alns(problem, seconds=seconds, clock=EvenClock(), **options)  # type: ignore[arg-type]


@pytest.mark.slow(2)
@pytest.mark.parametrize("seed", sample((1, 4, 7, 8, 11), range(16)))
def test_search_finds_what_the_exact_solver_proves(seed: int) -> None:
    problem = drawn_problem(seed)
    exact = solve_exactly(problem, seconds=600.0, clock=time.perf_counter)
    if exact.status is Status.INFEASIBLE:
        # It gives up at the end of its time only: more of that would find as little.
        assert solved(problem, seconds=6.0).status is Status.UNKNOWN
        return
    found = solved(problem, seconds=30.0)
    assert exact.status is Status.OPTIMAL
    assert exact.cost is not None
    assert found.cost is not None
    # Times are rounded up in the exact solver, and its distances to thousandths.
    assert found.cost.total <= exact.cost.total + 0.05


@pytest.mark.slow(2)
@given(
    items=corridor_items(),
    seed=st.integers(0, 99),
    weight=st.sampled_from((0.0, 5.0, 1e6)),
    transfers=st.booleans(),
)
@settings(deadline=None, max_examples=sample(12, 80))
def test_schedule_found_passes_the_checker(
    items: tuple[Item, ...], seed: int, weight: float, transfers: bool
) -> None:
    problem = replace(corridor(items=items), weights=Weights(robots=weight))
    found = solved(problem, seconds=1.0, seed=seed, transfers=transfers)
    if found.schedule is None:
        assert found.status is Status.UNKNOWN
        return
    assert check(problem, found.schedule) == []
    assert transfers or found.schedule.transfers == 0
    assert found.cost == cost(problem, found.schedule)


@pytest.mark.parametrize("seed", range(6))
def test_place_found_is_the_cheapest_that_the_checker_allows(seed: int) -> None:
    problem = drawn_problem(seed, items=5)
    arrays, rng = problem_arrays(problem, 1), rng_from(np.random.default_rng(seed))
    state = state_for(arrays)
    plan, found = state.trial, state.found
    for item in range(5):
        expected = cheapest_by_trying(problem, routes_in(arrays, plan), item)
        find_itineraries(arrays, plan, found, rng, item, Allowed(0, False, 0.0))
        cheapest = float(found.extra[0]) if found.known[0] else inf
        assert cheapest == pytest.approx(expected, abs=1e-6)
        if cheapest < inf:
            assert follow(arrays, plan, found, item, unroll(found, 0))
            assert update(arrays, plan, state.sweep)


def cheapest_by_trying(problem: Problem, routes: tuple[Route, ...], item: int) -> float:
    """What the item costs more at the best of all pairs of positions, each timed and checked."""
    kept = sorted({task.item for route in routes for task in route})
    before = judged(problem, routes, kept)
    described, best = problem.items[item], inf
    pickup = Task(described.pickup.place, Action.PICK, item)
    delivery = Task(described.delivery.place, Action.DROP, item)
    for robot, route in enumerate(routes):
        for at, later in product(range(len(route) + 1), repeat=2):
            if at <= later:
                tried = (*route[:at], pickup, *route[at:later], delivery, *route[later:])
                changed = (*routes[:robot], tried, *routes[robot + 1 :])
                best = min(best, judged(problem, changed, [*kept, item]))
    return best - before


def judged(problem: Problem, routes: tuple[Route, ...], kept: list[int]) -> float:
    """The cost of routes with some of the items; infinite where they cannot be carried out."""
    number = {item: position for position, item in enumerate(kept)}
    part = replace(problem, items=tuple(problem.items[item] for item in kept))
    renumbered = [
        tuple(replace(task, item=number[task.item]) for task in route) for route in routes
    ]
    schedule = earliest_schedule(part, renumbered)
    if not isinstance(schedule, Schedule) or check(part, schedule):
        return inf
    return cost(part, schedule).total


def test_robots_come_before_distance_where_they_cost_more() -> None:
    items = (parcel("a", 0, 4), parcel("b", 4, 0))
    problem = replace(corridor(items=items), weights=Weights(robots=1e6))
    found = solved(problem)
    assert found.cost is not None
    assert found.cost.robots == 1


def test_item_thrown_out_finds_another_place() -> None:
    """Robot a alone can reach the item that the cheapest plan has no room for any more."""
    robots = (Robot("a", 0, 0, 1.0, Window(0.0, 90.0)), Robot("b", 0, 0, 1.0, Window(0.0, 200.0)))
    items = (
        Item("far", 1.0, Visit(0), Visit(4, Window(0.0, 45.0))),
        Item("near", 1.0, Visit(0, Window(0.0, 10.0)), Visit(1)),
        Item("back", 1.0, Visit(4, Window(0.0, 60.0)), Visit(0)),
    )
    found = solved(corridor(items=items, robots=robots, transfers=Transfers()))
    assert found.schedule is not None


def test_start_is_never_made_worse() -> None:
    problem = corridor(items=(parcel(), parcel("back", 4, 0)))
    start = solved(problem, seconds=0.0).schedule
    assert start is not None
    again = solved(problem, start=start)
    assert again.cost is not None
    assert again.cost.total <= cost(problem, start).total


def test_start_with_transfers_stays_where_no_robot_can_do_it_alone() -> None:
    robots = (
        Robot("left", 0, 0, 1.0, Window(0.0, 40.0)),
        Robot("right", 4, 4, 1.0, Window(0.0, 60.0)),
    )
    problem = corridor(items=(parcel(),), robots=robots)
    start = earliest_schedule(problem, HANDED_OVER)
    assert isinstance(start, Schedule)
    assert solved(problem, seconds=2.0, transfers=False).status is Status.UNKNOWN
    assert solved(problem, seconds=2.0, transfers=False, start=start).schedule == start


def test_same_seed_finds_the_same() -> None:
    problem = drawn_problem(3, items=12, spare_s=600.0)
    assert solved(problem, seed=5).schedule == solved(problem, seed=5).schedule


def test_progress_falls_to_the_cost_of_the_solution() -> None:
    told: list[Progress] = []
    found = solved(drawn_problem(3, items=12, spare_s=600.0), on_progress=told.append)
    incumbents = [each.incumbent for each in told if each.incumbent is not None]
    assert incumbents == sorted(incumbents, reverse=True)
    assert found.cost is not None
    assert incumbents[-1] == pytest.approx(found.cost.total)


def test_nothing_to_deliver_is_delivered_at_once() -> None:
    found = solved(corridor(items=()))
    assert found.cost is not None
    assert found.cost.total == 0.0


def test_item_that_nobody_can_deliver_leaves_no_schedule() -> None:
    heavy = replace(parcel("heavy"), load=5.0)
    found = solved(corridor(items=(parcel(), heavy)))
    assert (found.status, found.schedule) == (Status.UNKNOWN, None)


def test_it_is_chosen_where_there_are_many_items_and_no_transfers() -> None:
    many = corridor(items=tuple(parcel(f"p{n}") for n in range(40)), transfers=Transfers())
    assert suited_method(many) == "alns"
    found = solve(many, "auto", seconds=2.0, clock=EvenClock())
    assert found.schedule is not None


@pytest.mark.slow
@pytest.mark.skipif(not DATA.is_dir(), reason="the folder of benchmark instances is not here")
@pytest.mark.parametrize("name", sample(["lrc101"], ["lr101", "lrc101"]))
def test_best_known_schedule_is_found(name: str) -> None:
    folder = DATA / "li_lim"
    with (folder / "best_known.csv").open() as file:
        (known,) = (row for row in csv.DictReader(file) if row["instance"] == name)
    problem = read_li_lim((folder / "pdp_100" / f"{name}.txt").read_text(), name)
    found = solve_alns(problem, seconds=2.0, seed=1, clock=time.process_time)
    assert found.cost is not None
    assert found.cost.robots == int(known["vehicles"])
    assert found.cost.distance_m <= 1.01 * float(known["distance"])
