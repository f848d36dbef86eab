"""Why items have no place: what breaks at the end of each robot's route, the least of it."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from math import inf
from random import Random

import pytest
from delivery_problems import corridor, drawn_problem, parcel
from hypothesis import given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.fleet.scheduling import no_place
from mend.fleet.scheduling.auction import sell
from mend.fleet.scheduling.building_travel import travel_in
from mend.fleet.scheduling.constraint import ConstraintKind
from mend.fleet.scheduling.no_place import nearest_conflicts
from mend.fleet.scheduling.partial_routes import items_in
from mend.fleet.scheduling.problem import Item, Problem, Robot, Visit, Window
from mend.fleet.scheduling.replanning.events import RobotFailed
from mend.fleet.scheduling.replanning.running_fleet import RunningFleet
from mend.fleet.scheduling.schedule import Action, Route, Task
from mend.fleet.scheduling.timing import TimedRoutes
from mend.maps.navigation import NavigationGraph, Place, Way, WayKind

PLACES = tuple(Place(name, 10.0 * number, 0.0) for number, name in enumerate("abcde"))
DOORS = NavigationGraph(
    PLACES,
    [
        Way(a.name, b.name, WayKind.DOOR, 10.0, open_s=((0.0, 55.0), (70.0, 140.0)))
        for a, b in pairwise(PLACES)
    ],
)


def crowded(seed: int, *, doors: bool) -> Problem:
    """A drawn problem with three more items; what is to be brought is urgent."""
    problem, chance = drawn_problem(seed), Random(seed)
    more = tuple(parcel(f"more{n}", chance.randrange(5), chance.randrange(5)) for n in range(3))
    items = tuple(
        replace(
            item,
            delivery=replace(item.delivery, window=Window(0.0, chance.uniform(20, 120))),
            max_on_board_s=chance.choice((inf, 30.0)),
        )
        for item in (*problem.items, *more)
    )
    travel = travel_in(DOORS) if doors else problem.travel
    return replace(problem, items=items, travel=travel)


def with_item_last(problem: Problem, routes: Sequence[Route], robot: int, item: int) -> list[Route]:
    """The routes with what they leave to be done with an item at the end of a robot's."""
    described, longer = problem.items[item], list(routes)
    if described.aboard is None and not any(task.item == item for task in routes[robot]):
        longer[robot] = (*longer[robot], Task(described.pickup.place, Action.PICK, item))
    longer[robot] = (*longer[robot], Task(described.delivery.place, Action.DROP, item))
    return longer


@given(st.integers(0, 10_000), st.booleans())
@settings(deadline=None, max_examples=sample(20, 60))
def test_item_has_a_conflict_where_it_breaks_some_robots_longer_route(
    seed: int, doors: bool
) -> None:
    problem = crowded(seed, doors=doors)
    sale = sell(problem, ((), ()), range(len(problem.items)))
    found = nearest_conflicts(problem, sale.routes, sale.unsold, {})
    assert set(found) == set(sale.unsold)
    for item, conflict in found.items():
        may = [
            robot
            for robot, described in enumerate(problem.robots)
            if problem.items[item].aboard in (None, robot)
            and problem.items[item].load <= described.capacity
        ]
        longer = [with_item_last(problem, sale.routes, robot, item) for robot in may]
        broken = [each for each in longer if TimedRoutes(problem, each, [*items_in(each)]).conflict]
        assert (conflict is not None) == bool(broken)
        tasks = {task for each in broken for route in each for task in route}
        assert conflict is None or {each.task for each in conflict.reasons} <= {None, *tasks}


@pytest.mark.parametrize(
    ("seed", "doors"), [(493, True), (3606, False), (6215, False), (7585, True), (9694, False)]
)
def test_bid_is_made_again_once_who_shares_a_transfer_has_more_to_do(
    seed: int, doors: bool
) -> None:
    problem = crowded(seed, doors=doors)
    sale = sell(problem, ((), ()), range(len(problem.items)))
    assert {*items_in(sale.routes)} | {*sale.unsold} == {*range(len(problem.items))}
    assert TimedRoutes(problem, sale.routes, items_in(sale.routes)).conflict is None


