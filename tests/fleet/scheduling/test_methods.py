"""The methods by name: what they return is valid, never worse than what they begin with."""

from dataclasses import replace
from math import inf
from random import Random

import pytest
from benchmark_instances import DATA
from delivery_problems import CORRIDOR, HANDED_OVER, corridor, corridor_items, parcel
from hypothesis import given, settings
from hypothesis import strategies as st
from office_building import BuildingPlan, building_deliveries
from sampled import sample
from ticking_clock import TickingClock

from mend.fleet.scheduling.checker import check
from mend.fleet.scheduling.instances.li_lim import read_li_lim
from mend.fleet.scheduling.instances.transfer_benchmark import read_transfer_benchmark
from mend.fleet.scheduling.methods import METHODS, best_heuristic, solve, suited_method
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Weights, Window
from mend.fleet.scheduling.problem_file import problem_of
from mend.fleet.scheduling.schedule import Schedule
from mend.fleet.scheduling.solution import Progress, Status, UnsupportedError
from mend.fleet.scheduling.timing import earliest_schedule
from mend.fleet.scheduling.travel import Epoch, Travel

HEURISTICS = ("auction", "greedy", "insertion", "one_task")


def two_robots(**fields: object) -> tuple[Robot, Robot]:
    left, right = Robot("left", 0, 0, 2.0), Robot("right", 4, None, 2.0)
    return replace(left, **fields), replace(right, **fields)  # type: ignore[arg-type]


@pytest.mark.parametrize("method", HEURISTICS)
@given(
    items=corridor_items(),
    transfers=st.sampled_from(
        (Transfers(), Transfers((2,), service_s=2.0), Transfers((1, 3), True))
    ),
    weights=st.sampled_from(
        (Weights(), Weights(makespan=1.0), Weights(completion=2.0, robots=50.0))
    ),
    duration_s=st.sampled_from((inf, 150.0)),
)
@settings(deadline=None, max_examples=sample(20, 60))
def test_schedule_found_passes_the_checker(
    method: str, items: tuple[Item, ...], transfers: Transfers, weights: Weights, duration_s: float
) -> None:
    robots = two_robots(max_duration_s=duration_s)
    problem = replace(corridor(items=items, robots=robots, transfers=transfers), weights=weights)
    found = solve(problem, method, seconds=60.0, clock=TickingClock())
    if found.schedule is None:
        assert found.status is Status.UNKNOWN
    else:
        assert found.status is Status.FEASIBLE
        assert check(problem, found.schedule) == []
        assert found.cost == cost(problem, found.schedule)


@pytest.mark.parametrize("method", HEURISTICS)
def test_what_is_aboard_is_brought_home(method: str) -> None:
    items = (parcel("first", aboard=1), parcel("second", 3, 1))
    problem = corridor(items=items, transfers=Transfers())
    found = solve(problem, method, seconds=60.0, clock=TickingClock())
    assert found.schedule is not None
    assert check(problem, found.schedule) == []


@pytest.mark.parametrize("method", ["auction", "insertion"])
def test_item_is_handed_over_where_a_robot_alone_has_no_time(method: str) -> None:
    robots = two_robots(max_duration_s=45.0)
    problem = corridor(items=(parcel(),), robots=robots)
    found = solve(problem, method, seconds=60.0, clock=TickingClock())
    assert found.schedule is not None
    assert found.schedule.transfers == 1
    alone = solve(problem.without_transfers(), method, seconds=60.0, clock=TickingClock())
    assert alone.status is Status.UNKNOWN


@pytest.mark.parametrize("method", ["auction", "insertion"])
def test_item_goes_through_a_chain_of_robots(method: str) -> None:
    robots = tuple(Robot(f"r{at}", at, at, 1.0, max_duration_s=41.0) for at in (0, 2, 4))
    problem = corridor(items=(parcel(),), robots=robots, transfers=Transfers((1, 3)))
    found = solve(problem, method, seconds=60.0, clock=TickingClock())
    assert found.schedule is not None
    assert check(problem, found.schedule) == []
    assert found.schedule.transfers == 2


