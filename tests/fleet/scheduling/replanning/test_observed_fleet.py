"""A fleet whose stops are made when somebody says so: lateness, going early, and what fails."""

import pytest
from delivery_problems import corridor, parcel

from mend.fleet.scheduling.problem import Item, Robot, Transfers, Visit, Window
from mend.fleet.scheduling.replanning.events import (
    Cancelled,
    Event,
    EventError,
    Fetched,
    ItemLost,
    NewItem,
    RobotFailed,
    RobotMoved,
    SetOut,
    StopBegun,
    StopFailed,
    StopMade,
    Stranded,
)
from mend.fleet.scheduling.replanning.item_state import ItemState
from mend.fleet.scheduling.replanning.running_fleet import Outcome, RunningFleet
from mend.fleet.scheduling.schedule import Action, Schedule, Task
from mend.fleet.scheduling.timing import earliest_schedule

TWO = (Robot("left", 0, None, 2.0), Robot("right", 4, None, 2.0))
ALONE = TWO[:1]


def observed(*items: Item, robots: tuple[Robot, ...] = TWO) -> RunningFleet:
    problem = corridor(items=items, robots=robots, transfers=Transfers((2,)))
    return RunningFleet(problem, observed=True)


def happen(fleet: RunningFleet, now_s: float, *events: Event) -> Outcome:
    """Several things at the same time; what came of the last."""
    outcome = Outcome()
    for event in events:
        outcome = fleet.apply(event, now_s)
    return outcome


def stops(fleet: RunningFleet, robot: str) -> list[str]:
    return [f"{stop.action} {stop.item} at {stop.place}" for stop in fleet.stops()[robot]]


def test_nothing_is_done_before_somebody_says_so() -> None:
    fleet = observed(parcel("first", 0, 4), robots=ALONE)
    fleet.advance(1000.0)
    assert fleet.items["first"].state is ItemState.WAITING
    assert [stop.begin_s for stop in fleet.stops()["left"]] == [1000.0, 1040.0]


def test_what_is_said_to_be_made_is_made_then() -> None:
    fleet = observed(parcel("first", 1, 4), robots=ALONE)
    happen(fleet, 5.0, SetOut("left"))
    happen(fleet, 25.0, StopMade("left"))
    assert fleet.items["first"].robot == 0
    assert fleet.stops()["left"][0].begin_s == pytest.approx(55.0)
    happen(fleet, 30.0, SetOut("left"))
    happen(fleet, 80.0, StopMade("left"))
    assert fleet.items["first"].state is ItemState.DELIVERED
    assert [done.begin_s for done in fleet.log] == [25.0, 80.0]


def test_robot_that_is_late_pushes_what_comes_after() -> None:
    fleet = observed(parcel("first", 1, 4), robots=ALONE)
    happen(fleet, 0.0, SetOut("left"))
    assert fleet.stops()["left"][0].begin_s == pytest.approx(10.0)
    fleet.advance(25.0)
    assert [stop.begin_s for stop in fleet.stops()["left"]] == pytest.approx([25.0, 55.0])


def test_robot_that_is_early_goes_on_early() -> None:
    fleet = observed(parcel("first", 4, 0), robots=ALONE)
    happen(fleet, 0.0, SetOut("left"))
    happen(fleet, 12.0, StopBegun("left"), StopMade("left"))
    assert fleet.stops()["left"][0].begin_s == pytest.approx(52.0)


def test_lateness_gives_an_item_to_a_robot_that_is_in_time() -> None:
    urgent = Item("urgent", 1.0, Visit(1), Visit(2, Window(0.0, 60.0)))
    robots = (Robot("left", 0, None, 1.0), Robot("right", 4, None, 1.0, speed=8.0))
    fleet = observed(parcel("first", 0, 1), urgent, robots=robots)
    assert "pick urgent at b" in stops(fleet, "left")
    happen(fleet, 0.0, SetOut("left"), StopMade("left"), SetOut("left"))
    outcomes = [fleet.advance(now_s) for now_s in (20.0, 45.0, 52.0)]
    assert any("right" in each.changed for each in outcomes)
    assert "pick urgent at b" in stops(fleet, "right")
    assert not any(each.put_off for each in outcomes)


def test_robots_without_a_part_in_it_keep_their_plan() -> None:
    fleet = observed(parcel("here", 0, 1), parcel("there", 4, 3))
    happen(fleet, 0.0, SetOut("left"), SetOut("right"))
    assert all("right" not in fleet.advance(now_s).changed for now_s in (50.0, 100.0, 500.0))


def test_stop_that_failed_is_tried_again_when_it_may() -> None:
    fleet = observed(parcel("first", 1, 4), robots=ALONE)
    happen(fleet, 0.0, SetOut("left"))
    happen(fleet, 10.0, StopFailed("left", "b", 100.0))
    assert fleet.stops()["left"][0].begin_s == pytest.approx(100.0)


