"""Another robot does the leg of one whose way is barred, where that asks nothing more of people."""

import pytest
from dispatch_office import asked, dispatcher_for, fleet_of, make_leg, only_leg, visit
from hypothesis import given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.errors import NotFoundError
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import Finding, Found, Leg, LegEnd, LegOutcome
from mend.fleet.requests import RequestStatus
from mend.maps.building.building import (
    Building,
    BuildingDocument,
    Caller,
    Elevator,
    Floor,
    FloorPlace,
    Lane,
)

AB = Found(finding=Finding.BLOCKED, between=("a", "b"), by="r0")


def under_way(*starts: str, **fields: float) -> tuple[Dispatcher, Leg]:
    """The first robot, at `a`, is on its way to `b`."""
    dispatcher = dispatcher_for(*starts)
    dispatcher.submit(visit(place="b", **fields), 0.0)
    leg = only_leg(dispatcher, 0.0)
    assert leg.robot == "r0"
    return dispatcher, leg


def test_who_comes_from_the_other_side_takes_over() -> None:
    dispatcher, leg = under_way("a", "e")
    assert dispatcher.take_over(AB, 5.0) == "r1"
    assert dispatcher.legs_to_withdraw(5.0) == [leg]
    assert dispatcher.legs_to_begin(5.0) == [], "nobody does the same twice"
    dispatcher.ended(leg, LegEnd(outcome=LegOutcome.WITHDRAWN, at="a"), 6.0)
    instead = make_leg(dispatcher, 6.0, 40.0)
    assert (instead.robot, instead.place) == ("r1", "f/b")
    assert dispatcher.view("visit").status is RequestStatus.DONE
    taken = [change for change in dispatcher.log if "takes over" in change.reason]
    assert [change.reason for change in taken] == [
        "r1 takes over 'visit' from r0, which found no way between f/a and f/b"
    ]
    assert (taken[0].requests, taken[0].robots) == (("visit",), ("r0", "r1"))


def test_where_it_stands_counts_and_not_where_it_should_have_come_to() -> None:
    dispatcher, leg = under_way("a", "e")
    dispatcher.legs_to_begin(40.0)
    assert dispatcher.take_over(AB, 40.0) == "r1"
    places = dispatcher.building.graph.places
    assert places[dispatcher.fleet.robots["r0"].place].name == "f/a"
    dispatcher.ended(leg, LegEnd(outcome=LegOutcome.WITHDRAWN, at="a"), 41.0)
    assert make_leg(dispatcher, 41.0, 40.0).robot == "r1"


def test_the_way_counts_as_open_again_soon() -> None:
    dispatcher, _ = under_way("a", "e")
    dispatcher.take_over(AB, 5.0)
    assert list(dispatcher.closed_until_s().values()) == [600.0]


def stays(dispatcher: Dispatcher, found: Found, now_s: float) -> None:
    """People are asked: nobody takes over, and nothing else has changed."""
    dispatcher.legs_to_begin(now_s)
    before = dispatcher.snapshot()
    assert dispatcher.take_over(found, now_s) is None
    assert dispatcher.snapshot() == before


def test_where_nobody_else_works_people_are_asked() -> None:
    stays(under_way("a")[0], AB, 5.0)


def test_where_nobody_else_is_in_time_people_are_asked() -> None:
    stays(under_way("a", "e", latest_s=25.0)[0], AB, 5.0)


def test_where_everybody_is_before_the_same_barrier_people_are_asked() -> None:
    stays(under_way("a", "a")[0], AB, 5.0)


def test_who_would_have_to_leave_something_else_undone_takes_nothing_over() -> None:
    dispatcher, _ = under_way("a", "e")
    dispatcher.submit(asked("urgent", "e", "d", load=2.0, latest_s=30.0), 1.0)
    (busy,) = dispatcher.legs_to_begin(2.0)
    dispatcher.began(busy, 2.0)
    assert dispatcher.take_over(AB, 5.0) == "r1"
    stops = [stop.item for stop in dispatcher.fleet.stops()["r1"]]
    assert stops.index("visit") > stops.index("urgent")


