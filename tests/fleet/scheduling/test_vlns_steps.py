"""The kernels of the search: every plan they keep is valid, and costs what they say it does."""

from dataclasses import replace

import numpy as np
import pytest
from delivery_problems import corridor, corridor_items, parcel
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mend.fleet.scheduling.checker import check
from mend.fleet.scheduling.dice import dice_from, one_of, shuffle, throw
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Weights, Window
from mend.fleet.scheduling.schedule import Action, Route, Schedule
from mend.fleet.scheduling.timing import earliest_schedule
from mend.fleet.scheduling.travel import Travel
from mend.fleet.scheduling.vlns.annealing import search_for, take_step
from mend.fleet.scheduling.vlns.arrays import (
    BANKED,
    DISTANCE,
    NOWHERE,
    TOTAL,
    Plan,
    ProblemArrays,
    copy_plan,
    problem_arrays,
    take_out,
)
from mend.fleet.scheduling.vlns.insertion import refresh
from mend.fleet.scheduling.vlns.removal import choose_items
from mend.fleet.scheduling.vlns.routes import plan_of, routes_in
from mend.fleet.scheduling.vlns.ways import find_ways, follow, lift_bars

STEPS = 40
CHAIN = 3


@st.composite
def problems(draw: st.DrawFn) -> Problem:
    """Corridors with two or three robots and all that can bind or cost."""
    items = [
        replace(item, load=draw(st.sampled_from((0.0, 1.0, 2.0))), max_on_board_s=draw(longest))
        for item in draw(corridor_items())
    ]
    robots = [
        Robot(
            f"robot{number}", draw(st.integers(0, 4)), draw(st.none() | st.integers(0, 4)), 2.0,
            Window(0.0, draw(longest)), draw(longest), draw(st.sampled_from((0.5, 1.0, 2.0))),
        )
        for number in range(draw(st.integers(2, 3)))
    ]  # fmt: skip
    if draw(st.booleans()):
        items[0] = replace(items[0], aboard=0)
    places = tuple(sorted(draw(st.sets(st.integers(0, 4)))))
    service_s = float(draw(st.integers(0, 3)))
    transfers = Transfers(places, draw(st.booleans()), service_s)
    problem = corridor(items=tuple(items), robots=tuple(robots), transfers=transfers)
    weights = Weights(*(draw(st.sampled_from((0.0, 1.0, 2.5))) for _ in range(5)))
    return replace(problem, weights=weights)


longest = st.integers(30, 500).map(float) | st.just(float("inf"))
seeds = st.integers(0, 1000)


def delivered(problem: Problem, arrays: ProblemArrays, plan: Plan) -> tuple[Problem, list[Route]]:
    """The problem of those items alone that are not in the bank, and the plan's routes for it."""
    numbers = [n for n in range(len(problem.items)) if plan.transfers[n] != BANKED]
    renumbered = {number: at for at, number in enumerate(numbers)}
    routes = [
        tuple(replace(task, item=renumbered[task.item]) for task in route)
        for route in routes_in(arrays, plan)
    ]
    return replace(problem, items=tuple(problem.items[n] for n in numbers)), routes


def require_honest(problem: Problem, arrays: ProblemArrays, plan: Plan) -> None:
    """The checker accepts the plan, and its cost is what was counted on the way."""
    partial, routes = delivered(problem, arrays, plan)
    schedule = earliest_schedule(partial, routes)
    assert isinstance(schedule, Schedule)
    assert check(partial, schedule) == []
    banked = len(problem.items) - len(partial.items)
    expected = cost(partial, schedule)
    assert plan.value[TOTAL] == pytest.approx(expected.total + banked * arrays.penalty)
    assert plan.value[DISTANCE] == pytest.approx(expected.distance_m)


@given(problems(), seeds)
@settings(deadline=None, max_examples=60, suppress_health_check=[HealthCheck.too_slow])
def test_every_accepted_step_is_valid_and_costs_what_it_says(problem: Problem, seed: int) -> None:
    arrays = problem_arrays(problem, CHAIN)
    search, dice = search_for(arrays), dice_from(np.random.default_rng(seed))
    for _ in range(STEPS):
        if take_step(arrays, search, dice, CHAIN, 20.0):
            require_honest(problem, arrays, search.current)
            assert search.best.value[TOTAL] <= search.current.value[TOTAL]
    if search.best.value[TOTAL] < float("inf"):
        require_honest(problem, arrays, search.best)


