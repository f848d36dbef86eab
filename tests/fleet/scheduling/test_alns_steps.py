"""The kernels of the search: every plan they keep is valid, and costs what they say it does."""

from dataclasses import replace

import numpy as np
import pytest
from delivery_problems import corridor, corridor_items, parcel
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.fleet.scheduling.alns.annealing import take_step
from mend.fleet.scheduling.alns.itineraries import (
    Allowed,
    find_itineraries,
    follow,
    lift_tabu,
    unroll,
)
from mend.fleet.scheduling.alns.plan import BANKED, Plan, copy_plan, plan_value, take_out
from mend.fleet.scheduling.alns.problem_arrays import NOBODY, ProblemArrays, problem_arrays
from mend.fleet.scheduling.alns.propagation import update
from mend.fleet.scheduling.alns.removal import Removal, choose_items
from mend.fleet.scheduling.alns.repair import Repair
from mend.fleet.scheduling.alns.routes import plan_of, routes_in
from mend.fleet.scheduling.alns.state import BEST, CURRENT, State, state_for
from mend.fleet.scheduling.checker import check
from mend.fleet.scheduling.infeasibility import infeasibilities
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Weights, Window
from mend.fleet.scheduling.rng import Rng, below, rng_from, shuffle, uniform
from mend.fleet.scheduling.schedule import Action, Route, Schedule
from mend.fleet.scheduling.timing import Untimeable, earliest_schedule
from mend.fleet.scheduling.travel import Epoch, Travel

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


DIRECT, WITH_CHAINS = Allowed(0, False, 0.0), Allowed(CHAIN, False, 0.0)


def stepped(problem: ProblemArrays, state: State, rng: Rng, steps: int = STEPS) -> None:
    """Take steps with every operator in turn."""
    for number in range(steps):
        operators = number % len(Removal), number % len(Repair)
        take_step(problem, state, rng, operators, CHAIN, 20.0)


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


def require_honest(problem: Problem, arrays: ProblemArrays, plan: Plan, value: float) -> None:
    """The checker accepts the plan, and its cost is what was counted on the way."""
    partial, routes = delivered(problem, arrays, plan)
    schedule = earliest_schedule(partial, routes)
    assert isinstance(schedule, Schedule)
    assert check(partial, schedule) == []
    banked = len(problem.items) - len(partial.items)
    expected = cost(partial, schedule)
    assert value == pytest.approx(expected.total + banked * arrays.penalty)


@given(problems(), seeds)
@settings(deadline=None, max_examples=sample(20, 60), suppress_health_check=[HealthCheck.too_slow])
def test_every_accepted_step_is_valid_and_costs_what_it_says(problem: Problem, seed: int) -> None:
    arrays = problem_arrays(problem, CHAIN)
    state, rng = state_for(arrays), rng_from(np.random.default_rng(seed))
    for number in range(STEPS):
        operators = number % len(Removal), number % len(Repair)
        if take_step(arrays, state, rng, operators, CHAIN, 20.0) > 0:
            require_honest(problem, arrays, state.current, float(state.value[CURRENT]))
            assert state.value[BEST] <= state.value[CURRENT] + 1e-6
    if state.value[BEST] < float("inf"):
        require_honest(problem, arrays, state.best, float(state.value[BEST]))


def test_there_is_no_plan_where_an_idle_robot_cannot_get_home_in_its_shift() -> None:
    slow = Robot("slow", 2, 0, 2.0, Window(0.0, 30.0), speed=0.5)
    problem = corridor(items=(parcel("first", 4, 3),), robots=(slow, Robot("right", 4, None, 2.0)))
    arrays = problem_arrays(problem, CHAIN)
    state = state_for(arrays)
    stepped(arrays, state, rng_from(np.random.default_rng(1)))
    assert state.value[BEST] == float("inf")
    assert isinstance(earliest_schedule(replace(problem, items=()), ((), ())), Untimeable)
    (told,) = [each.sentence for each in infeasibilities(problem)]
    assert told.startswith("robot 'slow' cannot get to its end")
    assert "the shift of slow ends at 30 s" in told


@pytest.mark.parametrize("seed", range(5))
def test_nor_is_there_one_where_others_may_hand_things_over(seed: int) -> None:
    slow = Robot("slow", 0, 2, 2.0, Window(0.0, 30.0), speed=0.5)
    robots = (Robot("left", 0, None, 2.0), slow, Robot("right", 4, None, 2.0))
    items = (parcel("first", 0, 4), parcel("second", 4, 1))
    exchange = Transfers((1, 2, 3), together=False, service_s=0.0)
    problem = corridor(items=items, robots=robots, transfers=exchange)
    state = state_for(arrays := problem_arrays(problem, CHAIN))
    stepped(arrays, state, rng_from(np.random.default_rng(seed)), 200)
    assert state.value[BEST] == float("inf")


@given(problems(), seeds, st.integers(5, 80).map(float))
@settings(deadline=None, max_examples=sample(13, 40), suppress_health_check=[HealthCheck.too_slow])
def test_steps_around_doors_are_valid_and_cost_what_they_say(
    problem: Problem, seed: int, opens_s: float
) -> None:
    apart = problem.travel
    closed = Epoch(0.0, opens_s, apart.distance_m * 3, apart.time_s * 3)
    opened = Epoch(opens_s, float("inf"), apart.distance_m, apart.time_s)
    around = replace(problem, travel=Travel.through((closed, opened)))
    test_every_accepted_step_is_valid_and_costs_what_it_says.hypothesis.inner_test(  # type: ignore[attr-defined]
        around, seed
    )


