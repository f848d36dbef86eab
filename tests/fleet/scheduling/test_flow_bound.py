"""The bound from flows: never above the optimum, and what the exact method makes of it."""

import csv
import time
from dataclasses import replace
from math import inf

import pytest
from benchmark_instances import DATA
from delivery_problems import corridor, drawn_problem, parcel
from sampled import sample

from mend.fleet.scheduling.exact.flow_bound import flow_bound, windows_are_wide
from mend.fleet.scheduling.exact.linear_program import LinearProgram
from mend.fleet.scheduling.exact.solve import solve_exactly
from mend.fleet.scheduling.instances.transfer_benchmark import read_transfer_benchmark
from mend.fleet.scheduling.problem import Item, Robot, Transfers, Visit, Weights, Window
from mend.fleet.scheduling.solution import Status


@pytest.mark.slow
@pytest.mark.parametrize("seed", sample(range(10), range(30)))
def test_bound_is_never_above_the_optimum(seed: int) -> None:
    problem = drawn_problem(seed)
    exact = solve_exactly(problem, seconds=600.0, clock=time.perf_counter)
    proved = flow_bound(problem, 20.0)
    if exact.status is Status.OPTIMAL:
        assert exact.cost is not None
        assert proved is not None
        assert proved <= exact.cost.total + 1e-6


def test_bound_of_one_robot_with_one_item_is_the_optimum() -> None:
    robots = (Robot("only", 2, 2, 1.0),)
    problem = corridor(items=(parcel(),), robots=robots, transfers=Transfers())
    assert flow_bound(problem, 10.0) == pytest.approx(80.0, rel=1e-4)


def test_robots_that_are_needed_are_counted() -> None:
    items = (parcel("a"), parcel("b"))
    robots = (
        Robot("one", 0, 4, 1.0, Window(0.0, 60.0)),
        Robot("two", 0, 4, 1.0, Window(0.0, 60.0)),
    )
    problem = corridor(items=items, robots=robots, transfers=Transfers())
    problem = replace(problem, weights=Weights(robots=100.0))
    assert flow_bound(problem, 10.0) == pytest.approx(280.0, rel=1e-4)


def test_nothing_to_deliver_has_no_bound_of_its_own() -> None:
    assert flow_bound(corridor(items=()), 1.0) is None


def test_program_that_no_values_satisfy_has_an_infinite_bound() -> None:
    program = LinearProgram()
    variable = program.variable(0.0, 1.0, cost=1.0)
    program.row({variable: 1.0}, 2.0)
    assert program.bound(1.0) == inf


def test_windows_decide_whether_it_is_tried() -> None:
    free = corridor(items=(parcel("a"), parcel("b", 4, 0), parcel("c", 1, 3)))
    assert windows_are_wide(free)
    early, late = Window(0.0, 20.0), Window(500.0, 520.0)
    tight = tuple(
        Item(f"i{number}", 1.0, Visit(0, when), Visit(1, when))
        for number, when in enumerate((early, late, early, late))
    )
    assert not windows_are_wide(corridor(items=tight))


@pytest.mark.slow
@pytest.mark.skipif(not DATA.is_dir(), reason="the folder of benchmark instances is not here")
def test_exact_method_takes_the_better_bound() -> None:
    (path,) = DATA.glob("*/PDPT-R7-K2-T1-Q100-3.txt")
    with (path.parent / "published_mip.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["instance"].startswith(path.stem)]
    optimum = min(float(row["objective"]) for row in rows if row["status"] == "OPTIMAL")
    problem = read_transfer_benchmark(path.read_text())
    told: list[float | None] = []
    found = solve_exactly(
        problem,
        seconds=4.0,
        workers=1,
        on_progress=lambda each: told.append(each.bound),
        clock=time.perf_counter,
    )
    assert found.bound is not None
    assert found.bound <= optimum + 1e-3
    assert found.bound == told[-1] or found.status is Status.OPTIMAL