@given(st.integers(2, 12), seeds)
@settings(deadline=None, max_examples=30)
def test_a_way_costs_what_was_foreseen_where_only_distance_counts(count: int, seed: int) -> None:
    problem = scattered(count, seed)
    arrays = problem_arrays(problem, CHAIN)
    search, dice = search_for(arrays), dice_from(np.random.default_rng(seed))
    for _ in range(STEPS):
        take_step(arrays, search, dice, CHAIN, 20.0)
    plan = search.current
    for item in range(count):
        copy_plan(search.best, plan)
        take_out(arrays, plan, item)
        assert refresh(arrays, plan, search.times)
        before = plan.value[DISTANCE]
        find_ways(arrays, plan, search.times, search.ways, dice, item, 0, CHAIN, 0.0)
        assert search.ways.known[1] > 0
        for number in range(search.ways.known[1]):
            copy_plan(plan, search.trial)
            followed = follow(arrays, search.trial, search.ways, item, number)
            robots = list(search.ways.leg[: search.trial.transfers[item] + 1, 0])
            once = len(set(robots)) == len(robots)
            if followed and once and refresh(arrays, search.trial, search.times):
                rise = search.trial.value[DISTANCE] - before
                assert rise == pytest.approx(search.ways.extra[number], abs=1e-6)


def scattered(count: int, seed: int) -> Problem:
    """Items all over a square, two robots, two transfer places; only capacity binds."""
    dice = np.random.default_rng(seed)
    points = [(float(x), float(y)) for x, y in dice.integers(0, 100, (4 + 2 * count, 2))]
    items = tuple(
        Item(f"i{n}", 1.0, Visit(4 + 2 * n), Visit(5 + 2 * n)) for n in range(count)
    )  # fmt: skip
    return Problem(
        "scattered", tuple(str(n) for n in range(len(points))), Travel.euclidean(points),
        (Robot("a", 0, 0, 3.0), Robot("b", 1, 1, 3.0)), items, Transfers((2, 3)),
    )  # fmt: skip


@given(seeds)
@settings(deadline=None, max_examples=20)
def test_routes_become_the_same_plan_again(seed: int) -> None:
    problem = replace(scattered(4, seed), transfers=Transfers((0, 1, 2, 3)))
    arrays = problem_arrays(problem, CHAIN)
    search, dice = search_for(arrays), dice_from(np.random.default_rng(seed))
    for _ in range(STEPS):
        take_step(arrays, search, dice, CHAIN, 50.0)
    again = plan_of(arrays, problem, routes_in(arrays, search.current))
    assert refresh(arrays, again, search.times)
    assert again.value[TOTAL] == pytest.approx(search.current.value[TOTAL])
    assert routes_in(arrays, again) == routes_in(arrays, search.current)


def test_first_item_changes_robots_when_it_must() -> None:
    problem = corridor(items=(parcel(),))
    arrays = problem_arrays(problem, CHAIN)
    search, dice = search_for(arrays), dice_from(np.random.default_rng(0))
    plan = search.current
    assert refresh(arrays, plan, search.times)
    find_ways(arrays, plan, search.times, search.ways, dice, 0, 1, 1, 0.0)
    assert follow(arrays, plan, search.ways, 0, 0)
    actions = [task.action for task in routes_in(arrays, plan)[0]]
    assert actions == [Action.PICK, Action.GIVE]


@pytest.mark.parametrize("task", [0, 1], ids=["pickup", "delivery"])
def test_what_is_barred_to_a_robot_others_do(task: int) -> None:
    problem = corridor(items=(parcel(destination=1),))
    arrays = problem_arrays(problem, CHAIN)
    search, dice = search_for(arrays), dice_from(np.random.default_rng(0))
    assert refresh(arrays, search.current, search.times)
    for bars, robot in ((False, 0), (True, 1)):
        copy_plan(search.current, search.trial)
        if bars:
            search.ways.barred[task] = 0
        find_ways(arrays, search.trial, search.times, search.ways, dice, 0, 0, 1, 0.0)
        assert follow(arrays, search.trial, search.ways, 0, 0)
        assert search.trial.robot[task] == robot


def test_a_visit_that_is_spared_leaves_nothing_barred() -> None:
    problem = scattered(10, 3)
    arrays = problem_arrays(problem, CHAIN)
    search, dice = search_for(arrays), dice_from(np.random.default_rng(3))
    barred = 0
    for _ in range(STEPS):
        take_step(arrays, search, dice, CHAIN, 20.0)
        assert (search.ways.barred == NOWHERE).all()
        copy_plan(search.current, search.trial)
        assert refresh(arrays, search.trial, search.times)
        count = choose_items(
            arrays, search.trial, search.times, dice, search.chosen, search.ways.barred
        )
        tasks = np.flatnonzero(search.ways.barred != NOWHERE)
        barred += len(tasks)
        assert set(arrays.item[tasks]) <= set(search.chosen[:count])
        assert (search.ways.barred[tasks] == search.trial.robot[tasks]).all()
        lift_bars(search.ways)
    assert barred > 0


@given(seeds, st.integers(1, 50))
@settings(deadline=None, max_examples=20)
def test_dice_stay_in_their_range_and_lose_nothing(seed: int, count: int) -> None:
    dice = dice_from(np.random.default_rng(seed))
    assert all(0.0 <= throw(dice) < 1.0 for _ in range(20))
    assert all(0 <= one_of(dice, count) < count for _ in range(20))
    numbers = np.arange(count)
    shuffle(dice, numbers, count)
    assert sorted(numbers) == list(range(count))
