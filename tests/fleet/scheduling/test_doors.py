"""Doors with opening times: trips, times, checks and costs against a plain walk over the graph."""

import time
from dataclasses import replace
from math import inf

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.fleet.scheduling.building_travel import MAX_CHANGES, travel_in
from mend.fleet.scheduling.checker import check
from mend.fleet.scheduling.constraint import WHILE_OPEN
from mend.fleet.scheduling.exact.solve import solve_exactly
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.problem import Item, Problem, Robot, Visit, Window
from mend.fleet.scheduling.schedule import Action, Schedule, Task
from mend.fleet.scheduling.solution import UnsupportedError
from mend.fleet.scheduling.timing import Untimeable, earliest_schedule
from mend.fleet.scheduling.travel import Travel, TravelError
from mend.maps.navigation import NavigationGraph, Place, Way, WayKind

COUNT = 5
PLACES = tuple(Place(f"p{number}", float(number), 0.0) for number in range(COUNT))

spans = st.lists(
    st.tuples(st.integers(0, 40), st.integers(1, 40)).map(
        lambda pair: (float(pair[0]), float(pair[0] + pair[1]))
    ),
    max_size=2,
).map(tuple)


@st.composite
def graphs(draw: st.DrawFn) -> NavigationGraph:
    """Five places and up to eight ways, some of them doors."""
    ends = st.tuples(st.integers(0, COUNT - 1), st.integers(0, COUNT - 1))
    pairs = draw(st.lists(ends.filter(lambda pair: pair[0] != pair[1]), min_size=2, max_size=8))
    return NavigationGraph(
        PLACES,
        [
            Way(f"p{a}", f"p{b}", WayKind.DOOR, float(draw(st.integers(1, 15))), open_s=draw(spans))
            for a, b in pairs
        ],
    )


def arrival_within(
    graph: NavigationGraph, origin: int, leaves_s: float, until_s: float
) -> list[float]:
    """When one is everywhere at the earliest, through ways that stay open until `until_s`."""
    arrival_s = [inf] * COUNT
    arrival_s[origin] = leaves_s
    for _ in range(COUNT):
        for way in graph.ways:
            if way.passable(leaves_s, until_s):
                a, b = graph.index(way.a), graph.index(way.b)
                assert way.length_m is not None
                arrival_s[b] = min(arrival_s[b], arrival_s[a] + way.length_m)
                arrival_s[a] = min(arrival_s[a], arrival_s[b] + way.length_m)
    return [time_s if time_s <= until_s else inf for time_s in arrival_s]


def arrival_by_plain_search(graph: NavigationGraph, origin: int, leaves_s: float) -> list[float]:
    """The same over every later departure and every later change, one after the other."""
    changes_s = graph.changes_s()
    departures = [leaves_s, *(time_s for time_s in changes_s if time_s > leaves_s)]
    tried = [
        arrival_within(graph, origin, departure_s, until_s)
        for departure_s in departures
        for until_s in [*(time_s for time_s in changes_s if time_s >= departure_s), inf]
    ]
    return [min(times) for times in zip(*tried, strict=True)]


def arrival_walking(graph: NavigationGraph, origin: int, leaves_s: float) -> list[float]:
    """When one is everywhere at the earliest if one may wait at every place on the way."""
    arrival_s = [inf] * COUNT
    arrival_s[origin] = leaves_s
    for _ in range(COUNT):
        for way in graph.ways:
            for a, b in ((way.a, way.b), (way.b, way.a)):
                here, there = graph.index(a), graph.index(b)
                arrival_s[there] = min(arrival_s[there], _through(way, arrival_s[here]))
    return arrival_s


def _through(way: Way, at_s: float) -> float:
    assert way.length_m is not None
    if not way.open_s:
        return at_s + way.length_m
    begins = [(max(at_s, opens_s), closes_s) for opens_s, closes_s in way.open_s]
    return min(
        (b + way.length_m for b, closes in begins if b + way.length_m <= closes), default=inf
    )


