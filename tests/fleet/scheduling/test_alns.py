"""The search from outside: against the exact solver, what transfers make possible, its promises."""

import csv
import random
import time
from dataclasses import replace

import pytest
from benchmark_instances import DATA
from delivery_problems import HANDED_OVER, corridor, parcel
from even_clock import EvenClock
from sampled import sample

from mend.fleet.scheduling.alns.solve import solve_alns
from mend.fleet.scheduling.checker import check
from mend.fleet.scheduling.exact.solve import solve_exactly
from mend.fleet.scheduling.instances.transfer_benchmark import read_transfer_benchmark
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Weights, Window
from mend.fleet.scheduling.schedule import Schedule
from mend.fleet.scheduling.solution import Progress, Solution, Status
from mend.fleet.scheduling.timing import earliest_schedule


def solved(problem: Problem, seconds: float = 40.0, **options: object) -> Solution:
    """A search that does the same work in every run."""
    return solve_alns(problem, seconds=seconds, clock=EvenClock(), **options)  # type: ignore[arg-type]


IN_VAIN_S = 4.0
"""It gives up at the end of its time only: more of that would find as little."""


def handed_over(problem: Problem) -> Schedule:
    schedule = earliest_schedule(problem, HANDED_OVER)
    assert isinstance(schedule, Schedule)
    return schedule


def drawn_problem(seed: int) -> Problem:
    """Three items, two or three robots; windows, shifts and what counts differ by seed."""
    rng = random.Random(seed)

    def window(length_s: int) -> Window:
        begin_s = rng.randint(0, 60)
        return Window(float(begin_s), float(begin_s + rng.randint(40, length_s)))

    items = tuple(
        Item(
            f"item{number}",
            float(rng.randint(1, 2)),
            Visit(rng.randrange(5), window(200), due_s=50.0, service_s=float(rng.randint(0, 3))),
            Visit(rng.randrange(5), window(300)),
            max_on_board_s=float(rng.randint(40, 200)),
        )
        for number in range(3)
    )
    robots = tuple(
        Robot(f"robot{number}", place, rng.choice((place, None)), 2.0, Window(0.0, 300.0),
              max_duration_s=float(rng.randint(80, 300)))
        for number, place in enumerate((0, 4, 2)[: rng.randint(2, 3)])
    )  # fmt: skip
    transfers = Transfers((2, 3), together=seed % 3 == 0, service_s=float(rng.randint(0, 4)))
    weights = rng.choice(
        (Weights(), Weights(0.5, 1.0), Weights(1.0, 0.0, 0.5), Weights(1.0, 0.0, 0.0, 3.0, 20.0))
    )
    return replace(corridor(items=items, robots=robots, transfers=transfers), weights=weights)


@pytest.mark.slow
@pytest.mark.parametrize("seed", sample((0, 1, 2, 5), range(24)))
def test_search_finds_what_the_exact_solver_proves(seed: int) -> None:
    problem = drawn_problem(seed)
    exact = solve_exactly(problem, seconds=600.0, clock=time.perf_counter)
    found = solved(problem)
    if exact.status is Status.INFEASIBLE:
        assert found.status is Status.UNKNOWN
        return
    assert exact.status is Status.OPTIMAL
    assert exact.cost is not None
    assert found.cost is not None
    # Times are rounded up in the exact solver; and here a robot may come to a place again.
    assert found.cost.total <= exact.cost.total + 0.05


@pytest.mark.slow(2)
def test_transfer_makes_possible_what_no_robot_can_do_alone() -> None:
    robots = (
        Robot("left", 0, 0, 1.0, Window(0.0, 40.0)),
        Robot("right", 4, 4, 1.0, Window(0.0, 60.0)),
    )
    problem = corridor(items=(parcel(),), robots=robots)
    found = solved(problem)
    assert found.status is Status.FEASIBLE
    assert found.bound is None
    assert found.schedule is not None
    assert found.schedule.transfers == 1
    alone = solved(problem, IN_VAIN_S, transfers=False)
    assert alone.status is Status.UNKNOWN
    assert alone.schedule is None


def test_item_changes_robots_twice_where_shifts_are_short() -> None:
    robots = (
        Robot("first", 0, 0, 1.0, Window(0.0, 25.0)),
        Robot("second", 1, 3, 1.0, Window(0.0, 35.0)),
        Robot("third", 4, 4, 1.0, Window(0.0, 60.0)),
    )
    problem = corridor(items=(parcel(),), robots=robots, transfers=Transfers((1, 3)))
    found = solved(problem)
    assert found.schedule is not None
    assert found.schedule.transfers == 2


def test_item_changes_robots_anywhere() -> None:
    robots = (
        Robot("left", 0, 0, 1.0, Window(0.0, 20.0)),
        Robot("right", 4, 4, 1.0, Window(0.0, 75.0)),
    )
    anywhere = Transfers(tuple(range(5)))
    found = solved(corridor(items=(parcel(),), robots=robots, transfers=anywhere))
    assert found.schedule is not None
    given = found.schedule.robots[0].stops[-1].task
    assert given.place == 1


