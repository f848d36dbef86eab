"""What single events do to a fleet at work: who is replanned, and what the sentences say."""

from dataclasses import replace
from math import inf

import pytest
from delivery_problems import corridor, parcel

from mend.fleet.scheduling.building_travel import travel_in
from mend.fleet.scheduling.problem import Item, Robot, Transfers, Visit, Window
from mend.fleet.scheduling.replanning.events import (
    Cancelled,
    DoorClosed,
    Event,
    EventError,
    NewItem,
    RobotBack,
    RobotDelayed,
    RobotFailed,
    TimePassed,
    WayBlocked,
    WayOpen,
)
from mend.fleet.scheduling.replanning.item_state import ItemState, ItemStateError, TrackedItem
from mend.fleet.scheduling.replanning.open_ways import OpenWays
from mend.fleet.scheduling.replanning.running_fleet import RunningFleet
from mend.fleet.scheduling.schedule import Action
from mend.maps.navigation import NavigationGraph, Place, Way, WayKind

FREE = (Robot("left", 0, None, 2.0), Robot("right", 4, None, 2.0))


def fleet_with(*items: Item, robots: tuple[Robot, ...] = FREE) -> RunningFleet:
    return RunningFleet(corridor(items=items, robots=robots, transfers=Transfers((2,))))


def stops(fleet: RunningFleet, robot: str) -> list[str]:
    return [f"{stop.action} {stop.item} at {stop.place}" for stop in fleet.stops()[robot]]


def test_new_item_changes_only_who_gets_it() -> None:
    fleet = fleet_with(parcel("far", 4, 3))
    outcome = fleet.apply(NewItem(parcel("near", 0, 1)), 1.0)
    assert outcome.changed == {"left"}
    assert stops(fleet, "left") == ["pick near at a", "drop near at b"]
    assert stops(fleet, "right") == ["drop far at d"]


def test_robot_first_makes_the_stop_that_it_is_on_its_way_to() -> None:
    fleet = fleet_with(parcel("late", 3, 4), robots=FREE[:1])
    fleet.apply(NewItem(parcel("on_the_way", 1, 2)), 2.0)
    assert stops(fleet, "left")[0] == "pick late at d"
    waiting = fleet_with(parcel("late", 3, 4), robots=FREE[:1])
    waiting.apply(NewItem(parcel("on_the_way", 1, 2)), 0.0)
    assert stops(waiting, "left")[0] == "pick late at d"


def test_item_that_cannot_be_in_time_is_refused_and_the_plan_kept() -> None:
    fleet = fleet_with(parcel("first", 1, 4))
    before = fleet.stops()
    late = Item("late", 1.0, Visit(4), Visit(0, Window(0.0, 30.0)))
    outcome = fleet.apply(NewItem(late), 0.0)
    assert "to drop late at a must begin by 30 s" in outcome.refused["late"]
    assert outcome.changed == frozenset()
    assert fleet.items["late"].state is ItemState.REFUSED
    assert fleet.stops() == before


def test_item_that_is_too_heavy_is_refused() -> None:
    heavy = replace(parcel("heavy"), load=5.0)
    outcome = fleet_with().apply(NewItem(heavy), 0.0)
    assert "no robot carries more than 2" in outcome.refused["heavy"]


def test_item_is_handed_over_where_a_robot_alone_has_no_time() -> None:
    robots = tuple(replace(robot, end=robot.start, max_duration_s=45.0) for robot in FREE)
    fleet = fleet_with(robots=robots)
    outcome = fleet.apply(NewItem(parcel()), 0.0)
    assert outcome.changed == {"left", "right"}
    fleet.advance(100.0)
    assert [done.action for done in fleet.log] == [
        Action.PICK, Action.GIVE, Action.TAKE, Action.DROP,
    ]  # fmt: skip
    assert fleet.items["parcel"].state is ItemState.DELIVERED


def test_cancelled_item_leaves_the_plan() -> None:
    fleet = fleet_with(parcel("first", 1, 2), parcel("other", 4, 3))
    outcome = fleet.apply(Cancelled("first"), 3.0)
    assert outcome.changed == {"left"}
    assert fleet.items["first"].state is ItemState.CANCELLED
    assert stops(fleet, "left") == []


def test_cancelled_item_on_board_goes_back() -> None:
    fleet = fleet_with(parcel("first", 0, 4))
    fleet.apply(Cancelled("first"), 5.0)
    assert stops(fleet, "left") == ["drop first at a"]
    fleet.advance(200.0)
    assert fleet.items["first"].state is ItemState.CANCELLED
    with pytest.raises(EventError, match="no item 'first' that could be cancelled"):
        fleet.apply(Cancelled("first"), 201.0)


