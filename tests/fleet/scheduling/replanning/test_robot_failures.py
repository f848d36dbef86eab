"""Robots that fail with things in their baskets and work again: where those things are then."""

from dataclasses import dataclass, field

import pytest
from delivery_problems import corridor, parcel
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.fleet.scheduling.problem import Item, Robot, Transfers, Visit
from mend.fleet.scheduling.replanning.events import (
    Event,
    EventError,
    NewItem,
    RobotBack,
    RobotFailed,
    RobotMoved,
    SetOut,
    StopFailed,
    StopMade,
    Stranded,
)
from mend.fleet.scheduling.replanning.item_state import ItemState
from mend.fleet.scheduling.replanning.running_fleet import RunningFleet
from mend.fleet.scheduling.schedule import Action

PLACES = "abcde"
TWO = (Robot("left", 0, None, 2.0), Robot("right", 4, None, 2.0))


def observed(*items: Item, robots: tuple[Robot, ...] = TWO) -> RunningFleet:
    problem = corridor(items=items, robots=robots, transfers=Transfers((2,)))
    return RunningFleet(problem, observed=True)


def happen(fleet: RunningFleet, now_s: float, *events: Event) -> None:
    for event in events:
        fleet.apply(event, now_s)


def stops(fleet: RunningFleet, robot: str) -> list[str]:
    return [f"{stop.action} {stop.item} at {stop.place}" for stop in fleet.stops()[robot]]


def failed_at_b(*more: Item) -> RunningFleet:
    """The left robot has a parcel for e aboard and has failed at b."""
    fleet = observed(parcel("first", 0, 4), *more)
    happen(fleet, 0.0, SetOut("left"), StopMade("left"), SetOut("left"))
    happen(fleet, 10.0, RobotFailed("left", at="b"))
    return fleet


def test_what_is_still_in_its_basket_is_aboard_again() -> None:
    fleet = failed_at_b()
    assert stops(fleet, "right") == ["pick first at b", "drop first at e"]
    assert fleet.items["first"].held_by == 0
    happen(fleet, 15.0, RobotBack("left", "b"))
    item = fleet.items["first"]
    assert (item.state, item.robot, item.held_by) == (ItemState.ABOARD, 0, None)
    assert stops(fleet, "left") == ["drop first at e"]
    assert stops(fleet, "right") == []


def test_where_it_is_moved_to_it_is_fetched() -> None:
    fleet = failed_at_b()
    happen(fleet, 11.0, SetOut("right"))
    happen(fleet, 12.0, RobotMoved("left", "c"))
    assert fleet.items["first"].held_by == 0
    assert not fleet.robots["right"].held, "it was on its way to where nothing is any more"
    happen(fleet, 13.0, StopFailed("right", "d", 13.0))
    assert stops(fleet, "right") == ["pick first at c", "drop first at e"]
    happen(fleet, 15.0, RobotBack("left", "c"))
    assert stops(fleet, "left") == ["drop first at e"]


def test_who_is_under_way_to_fetch_it_is_called_off() -> None:
    fleet = failed_at_b()
    happen(fleet, 11.0, SetOut("right"))
    happen(fleet, 15.0, RobotBack("left", "c"))
    assert not fleet.robots["right"].held
    happen(fleet, 16.0, StopFailed("right", "d", 16.0))
    assert stops(fleet, "left") == ["drop first at e"]
    assert fleet.taken_out() == {"left": frozenset(), "right": frozenset()}


def test_what_was_fetched_meanwhile_stays_with_who_has_it() -> None:
    fleet = failed_at_b()
    happen(fleet, 11.0, SetOut("right"))
    happen(fleet, 50.0, StopMade("right"), RobotBack("left", "b"))
    assert fleet.items["first"].robot == 1
    assert stops(fleet, "left") == []
    assert fleet.taken_out()["left"] == {"first"}


def test_what_was_fetched_just_as_its_robot_came_back_is_with_who_has_it() -> None:
    fleet = failed_at_b()
    happen(fleet, 11.0, SetOut("right"))
    happen(fleet, 50.0, RobotBack("left", "b"))
    assert not fleet.is_there("right")
    assert fleet.may_have_loaded("right")
    happen(fleet, 51.0, StopMade("right"))
    assert fleet.items["first"].robot == 1
    assert (stops(fleet, "left"), stops(fleet, "right")) == ([], ["drop first at e"])
    assert fleet.taken_out()["left"] == {"first"}