def test_robots_meet_where_they_have_to() -> None:
    robots = (
        Robot("left", 0, 0, 1.0, Window(0.0, 90.0)),
        Robot("right", 4, 4, 1.0, Window(35.0, 100.0)),
    )
    together = Transfers((2,), together=True, service_s=4.0)
    problem = corridor(items=(parcel(),), robots=robots, transfers=together)
    problem = replace(problem, weights=Weights(distance=0.0, makespan=1.0))
    found = solved(problem)
    assert found.cost is not None
    assert found.cost.total == pytest.approx(79.0)


def test_item_aboard_stays_there_or_is_given() -> None:
    aboard = Item("aboard", 1.0, Visit(0), Visit(4), aboard=0)
    short = (Robot("left", 0, 0, 1.0, Window(0.0, 40.0)), Robot("right", 4, 4, 1.0))
    for robots, expected in ((None, 0), (short, 1)):
        problem = corridor(items=(aboard,)) if robots is None else corridor(
            items=(aboard,), robots=robots
        )  # fmt: skip
        found = solved(problem)
        assert found.schedule is not None
        assert found.schedule.transfers == expected


def test_item_that_nobody_can_deliver_stops_nothing() -> None:
    heavy = replace(parcel("heavy"), load=5.0)
    told: list[Progress] = []
    found = solved(corridor(items=(parcel(), heavy)), IN_VAIN_S, on_progress=told.append)
    assert found.status is Status.UNKNOWN
    assert found.schedule is None
    assert told == []


def test_start_is_never_made_worse() -> None:
    problem = corridor(items=(parcel(),))
    start = handed_over(problem)
    begun = cost(problem, start).total
    at_once = solve_alns(problem, seconds=0.0, start=start, clock=EvenClock())
    assert at_once.cost is not None
    assert at_once.cost.total <= begun
    found = solved(problem, start=start)
    assert found.cost is not None
    assert found.cost.total <= at_once.cost.total


def test_start_with_transfers_is_kept_where_no_new_ones_are_allowed() -> None:
    robots = (
        Robot("left", 0, 0, 1.0, Window(0.0, 40.0)),
        Robot("right", 4, 4, 1.0, Window(0.0, 60.0)),
    )
    problem = corridor(items=(parcel(),), robots=robots)
    start = handed_over(problem)
    found = solved(problem, IN_VAIN_S, start=start, transfers=False)
    assert found.schedule == start


@pytest.mark.parametrize("seed", range(3))
def test_transfers_never_cost_more_than_doing_without(seed: int) -> None:
    items = (parcel("a", 0, 4), parcel("b", 4, 0), parcel("c", 1, 3))
    problem = corridor(items=items)
    alone = solve_alns(problem, seconds=8.0, seed=seed, transfers=False, clock=EvenClock())
    found = solve_alns(problem, seconds=40.0, seed=seed, clock=EvenClock())
    assert alone.cost is not None
    assert found.cost is not None
    assert found.cost.total <= alone.cost.total


def test_same_seed_finds_the_same() -> None:
    problem = drawn_problem(1)
    assert solved(problem, seed=5).schedule == solved(problem, seed=5).schedule


def test_progress_falls_to_the_cost_of_the_solution() -> None:
    told: list[Progress] = []
    found = solved(corridor(items=(parcel(), parcel("b", 4, 0))), on_progress=told.append)
    incumbents = [each.incumbent for each in told if each.incumbent is not None]
    assert incumbents == sorted(incumbents, reverse=True)
    assert found.cost is not None
    assert incumbents[-1] == pytest.approx(found.cost.total)


def test_nothing_to_deliver_is_delivered_at_once() -> None:
    found = solved(corridor(items=()))
    assert found.status is Status.FEASIBLE
    assert found.cost is not None
    assert found.cost.total == 0.0


@pytest.mark.slow
@pytest.mark.skipif(not DATA.is_dir(), reason="the folder of benchmark instances is not here")
@pytest.mark.parametrize(
    "name", sample(["5R-4K-4T-180L-0"], ["3R-4K-4T-180L-0", "5R-4K-4T-180L-0"])
)
def test_published_optimum_is_found(name: str) -> None:
    (path,) = DATA.glob(f"*/{name}.txt")
    problem = read_transfer_benchmark(path.read_text(), name)
    with (path.parent / "published_mip.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["instance"] == path.name]
    best = min(float(row["objective"]) for row in rows if row["status"] == "OPTIMAL")
    found = solve_alns(problem, seconds=2.0, seed=1, clock=time.process_time)
    assert found.schedule is not None
    assert check(problem, found.schedule) == []
    assert found.cost is not None
    assert found.cost.total == pytest.approx(best, rel=1e-6)