@pytest.mark.slow(seconds=3)
@given(st.integers(0, 10_000), st.booleans())
@settings(deadline=None, max_examples=sample(13, 40))
def test_what_a_trial_adds_is_timed_like_the_longer_routes_and_taken_back(
    seed: int, doors: bool
) -> None:
    problem = crowded(seed, doors=doors)
    sold = items_in(sell(problem, ((), ()), range(len(problem.items))).routes)
    for item in sold:
        routes = sell(problem, ((), ()), [each for each in sold if each != item]).routes
        timed = TimedRoutes(problem, routes, items_in(routes), homeward=False)
        aboard = problem.items[item].aboard
        for robot in (0, 1) if aboard is None else (aboard,):
            longer = with_item_last(problem, routes, robot, item)
            anew = TimedRoutes(problem, longer, items_in(longer))
            with timed.trial():
                timed.go_home(1 - robot)
                timed.append(robot, item)
                timed.go_home(robot)
                timed.wait_for_doors()
                assert (timed.conflict is None) == (anew.conflict is None)
                if timed.conflict is None:
                    assert times_s(timed) == pytest.approx(times_s(anew), abs=1e-5)
        before = TimedRoutes(problem, routes, items_in(routes), homeward=False)
        assert len(timed.network) == len(before.network)
        assert times_s(timed) == times_s(before)


def times_s(timed: TimedRoutes) -> list[float]:
    """The earliest times of the robots, one after the other."""
    return [
        timed.network.earliest_s(event)
        for robot, begins in enumerate(timed.begins)
        for event in (
            timed.leaves[robot],
            *begins,
            *([timed.ends[robot]] if robot in timed.ends else ()),
        )
    ]


def test_item_that_is_about_to_be_picked_up_is_its_robots_alone() -> None:
    urgent = Item("urgent", 1.0, Visit(3), Visit(0, Window(0.0, 39.0)))
    problem = corridor(items=(urgent, parcel("begun", 4, 1)))
    routes = ((Task(3, Action.PICK, 0),), (Task(4, Action.PICK, 1),))
    conflict = nearest_conflicts(problem, routes, (0,), {0: 0, 1: 1})[0]
    assert conflict is not None
    assert conflict.excess_s == pytest.approx(21.0)
    assert {each.robot for each in conflict.reasons if each.robot is not None} == {0}


def test_door_that_opens_too_late_is_told() -> None:
    robots = tuple(Robot(name, 0, None, 9.0, Window(30.0)) for name in ("one", "two"))
    urgent = Item("urgent", 1.0, Visit(0), Visit(4, Window(0.0, 75.0)))
    problem = replace(corridor(items=(urgent,), robots=robots), travel=travel_in(DOORS))
    conflict = nearest_conflicts(problem, ((), ()), (0,), {})[0]
    assert conflict is not None
    assert ConstraintKind.OPENING in {each.kind for each in conflict.reasons}


def test_load_alone_leaves_no_conflict_to_be_told() -> None:
    heavy = Item("heavy", 5.0, Visit(0), Visit(4, Window(0.0, 5.0)))
    problem = corridor(items=(heavy, parcel("light")))
    found = nearest_conflicts(problem, ((), ()), (0, 1), {})
    assert found == {0: None, 1: None}


def test_failed_robot_has_every_item_told_by_its_own_time_from_one_network(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """However many items have no place: to time every route anew for each would take seconds."""
    networks: list[TimedRoutes] = []

    def timed(problem: Problem, *args: object, **options: bool) -> TimedRoutes:
        networks.append(TimedRoutes(problem, *args, **options))  # type: ignore[arg-type]
        return networks[-1]

    monkeypatch.setattr(no_place, "TimedRoutes", timed)
    robots = (Robot("near", 0, None, 9.0), *(Robot(f"far{n}", 4, 4, 9.0) for n in range(3)))
    items = [Item(f"item{n}", 1.0, Visit(1), Visit(0, Window(0.0, 25.0 + n))) for n in range(5)]
    fleet = RunningFleet(corridor(items=tuple(items), robots=robots))
    outcome = fleet.apply(RobotFailed("near"), 1.0)
    assert set(outcome.put_off) == {item.name for item in items}
    for n, item in enumerate(items):
        assert f"to drop {item.name} at a must begin by {25 + n} s" in outcome.put_off[item.name]
    assert len(networks) == 1