def test_what_is_to_be_given_first_is_taken_out_of_no_basket() -> None:
    robots = tuple(Robot(r.name, r.start, r.start, 2.0, max_duration_s=45.0) for r in TWO)
    fleet = observed(robots=robots)
    fleet.apply(NewItem(parcel()), 0.0)
    happen(fleet, 0.0, SetOut("left"), StopMade("left"), SetOut("left"), SetOut("right"))
    assert not fleet.may_have_loaded("right")
    with pytest.raises(EventError, match="was not left at c"):
        happen(fleet, 20.0, StopMade("right"))


def test_who_has_it_again_has_not_been_robbed_of_it() -> None:
    fleet = failed_at_b()
    happen(fleet, 11.0, SetOut("right"))
    happen(fleet, 50.0, StopMade("right"), RobotBack("left", "b"))
    happen(fleet, 60.0, RobotFailed("right", at="c"))
    assert stops(fleet, "left") == ["pick first at c", "drop first at e"]
    assert fleet.taken_out()["left"] == {"first"}
    happen(fleet, 60.0, SetOut("left"))
    assert fleet.taken_out()["left"] == frozenset(), "it may have it again at any moment"
    happen(fleet, 70.0, StopMade("left"))
    assert fleet.taken_out() == {"left": frozenset(), "right": {"first"}}


def test_what_is_stranded_takes_up_room_in_its_robot_again() -> None:
    fleet = observed(Item("big", 2.0, Visit(0), Visit(4)), robots=TWO[:1])
    happen(fleet, 0.0, SetOut("left"), StopMade("left"), RobotFailed("left", at="b"))
    happen(fleet, 1.0, Stranded("big"), RobotBack("left", "b"))
    item = fleet.items["big"]
    assert (item.state, item.robot) == (ItemState.STRANDED, 0)
    refused = fleet.apply(NewItem(parcel("more")), 2.0).refused
    assert "no robot carries more than 0" in refused["more"]


def test_whom_a_robot_led_is_met_again() -> None:
    fleet = observed(parcel("guest", 0, 4, direct=True), robots=TWO[:1])
    happen(fleet, 0.0, SetOut("left"), StopMade("left"), SetOut("left"))
    happen(fleet, 10.0, RobotFailed("left", at="b"))
    happen(fleet, 15.0, RobotBack("left", "c"))
    assert stops(fleet, "left") == ["pick guest at b", "drop guest at e"]


def test_robot_that_comes_back_without_a_fleet_around_it_goes_on() -> None:
    fleet = observed(parcel("first", 0, 4), robots=TWO[:1])
    happen(fleet, 0.0, SetOut("left"), StopMade("left"), SetOut("left"))
    happen(fleet, 10.0, RobotFailed("left", at="b"))
    happen(fleet, 500.0, RobotBack("left", "d"))
    assert fleet.items["first"].put_off is None
    assert fleet.stops()["left"][0].begin_s == pytest.approx(510.0)


def test_what_is_not_put_down_at_once_is_put_down_before_there_is_no_room_for_it() -> None:
    items = (parcel("first", 0, 0), parcel("second", 0, 1), parcel("third", 1, 1))
    fleet = observed(*items, robots=(Robot("left", 4, None, 2.0),))
    happen(fleet, 0.0, SetOut("left"), StopMade("left"), SetOut("left"))
    happen(fleet, 35.0, StopFailed("left", "b", 35.0))
    assert {item.put_off for item in fleet.items.values()} == {None}
    assert {stop.item for stop in fleet.stops()["left"]} == set(fleet.items)


# --- whatever happens -----------------------------------------------------------------------------