@given(problems(), seeds)
@settings(deadline=None, max_examples=30, suppress_health_check=[HealthCheck.too_slow])
def test_rows_with_one_version_are_the_same(problem: Problem, seed: int) -> None:
    arrays = problem_arrays(problem, CHAIN)
    state, rng = state_for(arrays), rng_from(np.random.default_rng(seed))
    stepped(arrays, state, rng)
    for plan in (state.trial, state.best, state.kept):
        for row in np.flatnonzero(plan.rows.version == state.current.rows.version)[:-1]:
            length = plan.rows.length[row]
            same = plan.stops[row, :length] == state.current.stops[row, :length]
            assert same.all()


@given(st.integers(2, 12), seeds)
@settings(deadline=None, max_examples=30)
def test_an_itinerary_costs_what_was_foreseen_where_only_distance_counts(
    count: int, seed: int
) -> None:
    problem = scattered(count, seed)
    arrays = problem_arrays(problem, CHAIN)
    state, rng = state_for(arrays), rng_from(np.random.default_rng(seed))
    stepped(arrays, state, rng)
    plan, found = state.trial, state.found
    for item in range(count):
        copy_plan(state.best, plan)
        take_out(arrays, plan, item)
        assert update(arrays, plan, state.sweep)
        before = plan_value(arrays, plan) - arrays.penalty
        copy_plan(plan, state.kept)
        find_itineraries(arrays, plan, found, rng, item, WITH_CHAINS)
        assert found.known[0] > 0
        for number in range(found.known[0]):
            copy_plan(state.kept, plan)
            transfers = unroll(found, number)
            robots = list(found.leg[: transfers + 1, 0])
            once = len(set(robots)) == len(robots)
            followed = follow(arrays, plan, found, item, transfers)
            if followed and once and update(arrays, plan, state.sweep):
                rise = plan_value(arrays, plan) - before
                assert rise == pytest.approx(found.extra[number], abs=1e-5)


def scattered(count: int, seed: int) -> Problem:
    """Items all over a square, two robots, two transfer places; only capacity binds."""
    drawn = np.random.default_rng(seed)
    points = [(float(x), float(y)) for x, y in drawn.integers(0, 100, (4 + 2 * count, 2))]
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
    state, rng = state_for(arrays), rng_from(np.random.default_rng(seed))
    stepped(arrays, state, rng)
    again = plan_of(arrays, problem, routes_in(arrays, state.current))
    assert update(arrays, again, state.sweep)
    assert plan_value(arrays, again) == pytest.approx(plan_value(arrays, state.current))
    assert routes_in(arrays, again) == routes_in(arrays, state.current)


def test_item_changes_robots_when_it_must() -> None:
    problem = corridor(items=(parcel(),))
    arrays = problem_arrays(problem, CHAIN)
    state, rng = state_for(arrays), rng_from(np.random.default_rng(0))
    plan, found = state.trial, state.found
    find_itineraries(arrays, plan, found, rng, 0, Allowed(1, True, 0.0))
    assert follow(arrays, plan, found, 0, unroll(found, 0))
    assert update(arrays, plan, state.sweep)
    actions = [task.action for task in routes_in(arrays, plan)[0]]
    assert actions == [Action.PICK, Action.GIVE]


@pytest.mark.parametrize("task", [0, 1], ids=["pickup", "delivery"])
def test_what_is_tabu_for_a_robot_others_do(task: int) -> None:
    problem = corridor(items=(parcel(destination=1),))
    arrays = problem_arrays(problem, CHAIN)
    state, rng = state_for(arrays), rng_from(np.random.default_rng(0))
    plan, found = state.trial, state.found
    for forbids, robot in ((False, 0), (True, 1)):
        copy_plan(state.current, plan)
        if forbids:
            found.tabu[task] = 0
        find_itineraries(arrays, plan, found, rng, 0, Allowed(1, False, 0.0))
        assert follow(arrays, plan, found, 0, unroll(found, 0))
        assert update(arrays, plan, state.sweep)
        assert plan.tasks.row[task] == robot


def test_a_detour_that_is_spared_leaves_nothing_tabu() -> None:
    problem = scattered(10, 3)
    arrays = problem_arrays(problem, CHAIN)
    state, rng = state_for(arrays), rng_from(np.random.default_rng(3))
    forbidden = 0
    for _ in range(STEPS):
        stepped(arrays, state, rng, 1)
        assert (state.found.tabu == NOBODY).all()
        copy_plan(state.current, state.trial)
        count = choose_items(arrays, state, rng, int(Removal.DETOUR), 3)
        tasks = np.flatnonzero(state.found.tabu != NOBODY)
        forbidden += len(tasks)
        assert set(arrays.nodes.item_of[tasks]) <= set(state.chosen[:count])
        assert (state.found.tabu[tasks] == state.trial.tasks.row[tasks]).all()
        lift_tabu(state.found)
    assert forbidden > 0


@given(seeds, st.integers(1, 50))
@settings(deadline=None, max_examples=20)
def test_numbers_stay_in_their_range_and_none_is_lost(seed: int, count: int) -> None:
    rng = rng_from(np.random.default_rng(seed))
    assert all(0.0 <= uniform(rng) < 1.0 for _ in range(20))
    assert all(0 <= below(rng, count) < count for _ in range(20))
    numbers = np.arange(count)
    shuffle(rng, numbers, count)
    assert sorted(numbers) == list(range(count))
