"""Items that cannot all be delivered although each of them could."""

from dataclasses import replace

from delivery_problems import corridor, parcel

from fleet.scheduling.contradictions import contradictions
from fleet.scheduling.exact.solve import solve_exactly
from fleet.scheduling.joint_contradictions import in_words, joint_contradiction
from fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Window
from fleet.scheduling.solution import Status

ONE = (Robot("ada", 0, 0, 1.0, max_duration_s=100.0),)


def frozen_clock() -> float:
    return 0.0


def explained(problem: Problem) -> str:
    return in_words(problem, joint_contradiction(problem, seconds=10.0, clock=frozen_clock))


def test_only_the_items_that_are_in_each_others_way_are_named() -> None:
    rivals = tuple(
        Item(name, 1.0, Visit(4, Window(40.0, 45.0)), Visit(0)) for name in ("cake", "soup")
    )
    problem = corridor(
        items=(parcel("post", 1, 2), *rivals), robots=(ONE[0],), transfers=Transfers()
    )
    assert contradictions(problem) == []
    assert solve_exactly(problem, seconds=10.0).status is Status.INFEASIBLE
    found = joint_contradiction(problem, seconds=10.0, clock=frozen_clock)
    assert (found.items, found.smallest) == ((1, 2), True)


def test_a_limit_that_is_in_the_way_alone_is_named() -> None:
    items = tuple(
        Item(f"box{number}", 1.0, Visit(4), Visit(0)) for number in range(2)
    )  # Twice 80 m with a capacity of one.
    problem = corridor(items=items, robots=ONE, transfers=Transfers())
    assert explained(problem) == (
        "items 'box0' and 'box1' cannot both be delivered, though all but any one of them could: "
        "it would take more capacity or more time away (max_duration_s)"
    )


def test_limits_that_are_in_the_way_together_are_said_to_be_several() -> None:
    windows = (Window(40.0, 41.0), Window(100.0, 101.0))
    items = tuple(
        Item(f"at {each.earliest_s:g}", 1.0, Visit(4, each), Visit(0)) for each in windows
    )
    robots = (replace(ONE[0], capacity=1.0),)
    problem = corridor(items=items, robots=robots, transfers=Transfers())
    assert explained(problem).endswith("more than one kind of limit is in the way")


def test_transfers_are_named_where_they_would_help() -> None:
    robots = (
        Robot("left", 0, 0, 1.0, max_duration_s=65.0),
        Robot("right", 4, 4, 1.0, max_duration_s=65.0),
    )
    problem = corridor(
        items=(parcel("post"), parcel("mail", 4, 0)), robots=robots, transfers=Transfers()
    )
    assert "it would take more time away (max_duration_s) or transfers between robots" in (
        explained(problem)
    )