def test_one_task_bidder_brings_one_item_at_a_time() -> None:
    problem = corridor(items=tuple(parcel(f"p{n}") for n in range(4)))
    found = solve(problem, "one_task", seconds=60.0, clock=TickingClock())
    assert found.schedule is not None
    for route in found.schedule.routes:
        assert [task.action.loads for task in route] == [True, False] * (len(route) // 2)


@pytest.mark.parametrize("method", sorted(set(METHODS) - {"one_destination"}))
def test_result_is_never_worse_than_the_start(method: str) -> None:
    problem = corridor(items=(parcel(),), robots=two_robots(max_duration_s=45.0))
    start = earliest_schedule(problem, HANDED_OVER)
    assert isinstance(start, Schedule)
    found = METHODS[method].solve(
        problem, seconds=5.0, seed=1, start=start, on_progress=None, clock=TickingClock(0.5)
    )
    assert found.cost is not None
    assert found.cost.total <= cost(problem, start).total


def test_same_seed_gives_the_same_schedule() -> None:
    items = tuple(parcel(f"p{n}", n % 5, (3 * n + 1) % 5) for n in range(6))
    problem = corridor(items=items)
    first, second = (
        solve(problem, "insertion", seconds=60.0, seed=7, clock=TickingClock()) for _ in range(2)
    )
    assert first.schedule == second.schedule


def test_insertion_stops_when_the_time_is_over() -> None:
    items = tuple(parcel(f"p{n}", n % 5, (3 * n + 1) % 5) for n in range(6))
    found = solve(corridor(items=items), "insertion", seconds=3.0, clock=TickingClock(1.0))
    assert found.status is Status.UNKNOWN


def test_exact_tells_of_the_heuristics_and_ends_optimal() -> None:
    told: list[Progress] = []
    problem = corridor(items=(parcel(), parcel("back", 4, 0)))
    found = solve(problem, "exact", seconds=600.0, on_progress=told.append, clock=TickingClock(0.1))
    assert found.status is Status.OPTIMAL
    assert told[0].bound is None
    assert found.bound == pytest.approx(found.cost.total if found.cost else None)


def test_exact_leaves_to_the_heuristics_what_is_too_large(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mend.fleet.scheduling.methods.EXACT_SIZE", 10)
    problem = corridor(items=(parcel(), parcel("back", 4, 0)))
    found = solve(problem, "exact", seconds=10.0, clock=TickingClock(0.5))
    assert found.schedule is not None
    assert check(problem, found.schedule) == []
    assert (found.status, found.bound) == (Status.FEASIBLE, None)


def test_exact_begins_with_the_best_of_the_heuristics() -> None:
    items = tuple(parcel(f"p{n}", n % 5, (3 * n + 1) % 5) for n in range(6))
    problem = corridor(items=items, robots=two_robots(max_duration_s=150.0))
    best = best_heuristic(
        problem, seconds=20.0, seed=1, start=None, on_progress=None, clock=TickingClock(0.5)
    )
    assert best.cost is not None
    for name in ("greedy", "insertion", "auction", "alns"):
        alone = solve(problem, name, seconds=2.0, seed=1, clock=TickingClock(0.5))
        assert alone.cost is None or best.cost.total <= alone.cost.total


def with_a_door(problem: Problem) -> Problem:
    apart = Travel.euclidean(CORRIDOR)
    closed = Epoch(0.0, 50.0, apart.distance_m * 3, apart.time_s * 3)
    opened = Epoch(50.0, inf, apart.distance_m, apart.time_s)
    return replace(problem, travel=Travel.through((closed, opened)))


def test_exact_is_not_offered_where_doors_close() -> None:
    problem = with_a_door(corridor(items=(parcel(),)))
    with pytest.raises(UnsupportedError, match="greedy"):
        solve(problem, "exact", seconds=1.0, clock=TickingClock(0.5))
    assert suited_method(problem) == "alns"


@given(items=corridor_items(), seed=st.integers(0, 99))
@settings(deadline=None, max_examples=sample(5, 12))
def test_search_around_doors_is_valid_and_no_worse_than_insertion(
    items: tuple[Item, ...], seed: int
) -> None:
    problem = with_a_door(corridor(items=items, robots=two_robots()))
    first = solve(problem, "insertion", seconds=30.0, seed=seed, clock=TickingClock(0.1))
    found = solve(problem, "alns", seconds=30.0, seed=seed, clock=TickingClock(0.1))
    # The search may find what insertion misses, never the other way round.
    assert found.schedule is not None or first.schedule is None
    if found.schedule is not None and first.cost is not None:
        assert check(problem, found.schedule) == []
        assert cost(problem, found.schedule).total <= first.cost.total


def test_search_around_doors_mends_what_insertion_missed() -> None:
    plan = BuildingPlan(robots=2, items=8, office_hours=3, shift_s=None)
    problem = problem_of(building_deliveries(plan, Random(5)))
    assert problem.travel.epochs
    told: list[Progress] = []
    plain = solve(problem, "insertion", seconds=1000.0, seed=1, clock=TickingClock(1.0))
    found = solve(
        problem, "alns", seconds=300.0, seed=1, on_progress=told.append, clock=TickingClock(1.0)
    )
    assert found.cost is not None
    assert plain.cost is not None
    assert found.cost.total < plain.cost.total
    costs = [each.incumbent for each in told]
    assert costs == sorted(costs, reverse=True)
    assert costs[-1] == pytest.approx(found.cost.total)


@pytest.mark.parametrize("method", HEURISTICS)
@given(items=corridor_items())
@settings(deadline=None, max_examples=sample(15, 50))
def test_heuristics_plan_around_doors(method: str, items: tuple[Item, ...]) -> None:
    problem = with_a_door(corridor(items=items, robots=two_robots()))
    found = solve(problem, method, seconds=60.0, clock=TickingClock())
    if found.schedule is not None:
        assert check(problem, found.schedule) == []


@pytest.mark.parametrize("method", ["alns", "insertion"])
def test_what_is_compiled_first_is_announced(method: str) -> None:
    told: list[str] = []
    problem = corridor(items=(parcel(),))
    clock = TickingClock(0.5)
    solve(problem, method, seconds=2.0, on_prepare=lambda: told.append("prepares"), clock=clock)
    assert told == (["prepares"] if METHODS[method].prepare else [])


def test_size_decides_what_is_suited() -> None:
    few = corridor(items=(parcel(),))
    many = corridor(items=tuple(parcel(f"p{n}") for n in range(40)))
    assert (suited_method(few), suited_method(many)) == ("exact", "alns")


def test_window_that_nobody_meets_leaves_no_schedule() -> None:
    late = Item("late", 1.0, Visit(4), Visit(0, Window(0.0, 10.0)))
    problem = corridor(items=(late,))
    assert solve(problem, "insertion", seconds=9.0, clock=TickingClock()).status is Status.UNKNOWN
    assert (
        solve(problem, "exact", seconds=600.0, clock=TickingClock(0.1)).status is Status.INFEASIBLE
    )


@pytest.mark.slow
@pytest.mark.skipif(not DATA.is_dir(), reason="the benchmark instances are not here")
@pytest.mark.parametrize("method", sorted(set(HEURISTICS) - {"one_task"}))
def test_published_instances_get_valid_schedules(method: str) -> None:
    li_lim = read_li_lim(next(DATA.rglob("lc101.txt")).read_text())
    transfers = read_transfer_benchmark(next(DATA.rglob("4R-4K-4T-300L-0.txt")).read_text())
    for problem in (li_lim, transfers):
        found = solve(problem, method, seconds=600.0, clock=TickingClock(3.0))
        assert found.schedule is not None
        assert check(problem, found.schedule) == []