def test_what_a_robot_has_aboard_is_nobody_elses() -> None:
    dispatcher = dispatcher_for("a", "e")
    dispatcher.submit(asked("tea", "a", "b"), 0.0)
    make_leg(dispatcher, 0.0, 5.0)
    bringing = only_leg(dispatcher, 5.0)
    assert bringing.robot == "r0"
    stays(dispatcher, AB, 6.0)


def test_who_carries_out_no_leg_has_nothing_to_give_up() -> None:
    dispatcher, _ = under_way("a", "e")
    stays(dispatcher, AB.model_copy(update={"by": "r1"}), 5.0)
    stays(dispatcher, AB.model_copy(update={"by": None}), 5.0)


def test_a_place_that_is_nowhere_is_refused() -> None:
    dispatcher, _ = under_way("a", "e")
    with pytest.raises(NotFoundError, match="no place 'cellar'"):
        dispatcher.take_over(AB.model_copy(update={"between": ("a", "cellar")}), 5.0)


@pytest.mark.parametrize(("called_by", "takes"), [(Caller.ROBOTS, "r1"), (Caller.PEOPLE, None)])
def test_nobody_has_people_call_an_elevator_so_that_others_need_not_be_asked(
    called_by: Caller, takes: str | None
) -> None:
    lower = Floor(
        places={"a": FloorPlace(x=0.0, y=0.0), "b": FloorPlace(x=10.0, y=0.0),
                "lift": FloorPlace(x=20.0, y=0.0)},
        lanes=(Lane(between=("a", "b")), Lane(between=("b", "lift"))),
    )  # fmt: skip
    upper = Floor(
        height=3.0,
        places={"lift": FloorPlace(x=20.0, y=0.0), "c": FloorPlace(x=30.0, y=0.0)},
        lanes=(Lane(between=("lift", "c")),),
    )
    lift = Elevator(stops={"1": "lift", "2": "lift"}, called_by=called_by)
    document = BuildingDocument(
        building="tower", floors={"1": lower, "2": upper}, elevators={"main": lift}
    )
    dispatcher = Dispatcher(Building(document), fleet_of("1/a", "2/c"))
    dispatcher.submit(visit(place="1/b"), 0.0)
    only_leg(dispatcher, 0.0)
    found = Found(finding=Finding.DOOR_CLOSED, between=("1/a", "1/b"), by="r0")
    assert dispatcher.take_over(found, 5.0) == takes


@given(
    st.lists(st.sampled_from("abcde"), min_size=2, max_size=4),
    st.lists(st.permutations("abcde").map(lambda all_: all_[:2]), min_size=1, max_size=3),
    st.lists(st.tuples(st.integers(0, 3), st.integers(0, 3)), min_size=1, max_size=12),
)
@settings(deadline=None, max_examples=sample(25, 100))
def test_whatever_is_taken_over_comes_to_its_end(
    starts: list[str], ways: list[list[str]], barred: list[tuple[int, int]]
) -> None:
    """Every barred lane has a leg taken over at most once: nothing goes round for ever."""
    dispatcher = dispatcher_for(*starts)
    for number, (origin, destination) in enumerate(ways):
        dispatcher.submit(asked(f"p{number}", origin, destination), 0.0)
    now_s, taken = 0.0, 0
    for robot, lane in barred:
        begin_all(dispatcher, now_s)
        now_s += 3.0
        found = Found(
            finding=Finding.BLOCKED,
            between=("abcde"[lane], "abcde"[lane + 1]),
            by=f"r{robot % len(starts)}",
        )
        taken += dispatcher.take_over(found, now_s) is not None
        for leg in dispatcher.legs_to_withdraw(now_s):
            dispatcher.ended(leg, LegEnd(outcome=LegOutcome.WITHDRAWN, at="c"), now_s)
    for _ in range(400):
        begin_all(dispatcher, now_s)
        now_s += 60.0
        for leg in dispatcher.legs_under_way():
            dispatcher.ended(leg, LegEnd(outcome=LegOutcome.DONE), now_s)
    assert {view.status for view in dispatcher.views()} == {RequestStatus.DONE}
    assert taken <= len(barred)


def begin_all(dispatcher: Dispatcher, now_s: float) -> None:
    while legs := dispatcher.legs_to_begin(now_s):
        dispatcher.began(legs[0], now_s)
