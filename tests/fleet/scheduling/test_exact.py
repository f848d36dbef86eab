"""The exact solver: against plain enumeration, and against published optima where they are."""

import csv
import time
from dataclasses import replace
from itertools import permutations, product
from pathlib import Path

import pytest
from benchmark_instances import DATA
from delivery_problems import HANDED_OVER, corridor, corridor_items, parcel
from hypothesis import HealthCheck, given, settings
from sampled import sample

from mend.fleet.scheduling.checker import check
from mend.fleet.scheduling.exact.solve import solve_exactly
from mend.fleet.scheduling.instances.transfer_benchmark import read_transfer_benchmark
from mend.fleet.scheduling.itinerary import BrokenItineraryError
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Weights, Window
from mend.fleet.scheduling.schedule import Action, Route, Schedule, Task
from mend.fleet.scheduling.solution import Status
from mend.fleet.scheduling.timing import earliest_schedule

PATIENCE_S = 600.0
"""More than a small problem ever takes, on however busy a machine."""
PUBLISHED_S = 60.0


def plain_optimum(problem: Problem) -> float | None:
    """The cheapest of all schedules in which every item changes robots at most once."""
    best: float | None = None
    for ways in product(*(_ways(problem, number) for number in range(len(problem.items)))):
        tasks = [[task for way in ways for task in way[robot]] for robot in (0, 1)]
        for routes in product(permutations(tasks[0]), permutations(tasks[1])):
            value = _cost(problem, routes)
            if value is not None and (best is None or value < best):
                best = value
    return best


def _ways(problem: Problem, item: int) -> list[tuple[tuple[Task, ...], tuple[Task, ...]]]:
    described = problem.items[item]
    pick = Task(described.pickup.place, Action.PICK, item)
    drop = Task(described.delivery.place, Action.DROP, item)
    ways: list[tuple[tuple[Task, ...], tuple[Task, ...]]] = [((pick, drop), ()), ((), (pick, drop))]
    for place in problem.transfers.places:
        first = (pick, Task(place, Action.GIVE, item, 1)), (Task(place, Action.TAKE, item, 0), drop)
        second = (
            (Task(place, Action.TAKE, item, 1), drop),
            (pick, Task(place, Action.GIVE, item, 0)),
        )
        ways += [first, second]
    return ways


def _cost(problem: Problem, routes: tuple[Route, ...]) -> float | None:
    try:
        schedule = earliest_schedule(problem, routes)
    except BrokenItineraryError:
        return None
    if not isinstance(schedule, Schedule) or check(problem, schedule):
        return None
    return cost(problem, schedule).total


@pytest.mark.slow
@given(corridor_items())
@settings(
    deadline=None,
    max_examples=sample(5, 12),
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
def test_optimum_equals_that_of_plain_enumeration(items: tuple[Item, ...]) -> None:
    problem = corridor(
        items=items[:2],
        robots=(Robot("left", 0, 0, 1.0), Robot("right", 4, 4, 1.0, Window(0.0, 400.0))),
        transfers=Transfers((2,), service_s=2.0),
    )
    problem = replace(problem, weights=Weights(distance=1.0, completion=0.25))
    expected = plain_optimum(problem)
    solution = solve_exactly(problem, seconds=PATIENCE_S, clock=time.perf_counter)
    if expected is None:
        assert solution.status is Status.INFEASIBLE
    else:
        assert solution.status is Status.OPTIMAL
        assert solution.cost is not None
        assert solution.cost.total == pytest.approx(expected, abs=0.05)


def test_transfer_makes_possible_what_no_robot_can_do_alone() -> None:
    robots = (
        Robot("left", 0, 0, 1.0, Window(0.0, 40.0)),
        Robot("right", 4, 4, 1.0, Window(0.0, 60.0)),
    )
    problem = corridor(items=(parcel(),), robots=robots)
    solution = solve_exactly(problem, seconds=PATIENCE_S, clock=time.perf_counter)
    assert solution.status is Status.OPTIMAL
    assert solution.schedule is not None
    assert solution.schedule.transfers == 1
    alone = solve_exactly(problem.without_transfers(), seconds=PATIENCE_S, clock=time.perf_counter)
    assert alone.status is Status.INFEASIBLE


def test_face_to_face_transfer_keeps_both_robots_there() -> None:
    robots = (Robot("left", 0, 0, 1.0), Robot("right", 4, 4, 1.0, Window(35.0, 100.0)))
    problem = corridor(
        items=(parcel(),), robots=robots, transfers=Transfers((2,), together=True, service_s=4.0)
    )
    shift_end = replace(robots[0], shift=Window(0.0, 90.0))
    problem = replace(problem, robots=(shift_end, robots[1]))
    problem = replace(problem, weights=Weights(distance=0.0, makespan=1.0))
    solution = solve_exactly(problem, seconds=PATIENCE_S, clock=time.perf_counter)
    assert solution.status is Status.OPTIMAL
    assert solution.schedule is not None
    assert check(problem, solution.schedule) == []


def test_item_aboard_is_delivered_by_who_has_it_or_whom_it_is_given() -> None:
    aboard = Item("aboard", 1.0, Visit(0), Visit(4), aboard=0)
    problem = corridor(items=(aboard,))
    solution = solve_exactly(problem, seconds=PATIENCE_S, clock=time.perf_counter)
    assert solution.status is Status.OPTIMAL
    assert solution.schedule is not None
    assert solution.cost is not None
    assert solution.cost.total == 80.0


ALONE: tuple[Route, ...] = ((Task(0, Action.PICK, 0), Task(4, Action.DROP, 0)), ())


@pytest.mark.parametrize("routes", [ALONE, HANDED_OVER], ids=["alone", "handed over"])
def test_start_that_is_as_good_as_any_stays_as_it_is(routes: tuple[Route, ...]) -> None:
    problem = corridor(items=(parcel(),))
    start = earliest_schedule(problem, routes)
    assert isinstance(start, Schedule)
    solution = solve_exactly(problem, seconds=PATIENCE_S, start=start, clock=time.perf_counter)
    assert solution.status is Status.OPTIMAL
    assert solution.schedule == start
    assert solution.gap == 0.0


def test_start_is_never_made_worse() -> None:
    problem = corridor(items=(parcel(), parcel("other", 4, 0)))
    first = solve_exactly(problem, seconds=PATIENCE_S, clock=time.perf_counter)
    assert first.schedule is not None
    again = solve_exactly(
        problem, seconds=PATIENCE_S, start=first.schedule, clock=time.perf_counter
    )
    assert again.cost is not None
    assert first.cost is not None
    assert again.cost.total <= first.cost.total


@pytest.mark.slow
@pytest.mark.skipif(not DATA.is_dir(), reason="the folder of benchmark instances is not here")
@pytest.mark.parametrize(
    "name", ["3R-4K-4T-180S-0", *sample([], ["3R-4K-5T-240M-1"]), "PDPT-R5-K2-T1-Q100-0"]
)
def test_published_optimum_is_found_and_proved(name: str) -> None:
    (path,) = DATA.glob(f"*/{name}.txt")
    problem = read_transfer_benchmark(path.read_text(), name)
    solution = solve_exactly(problem, seconds=PUBLISHED_S, clock=time.perf_counter)
    assert solution.status is Status.OPTIMAL
    assert solution.cost is not None
    assert solution.cost.total == pytest.approx(published(path), abs=0.01)


def published(path: Path) -> float:
    with (path.parent / "published_mip.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["instance"] == path.name]
    return min(float(row["objective"]) for row in rows if row["status"] == "OPTIMAL")
