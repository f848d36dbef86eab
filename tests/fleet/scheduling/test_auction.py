"""Auctions: bids are true marginal costs, tried and undone; what is sold moves nothing else."""

from dataclasses import replace

import pytest
from delivery_problems import corridor, corridor_items, parcel
from hypothesis import example, given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.fleet.scheduling.auction import sell
from mend.fleet.scheduling.growing_routes import GrowingRoutes
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.partial_routes import part_schedule, without_items
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Weights, Window
from mend.fleet.scheduling.replanning.plan_repair import PlanRepair
from mend.fleet.scheduling.schedule import Action, Task

ROBOTS = (Robot("left", 0, 0, 2.0, max_duration_s=260.0), Robot("right", 4, None, 2.0))
kinds_of_transfers = st.sampled_from(
    (Transfers(), Transfers((2,), service_s=2.0), Transfers((1, 2, 3), together=True))
)
kinds_of_weights = st.sampled_from(
    (Weights(), Weights(completion=2.0), Weights(makespan=1.0), Weights(0.5, 0.0, 1.0, 1.0, 30.0))
)


def problem_with(items: tuple[Item, ...], transfers: Transfers, weights: Weights) -> Problem:
    return replace(corridor(items=items, robots=ROBOTS, transfers=transfers), weights=weights)


@given(corridor_items(), kinds_of_transfers, kinds_of_weights)
@settings(deadline=None, max_examples=60)
def test_bid_is_what_the_schedule_costs_more(
    items: tuple[Item, ...], transfers: Transfers, weights: Weights
) -> None:
    problem = problem_with(items, transfers, weights)
    growing = GrowingRoutes(problem, ((), ()))
    empty = part_schedule(problem, ((), ()))
    assert empty is not None
    before = cost(*empty).total
    for item in range(len(items)):
        bid = growing.bid(item)
        if bid is None:
            continue
        growing.award(item, bid)
        timed = part_schedule(problem, growing.routes)
        assert timed is not None
        after = cost(*timed).total
        assert bid.cost == pytest.approx(after - before, abs=1e-5)
        before = after


@given(corridor_items(), kinds_of_transfers, kinds_of_weights)
@settings(deadline=None, max_examples=40)
def test_bidding_leaves_everything_as_it_was(
    items: tuple[Item, ...], transfers: Transfers, weights: Weights
) -> None:
    growing = GrowingRoutes(problem_with(items, transfers, weights), ((), ()))
    bids = [growing.bid(item) for item in range(len(items))]
    assert growing.routes == ((), ())
    again = [growing.bid(item) for item in range(len(items))]
    assert [bid and bid.cost for bid in again] == [bid and bid.cost for bid in bids]


@given(corridor_items(), kinds_of_transfers)
@settings(deadline=None, max_examples=40)
def test_one_more_item_moves_nothing_else(items: tuple[Item, ...], transfers: Transfers) -> None:
    problem = problem_with((*items, parcel("new", 3, 1)), transfers, Weights())
    first = sell(problem, ((), ()), range(len(items)))
    second = sell(problem, first.routes, [len(items)])
    assert without_items(second.routes, {len(items)}) == first.routes
    assert set(second.unsold) <= {len(items)}


URGENT = Window(19.0, 63.0)
"""Without transfers the far one has no place but before the others, and there it is cheaper."""


@given(corridor_items(), kinds_of_transfers, kinds_of_weights)
@example(
    items=(
        Item("far", 1.0, Visit(4, URGENT, service_s=3.0), Visit(0, URGENT)),
        Item("middle", 1.0, Visit(1, Window(39.0, 63.0), service_s=1.0), Visit(0)),
        Item("near", 1.0, Visit(2, URGENT, service_s=2.0), Visit(2, URGENT)),
    ),
    transfers=Transfers((1, 2, 3), together=True),
    weights=Weights(0.5, 0.0, 1.0, 1.0, 30.0),
)
@settings(deadline=None, max_examples=sample(13, 40))
def test_what_is_sold_is_never_worse_than_without_transfers(
    items: tuple[Item, ...], transfers: Transfers, weights: Weights
) -> None:
    problem = problem_with(items, transfers, weights)
    totals = []
    for each in (problem, problem.without_transfers()):
        repair = PlanRepair(each, ((), ()), (0, 0), [False] * len(items))
        for item in range(len(items)):
            repair.resell(item)
        repair.repair()
        timed = part_schedule(repair.problem, repair.routes)
        assert timed is not None
        totals.append((len(repair.put_off), cost(*timed).total))
    (put_off, total), (put_off_alone, alone) = totals
    assert put_off <= put_off_alone
    if put_off == put_off_alone:
        assert total <= alone + 1e-6


def test_nothing_is_put_before_what_is_held() -> None:
    problem = corridor(items=(parcel("far", 3, 4), parcel("near", 0, 1)), robots=ROBOTS[:1])
    routes = ((Task(3, Action.PICK, 0), Task(4, Action.DROP, 0)),)
    free = sell(problem, routes, (1,))
    assert free.routes[0][0].item == 1
    held = sell(problem, routes, (1,), held=(1,))
    assert held.routes[0][0].item == 0
    assert not held.unsold


def test_item_that_is_about_to_be_picked_up_keeps_its_pickup() -> None:
    problem = corridor(items=(parcel("begun", 3, 0),), robots=ROBOTS)
    routes = ((Task(3, Action.PICK, 0),), ())
    sale = sell(problem, routes, (0,), held=(1, 0), begun={0: 0})
    assert sale.routes[0][0] == Task(3, Action.PICK, 0)
    assert part_schedule(problem, sale.routes) is not None


def test_routes_in_conflict_are_not_sold_to() -> None:
    robot = Robot("short", 0, 0, 2.0, max_duration_s=10.0)
    problem = corridor(items=(parcel("far", 3, 4), parcel("near", 0, 1)), robots=(robot,))
    routes = ((Task(3, Action.PICK, 0), Task(4, Action.DROP, 0)),)
    with pytest.raises(ValueError, match="conflict before anything is sold"):
        sell(problem, routes, (1,))