@dataclass
class Baskets:
    """Where things really are, moved by what robots really do."""

    fleet: RunningFleet
    lies: dict[str, str]
    holder: dict[str, str] = field(default_factory=dict)
    delivered: list[str] = field(default_factory=list)
    believes: dict[str, set[str]] = field(default_factory=dict)
    """By robot, what it remembers having in its basket."""

    def do(self, robot: str, now_s: float) -> None:
        """A robot does what it has set out for, if it can be done, and says so."""
        doing = self.fleet.robots[robot].doing
        if doing is None:
            return
        name, place = self._named(doing.item), PLACES[doing.place]
        if doing.action is Action.TAKE and not self.fleet.is_there(robot):
            return
        if doing.action.loads:
            other = self.holder.get(name)
            assert other is not None or self.lies.pop(name, None) == place
            self.holder[name] = robot
            self.believes[robot].add(name)
        else:
            assert self.holder.pop(name, None) == robot
            self.believes[robot].discard(name)
            if doing.action is Action.GIVE:
                self.lies[name] = place
            else:
                self.delivered.append(name)
        self.fleet.apply(StopMade(robot), now_s)

    def give_up(self, robot: str, now_s: float) -> None:
        doing = self.fleet.robots[robot].doing
        if doing is not None:
            self.fleet.apply(StopFailed(robot, PLACES[doing.place], now_s), now_s)

    def tell(self) -> None:
        for robot, names in self.fleet.taken_out().items():
            self.believes[robot] -= names

    def check(self) -> None:
        """Nothing is lost or there twice, and who is told all misses nothing."""
        items = self.fleet.items
        assert len(set(self.delivered)) == len(self.delivered)
        assert {*self.lies, *self.holder, *self.delivered} == set(items)
        for number, robot in enumerate(self.fleet.robots):
            has = {name for name, who in self.holder.items() if who == robot}
            planned = {n for n, item in items.items() if number in (item.robot, item.held_by)}
            assert has == planned, robot
            self.tell()
            assert self.believes[robot] == has, robot

    def _named(self, number: int) -> str:
        return list(self.fleet.items)[number]


ROBOTS = ("left", "middle", "right")
ACTS = ("set_out", "do", "give_up", "fail", "back")


@given(
    st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4)), min_size=1, max_size=3),
    st.lists(
        st.tuples(st.sampled_from(ROBOTS), st.sampled_from(ACTS), st.sampled_from(PLACES)),
        max_size=30,
    ),
)
@example(
    [(0, 0), (0, 1), (1, 1)],
    [
        ("left", "fail", "a"),
        ("middle", "fail", "a"),
        ("right", "set_out", "a"),
        ("right", "do", "a"),
        ("right", "set_out", "a"),
    ],
)
@settings(deadline=None, max_examples=sample(50, 150), suppress_health_check=[HealthCheck.too_slow])
def test_nothing_is_lost_or_brought_twice_whoever_fails_and_comes_back(
    ways: list[tuple[int, int]], acts: list[tuple[str, str, str]]
) -> None:
    parcels = [parcel(f"p{n}", *way) for n, way in enumerate(ways)]
    robots = tuple(Robot(name, 2 * n, None, 2.0) for n, name in enumerate(ROBOTS))
    fleet = observed(*parcels, robots=robots)
    lies = {each.name: PLACES[each.pickup.place] for each in parcels}
    baskets = Baskets(fleet, lies, believes={name: set() for name in ROBOTS})
    now_s = 0.0
    for robot, act, place in acts:
        now_s += 7.0
        happen_to(baskets, robot, act, place, now_s)
        baskets.check()
    for robot in ROBOTS:
        happen_to(baskets, robot, "give_up", "a", now_s)
        happen_to(baskets, robot, "back", "c", now_s)
    for _ in range(40):
        now_s += 10.0
        for robot in ROBOTS:
            happen_to(baskets, robot, "set_out", "a", now_s)
            happen_to(baskets, robot, "do", "a", now_s)
            baskets.check()
    assert sorted(baskets.delivered) == sorted(fleet.items)


def happen_to(baskets: Baskets, robot: str, act: str, place: str, now_s: float) -> None:
    """One thing that may happen, where it can."""
    fleet = baskets.fleet
    tracked = fleet.robots[robot]
    match act:
        case "set_out" if tracked.works and tracked.doing is None and fleet.stops()[robot]:
            item = fleet.stops()[robot][0].item
            # As a dispatcher does: first whoever is called off has to break off.
            off = [e.doing for e in fleet.robots.values() if e.doing is not None and not e.held]
            if all(list(fleet.items)[doing.item] != item for doing in off):
                fleet.apply(SetOut(robot), now_s)
        case "do":
            baskets.do(robot, now_s)
        case "give_up":
            baskets.give_up(robot, now_s)
        case "fail" if tracked.works:
            fleet.apply(RobotFailed(robot, at=place), now_s)
        case "back" if not tracked.works:
            fleet.apply(RobotBack(robot, place), now_s)