@given(graphs(), st.integers(0, 60).map(float))
@settings(deadline=None)
def test_trip_equals_a_plain_search_and_never_beats_a_walk(
    graph: NavigationGraph, leaves_s: float
) -> None:
    travel = travel_in(graph)
    for origin in range(COUNT):
        plain = arrival_by_plain_search(graph, origin, leaves_s)
        walked = arrival_walking(graph, origin, leaves_s)
        trips = [travel.trip(origin, place, leaves_s) for place in range(COUNT)]
        assert [trip.arrival_s for trip in trips] == pytest.approx(plain)
        for trip, walked_s in zip(trips, walked, strict=True):
            assert trip.arrival_s >= walked_s - 1e-6


@given(graphs())
@settings(deadline=None)
def test_each_trip_is_longer_by_what_starting_takes_and_staying_is_not(
    graph: NavigationGraph,
) -> None:
    plain, longer = travel_in(graph), travel_in(graph, starts_s=2.0)
    trips = ~np.eye(COUNT, dtype=bool)
    assert longer.time_s[trips] == pytest.approx(plain.time_s[trips] + 2.0)
    assert not longer.time_s[~trips].any()
    assert np.array_equal(longer.distance_m, plain.distance_m)


@given(graphs(), st.integers(0, 60).map(float), st.integers(0, 20).map(float))
@settings(deadline=None)
def test_who_leaves_later_is_never_there_earlier(
    graph: NavigationGraph, leaves_s: float, later_s: float
) -> None:
    travel = travel_in(graph)
    for place in range(1, COUNT):
        first, second = (travel.trip(0, place, time_s) for time_s in (leaves_s, leaves_s + later_s))
        assert first.arrival_s <= second.arrival_s
        if second.arrival_s < inf:
            lasts_s = travel.shortest_lasting_s(0, place, leaves_s)
            assert second.arrival_s - (leaves_s + later_s) >= lasts_s - 1e-6


def deliveries(
    graph: NavigationGraph, ends: list[tuple[int, int]], robot: Robot, on_board_s: float = 60.0
) -> Problem:
    items = tuple(
        Item(f"i{number}", 1.0, Visit(a, service_s=1.0), Visit(b), max_on_board_s=on_board_s)
        for number, (a, b) in enumerate(ends)
    )
    names = tuple(place.name for place in PLACES)
    return Problem("doors", names, travel_in(graph), (robot,), items)


def one_after_another(problem: Problem) -> tuple[Task, ...]:
    return tuple(
        task
        for number, item in enumerate(problem.items)
        for task in (
            Task(item.pickup.place, Action.PICK, number),
            Task(item.delivery.place, Action.DROP, number),
        )
    )


def times_by_plain_search(graph: NavigationGraph, problem: Problem) -> list[float]:
    """When a robot that starts at 0 is at each stop, one after the other."""
    time_s, place, times = 0.0, problem.robots[0].start, []
    for task in one_after_another(problem):
        time_s = arrival_by_plain_search(graph, place, time_s)[task.place]
        times.append(time_s)
        if time_s == inf:
            break
        time_s += 1.0 if task.action is Action.PICK else 0.0
        place = task.place
    return times


@given(
    graphs(),
    st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4)), min_size=1, max_size=3),
    st.sampled_from((inf, 60.0, 25.0)),
)
@settings(deadline=None)
def test_schedules_through_doors_are_earliest_and_pass_the_checker(
    graph: NavigationGraph, ends: list[tuple[int, int]], duration_s: float
) -> None:
    robot = Robot("r", 0, None, 9.0, max_duration_s=duration_s)
    problem = deliveries(graph, ends, robot)
    timed = earliest_schedule(problem, (one_after_another(problem),))
    free = replace(problem, robots=(replace(robot, max_duration_s=inf),))
    plain = times_by_plain_search(graph, free)
    if isinstance(timed, Schedule):
        assert check(problem, timed) == []
        begins = [stop.begin_s for stop in timed.robots[0].stops]
        assert all(begin >= time_s - 1e-6 for begin, time_s in zip(begins, plain, strict=True))
        if duration_s == inf and all(
            drop - pick - 1.0 <= 60.0 for pick, drop in zip(plain[::2], plain[1::2], strict=True)
        ):
            assert begins == pytest.approx(plain, abs=1e-5)
    elif duration_s == inf and plain[-1] < inf:
        carried = zip(plain[::2], plain[1::2], strict=True)
        assert any(drop - pick - 1.0 > 60.0 for pick, drop in carried)