def test_delivery_that_failed_is_tried_again_although_it_is_late_then() -> None:
    due = Item("due", 1.0, Visit(0), Visit(1, Window(0.0, 50.0)))
    fleet = observed(due, robots=ALONE)
    happen(fleet, 0.0, SetOut("left"), StopMade("left"), SetOut("left"))
    happen(fleet, 10.0, StopFailed("left", "b", 90.0))
    assert fleet.stops()["left"][0].begin_s == pytest.approx(90.0)


def test_pickup_that_failed_for_good_closes_the_item() -> None:
    fleet = observed(parcel("first", 1, 4), robots=ALONE)
    happen(fleet, 0.0, SetOut("left"))
    happen(fleet, 10.0, StopFailed("left", "b", None))
    assert fleet.items["first"].state is ItemState.CANCELLED


def test_delivery_that_failed_for_good_sends_the_item_back() -> None:
    fleet = observed(parcel("first", 0, 4), robots=ALONE)
    happen(fleet, 0.0, SetOut("left"), StopMade("left"), SetOut("left"))
    happen(fleet, 40.0, StopFailed("left", "e", None))
    assert stops(fleet, "left") == ["drop first at a"]


def test_pickup_is_not_tried_again_after_its_window() -> None:
    soon = Item("soon", 1.0, Visit(1, Window(0.0, 60.0)), Visit(4))
    fleet = observed(soon, robots=ALONE)
    happen(fleet, 0.0, SetOut("left"))
    with pytest.raises(EventError, match="must be picked up by 60 s"):
        happen(fleet, 10.0, StopFailed("left", "b", 100.0))


def test_visit_is_dealt_with_at_one_stop() -> None:
    fleet = observed(Item("hello", 0.0, Visit(3), Visit(3), direct=True), robots=ALONE)
    happen(fleet, 0.0, SetOut("left"))
    happen(fleet, 30.0, StopMade("left", closes=True))
    assert fleet.items["hello"].state is ItemState.DELIVERED
    assert stops(fleet, "left") == []


def test_what_is_taken_has_to_be_given_first() -> None:
    robots = tuple(Robot(r.name, r.start, r.start, 2.0, max_duration_s=45.0) for r in TWO)
    fleet = observed(robots=robots)
    fleet.apply(NewItem(parcel()), 0.0)
    assert stops(fleet, "right")[0] == "take parcel at c"
    happen(fleet, 0.0, SetOut("left"), StopMade("left"), SetOut("left"), SetOut("right"))
    with pytest.raises(EventError, match="was not left at c"):
        happen(fleet, 20.0, StopMade("right"))
    happen(fleet, 20.0, StopMade("left"), StopMade("right"))
    assert fleet.items["parcel"].robot == 1


def test_what_changes_robots_twice_is_taken_where_it_lies() -> None:
    robots = tuple(
        Robot(name, place, None, 2.0) for name, place in zip("ghi", (0, 1, 3), strict=True)
    )
    problem = corridor(items=(parcel(),), robots=robots, transfers=Transfers((1, 3)))
    start = (
        (Task(0, Action.PICK, 0), Task(1, Action.GIVE, 0, 1)),
        (Task(1, Action.TAKE, 0, 0), Task(3, Action.GIVE, 0, 2)),
        (Task(3, Action.TAKE, 0, 1), Task(4, Action.DROP, 0)),
    )
    schedule = earliest_schedule(problem, start)
    assert isinstance(schedule, Schedule)
    fleet = RunningFleet(problem, start=schedule, observed=True)
    happen(fleet, 0.0, SetOut("g"), StopMade("g"), SetOut("g"), SetOut("h"), SetOut("i"))
    happen(fleet, 10.0, StopMade("g"))
    assert fleet.is_there("h")
    assert not fleet.is_there("i")
    with pytest.raises(EventError, match="was not left at d"):
        happen(fleet, 10.0, StopMade("i"))


def test_item_cancelled_while_a_robot_goes_for_it_ends_with_that_stop() -> None:
    fleet = observed(parcel("first", 1, 4), robots=ALONE)
    happen(fleet, 0.0, SetOut("left"), Cancelled("first"))
    assert not fleet.robots["left"].held
    happen(fleet, 5.0, StopFailed("left", "a", 5.0))
    assert fleet.items["first"].state is ItemState.CANCELLED


def test_item_that_was_picked_up_all_the_same_goes_back() -> None:
    fleet = observed(parcel("first", 1, 4), robots=ALONE)
    happen(fleet, 0.0, SetOut("left"), Cancelled("first"))
    happen(fleet, 10.0, StopMade("left"))
    assert stops(fleet, "left") == ["drop first at b"]
    happen(fleet, 10.0, SetOut("left"), StopMade("left"))
    assert fleet.items["first"].state is ItemState.CANCELLED