def test_delay_moves_times_and_not_routes() -> None:
    due = Item("parcel", 1.0, Visit(1), Visit(2, Window(0.0, 50.0)))
    fleet = fleet_with(due)
    assert fleet.stops()["left"][0].slack_s == pytest.approx(30.0)
    outcome = fleet.apply(RobotDelayed("left", 12.0), 4.0)
    assert outcome.changed == frozenset()
    first, second = fleet.stops()["left"]
    assert (first.begin_s, second.begin_s) == (pytest.approx(22.0), pytest.approx(32.0))
    assert second.slack_s == pytest.approx(18.0)
    fleet.advance(40.0)
    assert [done.begin_s for done in fleet.log] == [pytest.approx(22.0), pytest.approx(32.0)]


def test_delay_that_costs_an_item_its_time_gives_it_to_another_robot() -> None:
    first = parcel("first", 1, 0)
    urgent = Item("urgent", 1.0, Visit(2), Visit(1, Window(0.0, 60.0)))
    fleet = fleet_with(first, urgent)
    assert "pick urgent at c" in stops(fleet, "left")
    outcome = fleet.apply(RobotDelayed("left", 60.0), 1.0)
    assert "right" in outcome.changed
    assert "pick urgent at c" in stops(fleet, "right")
    assert not outcome.put_off


def test_delay_that_makes_an_item_late_offers_it_again() -> None:
    due = Item("due", 1.0, Visit(2), Visit(1, due_s=60.0))
    one_at_a_time = tuple(replace(robot, capacity=1.0) for robot in FREE)
    fleet = fleet_with(parcel("first", 0, 1), due, robots=one_at_a_time)
    assert "pick due at c" in stops(fleet, "left")
    outcome = fleet.apply(RobotDelayed("left", 90.0), 1.0)
    assert outcome.changed == {"left", "right"}
    assert "pick due at c" in stops(fleet, "right")


def test_item_on_board_that_cannot_be_in_time_goes_late_with_a_sentence() -> None:
    urgent = Item("urgent", 1.0, Visit(0), Visit(4, Window(0.0, 60.0)))
    fleet = fleet_with(urgent, robots=FREE[:1])
    outcome = fleet.apply(RobotDelayed("left", 100.0), 10.0)
    assert "to drop urgent at e must begin by 60 s" in outcome.late["urgent"]
    fleet.advance(300.0)
    assert fleet.items["urgent"].state is ItemState.DELIVERED


def test_item_that_waits_and_cannot_be_in_time_any_more_is_put_off() -> None:
    urgent = Item("urgent", 1.0, Visit(3), Visit(4, Window(0.0, 60.0)))
    fleet = fleet_with(parcel("other", 0, 1), urgent, robots=FREE[:1])
    outcome = fleet.apply(RobotDelayed("left", 100.0), 5.0)
    assert set(outcome.put_off) == {"urgent"}
    assert stops(fleet, "left") == ["drop other at b"]


def test_items_of_a_failed_robot_are_fetched_from_where_it_stands() -> None:
    fleet = fleet_with(parcel("aboard", 0, 4), parcel("waiting", 1, 3))
    outcome = fleet.apply(RobotFailed("left"), 3.0)
    assert outcome.changed >= {"right"}
    assert sorted(stops(fleet, "right")) == [
        "drop aboard at e", "drop waiting at d", "pick aboard at a", "pick waiting at b",
    ]  # fmt: skip
    fleet.advance(500.0)
    assert {item.state for item in fleet.items.values()} == {ItemState.DELIVERED}


def test_items_that_are_lost_with_a_robot_are_not_fetched() -> None:
    fleet = fleet_with(parcel("aboard", 0, 4), parcel("waiting", 1, 3))
    fleet.apply(RobotFailed("left", frozenset({"aboard"})), 3.0)
    assert fleet.items["aboard"].state is ItemState.LOST
    assert sorted(stops(fleet, "right")) == ["drop waiting at d", "pick waiting at b"]


def test_without_robots_items_wait_until_one_is_back() -> None:
    fleet = fleet_with(parcel("aboard", 0, 4), robots=FREE[:1])
    outcome = fleet.apply(RobotFailed("left"), 3.0)
    assert outcome.put_off == {"aboard": "no robot works"}
    assert fleet.plan() is None
    assert fleet.apply(NewItem(parcel("more")), 4.0).refused == {"more": "no robot works"}
    fleet.apply(RobotBack("left", "c"), 10.0)
    assert stops(fleet, "left") == ["drop aboard at e"]


def test_robot_too_late_for_its_shift_says_so_and_gets_home() -> None:
    robot = Robot("left", 0, 0, 2.0, Window(0.0, 100.0))
    fleet = fleet_with(parcel("aboard", 0, 4), robots=(robot,))
    outcome = fleet.apply(RobotDelayed("left", 40.0), 5.0)
    assert outcome.overtime == {
        "left": "left had to be at its end by 100 s, but cannot be there before 120 s"
    }
    fleet.advance(300.0)
    assert fleet.items["aboard"].state is ItemState.DELIVERED