DOOR = Way("p0", "p1", WayKind.DOOR, 10.0, open_s=((0.0, 5.0), (100.0, 200.0)))
DETOUR = Way("p0", "p1", length_m=300.0)


def test_robot_waits_for_the_door_rather_than_go_round() -> None:
    travel = travel_in(NavigationGraph(PLACES, (DOOR, DETOUR)))
    assert travel.trip(0, 1, 0.0) == pytest.approx((110.0, 10.0))
    assert travel.trip(0, 1, 190.0) == pytest.approx((200.0, 10.0))
    assert travel.trip(0, 1, 191.0) == pytest.approx((491.0, 300.0))


def test_distance_is_that_of_the_way_which_was_open() -> None:
    graph = NavigationGraph(PLACES, (DOOR, DETOUR))
    late = replace(Robot("r", 0, None, 1.0), shift=Window(250.0))
    for robot, distance_m in ((Robot("r", 0, None, 1.0), 10.0), (late, 300.0)):
        problem = deliveries(graph, [(0, 1)], robot, inf)
        timed = earliest_schedule(problem, (one_after_another(problem),))
        assert isinstance(timed, Schedule)
        assert cost(problem, timed).distance_m == distance_m


def test_checker_sees_who_went_through_a_closed_door() -> None:
    closed = deliveries(NavigationGraph(PLACES, (DOOR,)), [(0, 1)], Robot("r", 0, None, 1.0))
    always = deliveries(
        NavigationGraph(PLACES, (replace(DOOR, open_s=()),)), [(0, 1)], Robot("r", 0, None, 1.0)
    )
    timed = earliest_schedule(always, (one_after_another(always),))
    assert isinstance(timed, Schedule)
    assert check(always, timed) == []
    assert "r cannot be there to drop i0 at 11 s" in check(closed, timed)


def test_door_that_closes_for_good_is_the_reason() -> None:
    graph = NavigationGraph(PLACES, (replace(DOOR, open_s=((0.0, 5.0),)),))
    problem = deliveries(graph, [(0, 1)], Robot("r", 0, None, 1.0))
    timed = earliest_schedule(problem, (one_after_another(problem),))
    assert isinstance(timed, Untimeable)
    assert f"r can get there to drop i0 at p1 {WHILE_OPEN}" in timed.sentence(problem)


def test_way_that_is_never_there_is_no_schedule() -> None:
    apart = np.array([[0.0, inf], [inf, 0.0]])
    item = Item("far", 1.0, Visit(0), Visit(1))
    problem = Problem("two", ("a", "b"), Travel(apart, apart), (Robot("r", 0, None, 1.0),), (item,))
    timed = earliest_schedule(problem, (one_after_another(problem),))
    assert isinstance(timed, Untimeable)


def test_exact_method_says_that_it_knows_no_doors() -> None:
    problem = deliveries(NavigationGraph(PLACES, (DOOR,)), [(0, 1)], Robot("r", 0, None, 1.0))
    with pytest.raises(UnsupportedError, match="doors that open and close"):
        solve_exactly(problem, seconds=1.0, clock=time.perf_counter)


def test_too_many_changes_are_refused() -> None:
    times = [(float(2 * number), float(2 * number + 1)) for number in range(1, MAX_CHANGES)]
    graph = NavigationGraph(PLACES, (replace(DOOR, open_s=tuple(times)),))
    with pytest.raises(TravelError, match="48 are possible"):
        travel_in(graph)