def test_item_that_was_handed_over_before_it_was_cancelled_is_delivered() -> None:
    fleet = observed(parcel("first", 0, 1), robots=ALONE)
    happen(fleet, 0.0, SetOut("left"), StopMade("left"), SetOut("left"), Cancelled("first"))
    assert stops(fleet, "left") == ["drop first at a"]
    happen(fleet, 10.0, StopMade("left"))
    assert fleet.items["first"].state is ItemState.DELIVERED
    assert stops(fleet, "left") == []


def test_failed_robot_lies_where_it_is_said_to_stand() -> None:
    fleet = observed(parcel("aboard", 0, 4))
    happen(fleet, 0.0, SetOut("left"), StopMade("left"), SetOut("left"))
    happen(fleet, 15.0, RobotFailed("left", at="d"))
    assert stops(fleet, "right") == ["pick aboard at d", "drop aboard at e"]
    with pytest.raises(EventError, match="has not set out"):
        happen(fleet, 16.0, StopMade("left"))


def test_what_is_lost_is_in_no_plan() -> None:
    fleet = observed(parcel("first", 0, 4), robots=ALONE)
    happen(fleet, 0.0, SetOut("left"), StopMade("left"), ItemLost("first"))
    assert fleet.items["first"].state is ItemState.LOST
    assert stops(fleet, "left") == []


def test_what_is_stranded_takes_up_room_until_a_person_takes_it() -> None:
    big = Item("big", 2.0, Visit(0), Visit(4))
    fleet = observed(big, robots=ALONE)
    happen(fleet, 0.0, SetOut("left"), StopMade("left"), Stranded("big"))
    refused = fleet.fork().apply(NewItem(parcel("more")), 0.0).refused
    assert "no robot carries more than 0" in refused["more"]
    happen(fleet, 5.0, Fetched("big"))
    assert not fleet.apply(NewItem(parcel("more")), 5.0).refused


def test_what_has_no_room_beside_something_stranded_leaves_the_plan() -> None:
    fleet = observed(
        Item("first", 1.0, Visit(0), Visit(4)), Item("second", 2.0, Visit(2), Visit(3))
    )
    happen(fleet, 0.0, SetOut("left"), StopMade("left"), RobotFailed("right", at="e"))
    assert "pick second at c" in stops(fleet, "left")
    outcome = happen(fleet, 1.0, Stranded("first"))
    assert "second" in outcome.put_off
    assert stops(fleet, "left") == []


def test_robot_sets_out_for_one_thing_at_a_time() -> None:
    fleet = observed(parcel("first", 1, 4), robots=ALONE)
    happen(fleet, 0.0, SetOut("left"))
    with pytest.raises(EventError, match="has set out already"):
        happen(fleet, 1.0, SetOut("left"))


def test_fleet_that_does_what_is_planned_takes_no_stops() -> None:
    fleet = RunningFleet(corridor(items=(parcel(),), robots=ALONE))
    with pytest.raises(EventError, match="not observed"):
        fleet.apply(SetOut("left"), 0.0)


def test_resumed_fleet_is_equal() -> None:
    fleet = observed(parcel("first", 1, 4), parcel("other", 3, 2))
    happen(fleet, 3.0, SetOut("left"), SetOut("right"))
    happen(fleet, 14.0, StopMade("left"))
    again = RunningFleet.resumed(fleet.state())
    assert again.stops() == fleet.stops()
    for each in (fleet, again):
        happen(each, 20.0, StopMade("right"), Cancelled("first"))
    assert again.stops() == fleet.stops()


def test_items_that_are_closed_are_forgotten() -> None:
    fleet = observed(parcel("first", 0, 1), parcel("other", 1, 0), robots=ALONE)
    happen(fleet, 0.0, SetOut("left"), StopMade("left"), Cancelled("other"))
    before = fleet.stops()
    fleet.forget_closed()
    assert set(fleet.items) == {"first"}
    assert fleet.stops() == before
    happen(fleet, 1.0, SetOut("left"), StopMade("left"))
    assert fleet.items["first"].state is ItemState.DELIVERED


def test_item_that_may_not_change_robots_does_not() -> None:
    robots = tuple(Robot(r.name, r.start, r.start, 2.0, max_duration_s=45.0) for r in TWO)
    fleet = observed(robots=robots)
    refused = fleet.apply(NewItem(parcel("person", direct=True)), 0.0).refused
    assert "person" in refused


def test_who_made_way_is_planned_from_where_it_stands() -> None:
    fleet = observed(robots=ALONE)
    happen(fleet, 10.0, RobotMoved("left", "d"))
    fleet.apply(NewItem(parcel("first", 3, 4)), 20.0)
    assert fleet.stops()["left"][0].begin_s == pytest.approx(20.0)


def test_who_is_under_way_has_not_made_way() -> None:
    fleet = observed(parcel("first", 1, 4), robots=ALONE)
    happen(fleet, 5.0, SetOut("left"))
    with pytest.raises(EventError, match="does not stand there with nothing to do"):
        fleet.apply(RobotMoved("left", "d"), 6.0)
    with pytest.raises(EventError, match="there is no place"):
        observed(robots=ALONE).apply(RobotMoved("left", "z"), 6.0)