# --- ways that close ----------------------------------------------------------------------------


def ring(*items: Item, start: int = 0) -> RunningFleet:
    """A row of places, a to d, 10 m apart; e is a detour between b and c of 30 m."""
    graph = NavigationGraph(
        [Place(name, 10.0 * n, 0.0) for n, name in enumerate("abcd")] + [Place("e", 15.0, 9.0)],
        [
            Way("a", "b"), Way("b", "c", WayKind.DOOR), Way("c", "d"),
            Way("b", "e", length_m=15.0), Way("e", "c", length_m=15.0),
        ],
    )  # fmt: skip
    problem = corridor(items=items, robots=(Robot("left", start, None, 2.0),))
    problem = replace(problem, transfers=Transfers(), travel=travel_in(graph))
    return RunningFleet(problem, ways=OpenWays(graph, 1.0))


def test_robot_goes_around_a_blocked_way() -> None:
    fleet = ring(parcel("parcel", 0, 3))
    assert fleet.stops()["left"][-1].begin_s == pytest.approx(30.0)
    fleet.apply(WayBlocked(("b", "c")), 5.0)
    assert fleet.stops()["left"][-1].begin_s == pytest.approx(50.0)
    fleet.apply(WayOpen(("c", "b")), 8.0)
    assert fleet.stops()["left"][-1].begin_s == pytest.approx(30.0)
    fleet.advance(100.0)
    assert fleet.items["parcel"].state is ItemState.DELIVERED


def test_robot_in_a_way_that_is_blocked_turns_round() -> None:
    fleet = ring(parcel("parcel", 0, 3))
    fleet.apply(WayBlocked(("b", "c")), 14.0)
    assert fleet.stops()["left"][-1].begin_s == pytest.approx(18.0 + 40.0)


def test_item_behind_a_blocked_way_is_put_off_until_it_opens() -> None:
    fleet = ring(parcel("parcel", 1, 3), parcel("near", 1, 0))
    outcome = fleet.apply(WayBlocked(("c", "d")), 1.0)
    assert "there is no way from b to d" in outcome.put_off["parcel"]
    assert stops(fleet, "left") == ["pick near at b", "drop near at a"]
    fleet.apply(WayOpen(("c", "d")), 30.0)
    fleet.advance(200.0)
    assert {item.state for item in fleet.items.values()} == {ItemState.DELIVERED}


def test_robot_does_something_else_until_a_closed_door_is_tried_again() -> None:
    fleet = ring(parcel("behind", 1, 3), parcel("near", 1, 0))
    fleet.apply(WayBlocked(("b", "e")), 0.0)
    fleet.apply(DoorClosed(("b", "c"), 60.0), 12.0)
    fleet.advance(59.0)
    assert fleet.items["near"].state is ItemState.DELIVERED
    fleet.advance(200.0)
    last = fleet.log[-1]
    assert (last.item, last.action) == ("behind", Action.DROP)
    assert last.begin_s >= 72.0 + 20.0


def test_events_that_make_no_sense_are_told_and_change_nothing() -> None:
    fleet = fleet_with(parcel("first", 1, 4))
    before = fleet.stops()
    wrong: list[tuple[Event, str]] = [
        (NewItem(parcel("first")), "there is an item 'first' already"),
        (NewItem(parcel("new", 0, 77)), "is at place 77, which does not exist"),
        (NewItem(parcel("new", aboard=0)), "nobody can have it aboard"),
        (Cancelled("nothing"), "no item 'nothing'"),
        (RobotDelayed("nobody", 1.0), "there is no robot 'nobody'"),
        (RobotDelayed("left", -1.0), "at least 0 s"),
        (RobotDelayed("left", inf), "finite"),
        (RobotFailed("left", frozenset({"first"})), "does not have first on board"),
        (RobotBack("left", "a"), "works already"),
        (WayBlocked(("a", "b")), "the ways between the places are not known"),
        (DoorClosed(("a", "b"), 0.0), "more than 0 s"),
    ]
    for event, why in wrong:
        with pytest.raises(EventError, match=why):
            fleet.apply(event, 0.0)
    assert fleet.stops() == before
    fleet.advance(10.0)
    with pytest.raises(EventError, match="it is 10 s already"):
        fleet.apply(TimePassed(), 5.0)
    with pytest.raises(EventError, match="no way between a and c"):
        ring().apply(WayBlocked(("a", "c")), 0.0)


def test_item_states_follow_one_another_or_raise() -> None:
    item = TrackedItem(parcel())
    with pytest.raises(ItemStateError, match="'parcel' is waiting; it cannot become delivered"):
        item.close(ItemState.DELIVERED)
    item.load(0, 3.0)
    item.leave(2, 8.0)
    item.load(1, 9.0)
    assert item.loaded_s == 3.0
    item.close(ItemState.DELIVERED)
    assert not item.open
