"""What is infeasible: one sentence for what cannot hold, and never one for what can."""

import time
from dataclasses import replace
from math import inf

import numpy as np
import pytest
from benchmark_instances import DATA
from delivery_problems import CORRIDOR, corridor, corridor_items, parcel
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.fleet.scheduling.exact.solve import solve_exactly
from mend.fleet.scheduling.infeasibility import infeasibilities
from mend.fleet.scheduling.instances.li_lim import read_li_lim
from mend.fleet.scheduling.instances.transfer_benchmark import read_transfer_benchmark
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Window
from mend.fleet.scheduling.solution import Status
from mend.fleet.scheduling.travel import Epoch, Travel


def sentences(problem: Problem) -> list[str]:
    return [each.sentence for each in infeasibilities(problem)]


def test_problem_that_can_be_solved_has_none() -> None:
    assert sentences(corridor(items=(parcel(), parcel("back", 4, 0)))) == []


def test_load_above_every_capacity() -> None:
    heavy = replace(parcel("heavy"), load=5.0)
    assert sentences(corridor(items=(heavy,))) == [
        "item 'heavy' has a load of 5, but no robot carries more than 2"
    ]


def island() -> Travel:
    """The corridor without a way to its last place."""
    time_s = Travel.euclidean(CORRIDOR).time_s.copy()
    time_s[:4, 4] = time_s[4, :4] = inf
    return Travel(time_s, time_s)


def test_delivery_that_nobody_can_reach() -> None:
    robots = (Robot("left", 0, 0, 2.0),)
    there = replace(corridor(items=(parcel(),), robots=robots), travel=island())
    assert sentences(there) == ["item 'parcel' cannot be delivered: there is no way from a to e"]
    back = replace(corridor(items=(parcel("parcel", 4, 0),), robots=robots), travel=island())
    assert sentences(back) == [
        "no robot that can carry item 'parcel' can get to e, where it is picked up"
    ]


def test_window_that_closes_before_anybody_can_be_there() -> None:
    early = Item("early", 1.0, Visit(2, Window(0.0, 12.0)), Visit(0))
    (told,) = sentences(corridor(items=(early,)))
    assert told == (
        "item 'early' cannot be delivered even if a robot does nothing else: left starts at 0 s; "
        "left has to get there to pick early at c; to pick early at c must begin by 12 s "
        "(together they ask for 8 s more than there is)"
    )


def test_several_constraints_that_clash_are_all_named() -> None:
    robots = (Robot("only", 0, 0, 2.0, max_duration_s=70.0),)
    (told,) = sentences(corridor(items=(parcel(),), robots=robots, transfers=Transfers()))
    assert "only has to get there to drop parcel at e" in told
    assert "only has to get to its end" in told
    assert "only may be away for 70 s" in told
    assert "10 s more" in told


def test_transfer_that_makes_it_possible_is_not_infeasible() -> None:
    robots = tuple(
        replace(robot, max_duration_s=45.0) for robot in corridor(items=(parcel(),)).robots
    )
    with_transfers = corridor(items=(parcel(),), robots=robots)
    assert sentences(with_transfers) == []
    assert len(sentences(with_transfers.without_transfers())) == 1


def test_robot_that_cannot_get_home() -> None:
    robots = (Robot("left", 0, 4, 2.0, Window(0.0, 30.0)), Robot("right", 4, 4, 2.0))
    (told,) = infeasibilities(corridor(items=(parcel("p", 3, 4),), robots=robots))
    assert told.robot == 0
    assert told.sentence.startswith("robot 'left' cannot get to its end: ")
    assert "the shift of left ends at 30 s" in told.sentence


def test_robot_that_has_too_much_aboard() -> None:
    items = tuple(parcel(f"p{n}", aboard=0) for n in range(3))
    told = sentences(corridor(items=items))
    assert told == ["robot 'left' has a load of 3 aboard, but carries only 2"]


def test_door_that_opens_too_late() -> None:
    apart = Travel.euclidean(CORRIDOR)
    nowhere = np.where(np.eye(5) > 0, 0.0, inf)
    doors = Travel.through(
        (Epoch(0.0, 100.0, nowhere, nowhere), Epoch(100.0, inf, apart.distance_m, apart.time_s))
    )
    soon = Item("soon", 1.0, Visit(0), Visit(2, Window(0.0, 110.0)))
    (told,) = sentences(replace(corridor(items=(soon,)), travel=doors))
    assert (
        "can get there to drop soon at c only while the doors and elevators on its way are open"
        in told
    )
    assert "10 s more" in told
    later = replace(soon, delivery=Visit(2, Window(0.0, 120.0)))
    assert sentences(replace(corridor(items=(later,)), travel=doors)) == []


def test_detour_may_be_quicker_in_a_matrix() -> None:
    time_s = Travel.euclidean(CORRIDOR).time_s.copy()
    time_s[0, 4] = inf
    problem = replace(corridor(items=(parcel(),)), travel=Travel(time_s, time_s))
    assert sentences(problem) == []


@given(
    corridor_items(),
    st.sampled_from((Transfers(), Transfers((2,), service_s=2.0), Transfers((1, 3), True, 1.0))),
    st.sampled_from((inf, 90.0, 50.0)),
)
@settings(deadline=None, max_examples=40)
def test_nothing_that_can_be_solved_is_called_infeasible(
    items: tuple[Item, ...], transfers: Transfers, duration_s: float
) -> None:
    robots = (
        Robot("left", 0, 0, 2.0, max_duration_s=duration_s),
        Robot("right", 4, None, 1.0, Window(10.0, 200.0), duration_s, 1.5),
    )
    problem = corridor(items=items[:2], robots=robots, transfers=transfers)
    if infeasibilities(problem):
        found = solve_exactly(problem, seconds=5.0, workers=1, clock=time.perf_counter)
        assert found.status in (Status.INFEASIBLE, Status.UNKNOWN)


@pytest.mark.skipif(not DATA.is_dir(), reason="the benchmark instances are not here")
def test_published_instances_are_judged() -> None:
    for name in ("lc101", "lr101"):
        assert infeasibilities(read_li_lim(next(DATA.rglob(f"{name}.txt")).read_text())) == []
    feasible = read_transfer_benchmark(next(DATA.rglob("4R-4K-4T-300L-0.txt")).read_text())
    assert infeasibilities(feasible) == []
    items = (replace(feasible.items[0], load=1e6), *feasible.items[1:])
    (told,) = infeasibilities(replace(feasible, items=items))
    assert told.item == 0


def test_of_a_visit_nothing_is_picked_or_delivered() -> None:
    late = Item("early", 1.0, Visit(2, Window(0.0, 5.0)), Visit(2, Window(0.0, 5.0)))
    (told,) = sentences(corridor(items=(late,)))
    assert told.startswith("item 'early' cannot be done even if a robot does nothing else")
    assert "to begin early at c" in told
