"""Everything to one destination: at most twice the optimum, and a sentence where it is not for."""

import time
from dataclasses import replace
from random import Random

import pytest
from delivery_problems import corridor, parcel
from hypothesis import given, settings
from hypothesis import strategies as st
from sampled import sample
from ticking_clock import TickingClock

from mend.fleet.scheduling.checker import check
from mend.fleet.scheduling.exact.solve import solve_exactly
from mend.fleet.scheduling.methods import solve
from mend.fleet.scheduling.one_destination import solve_to_one_destination
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Weights, Window
from mend.fleet.scheduling.solution import Status, UnsupportedError
from mend.fleet.scheduling.travel import Travel


def collection(items: int, robots: int, chance: Random) -> Problem:
    """Items all over a square, to be brought to its first place; robots anywhere."""
    points = [(chance.uniform(0, 100), chance.uniform(0, 100)) for _ in range(1 + items + robots)]
    places = tuple(f"place{n}" for n in range(len(points)))
    return Problem(
        "collection",
        places,
        Travel.euclidean(points),
        tuple(Robot(f"r{n}", 1 + items + n, None, float(items)) for n in range(robots)),
        tuple(Item(f"i{n}", 1.0, Visit(1 + n), Visit(0)) for n in range(items)),
        Transfers(tuple(range(len(points)))),
    )


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(sample(1, 3)))
def test_cost_is_at_most_twice_the_optimum(seed: int) -> None:
    problem = collection(2 + seed % 2, 2, Random(seed))
    walk = solve_to_one_destination(problem, seconds=0.0, clock=TickingClock())
    shared = solve_to_one_destination(problem, seconds=60.0, clock=TickingClock())
    best = solve_exactly(problem, seconds=600.0, start=shared.schedule, clock=time.perf_counter)
    assert best.status is Status.OPTIMAL
    assert walk.cost is not None
    assert best.cost is not None
    assert shared.cost is not None
    assert walk.cost.total <= 2 * best.cost.total + 1e-3
    assert shared.cost.total <= walk.cost.total + 1e-9
    assert shared.bound is not None
    assert shared.bound <= best.cost.total + 1e-3


@given(st.integers(1, 14), st.integers(1, 3), st.integers(0, 10_000))
@settings(deadline=None, max_examples=25)
def test_walk_passes_the_checker_and_has_no_worse_tree(items: int, robots: int, seed: int) -> None:
    problem = collection(items, robots, Random(seed))
    walk = solve_to_one_destination(problem, seconds=0.0, clock=TickingClock())
    assert walk.schedule is not None
    assert walk.cost is not None
    assert check(problem, walk.schedule) == []
    if walk.bound is not None:
        assert walk.cost.total <= 2 * walk.bound + 1e-6


def test_walk_around_a_tree_is_at_most_twice_the_tree(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = collection(6, 1, Random(3))
    shortest = solve_to_one_destination(problem, seconds=0.0, clock=TickingClock())
    monkeypatch.setattr("mend.fleet.scheduling.one_destination.EXACT_PLACES", 0)
    around = solve_to_one_destination(problem, seconds=0.0, clock=TickingClock())
    assert around.cost is not None
    assert shortest.cost is not None
    assert shortest.cost.total <= around.cost.total + 1e-9
    assert around.cost.total <= 2 * shortest.cost.total
    assert around.bound is None


@pytest.mark.parametrize(
    ("problem", "why"),
    [
        (corridor(items=(parcel("a"), parcel("b", 4, 0))), "'a' and 'b' have different"),
        (
            corridor(items=(Item("a", 1.0, Visit(0, Window(3.0)), Visit(4)),)),
            "item 'a' has time constraints",
        ),
        (corridor(items=(parcel("a", aboard=0),)), "'a' is aboard a robot already"),
        (corridor(items=tuple(parcel(f"p{n}") for n in range(3))), "no robot carries everything"),
        (
            corridor(items=(parcel(),), robots=(Robot("r", 0, 4, 2.0),)),
            "'r' must end elsewhere",
        ),
        (
            corridor(items=(parcel(),), robots=(Robot("r", 0, 0, 2.0, Window(0.0, 900.0)),)),
            "'r' has a shift that ends",
        ),
        (
            replace(corridor(items=(parcel(),)), weights=Weights(makespan=1.0)),
            "the objective weighs times",
        ),
    ],
)
def test_sentence_says_where_it_does_not_apply(problem: Problem, why: str) -> None:
    with pytest.raises(UnsupportedError, match=why):
        solve(problem, "one_destination", seconds=1.0, clock=TickingClock())
