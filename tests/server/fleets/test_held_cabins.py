"""Who stays in an elevator's cabin without anything to do closes that to plans until it is out."""

from dataclasses import dataclass, field

import pytest
from dispatch_office import fleet_of

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import Finding, Found
from mend.fleet.requests import GoToRoom, RequestStatus
from mend.maps.building.building import Building
from mend.maps.building.cabin import elevator_around, stop_of
from mend.maps.building.random_building import random_building
from mend.server.fleets.closed_ways import ClosedWays
from mend.server.fleets.held_cabins import AGAIN_S, STAYS_S, HeldCabins
from mend.tasks.potential import Point


@pytest.fixture(scope="module")
def building() -> Building:
    """Two elevators ride between three floors."""
    return Building(random_building(1, 3, 33))


@dataclass
class Office:
    """A fleet of two; `at`: where they say that they are, `busy`: who does something."""

    building: Building
    at: dict[str, Point] = field(default_factory=dict)
    busy: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        self.dispatcher = Dispatcher(self.building, fleet_of("F1/101", "F1/102"))
        self.closed = ClosedWays(self.dispatcher, ())
        self.cabins = self._cabins({})

    def _cabins(self, kept: dict[str, str]) -> HeldCabins:
        return HeldCabins(
            self.dispatcher,
            self.closed,
            self.at.get,
            lambda *_: ["F1/102", "F1/103", "F1/104"],
            lambda robot: robot not in self.busy,
            kept,
        )

    def begin_anew(self) -> None:
        """The service was stopped: no robot has said yet where it is."""
        self.at.clear()
        self.cabins = self._cabins(dict(self.cabins.held))

    def in_cabin(self, elevator: str, floor: str = "F1") -> Point:
        x, y = stop_of(self.building, elevator, floor)
        return x, y, self.building.floors[floor].height

    def found(self, now_s: float) -> list[tuple[str, Finding]]:
        """What plans are told by then."""
        found = list(self.cabins.found(now_s))
        for _, each in found:
            self.cabins.take(each, now_s)
        return [(elevator, each.finding) for elevator, each in found]

    @property
    def closes(self) -> set[str]:
        return {place.split("/")[1] for way in self.dispatcher.closed_until_s() for place in way}


@pytest.fixture
def office(building: Building) -> Office:
    return Office(building)


def test_a_cabin_is_known_at_its_floors_and_between_them(building: Building) -> None:
    x, y = stop_of(building, "lift2", "F2")
    assert elevator_around(building, x, y, building.floors["F2"].height) == "lift2"
    between_m = (building.floors["F1"].height + building.floors["F2"].height) / 2.0
    assert elevator_around(building, x, y, between_m) == "lift2"
    assert elevator_around(building, x + 1.0, y, building.floors["F2"].height) is None


def test_who_stays_closes_it_until_it_is_out(office: Office) -> None:
    office.at["r0"] = office.in_cabin("lift1")
    assert office.found(0.0) == []
    assert office.found(STAYS_S - 1.0) == []
    assert office.found(STAYS_S) == [("lift1", Finding.ELEVATOR_DEAD)]
    assert office.closes == {"lift1"}
    assert office.cabins.held == {"r0": "lift1"}
    assert office.found(STAYS_S + 1.0) == [], "it is told once"
    office.at["r0"] = (0.0, 0.0, 0.0)
    assert office.found(STAYS_S + 2.0) == [("lift1", Finding.OPEN)]
    assert office.closes == set()
    assert office.cabins.held == {}


def test_others_ride_by_the_other_elevator_or_are_told_why_nobody_does(office: Office) -> None:
    office.at["r0"] = office.in_cabin("lift1")
    office.found(0.0)
    office.found(STAYS_S)
    assert office.dispatcher.submit(GoToRoom(name="up", place="F3/301"), STAYS_S).booked
    office.at["r1"] = office.in_cabin("lift2", "F3")
    office.found(STAYS_S)
    office.found(2.0 * STAYS_S)
    assert office.closes == {"lift1", "lift2"}
    soon = GoToRoom(name="soon", place="F3/302", latest_s=3.0 * STAYS_S)
    answer = office.dispatcher.submit(soon, 2.0 * STAYS_S)
    assert not answer.booked
    assert office.dispatcher.view("soon").status is RequestStatus.REFUSED
    assert answer.why is not None
    assert "; found closed: lift1 until 2100 s, lift2 until 2100 s" in answer.why


def test_who_rides_for_somebody_closes_nothing_however_long_that_takes(office: Office) -> None:
    office.busy.add("r0")
    office.at["r0"] = office.in_cabin("lift1")
    assert office.found(0.0) == office.found(10.0 * STAYS_S) == []
    office.busy.clear()
    assert office.found(10.9 * STAYS_S) == [], "it has broken off just now, and may get out"
    assert office.found(11.0 * STAYS_S) == [("lift1", Finding.ELEVATOR_DEAD)]


def test_it_stays_closed_while_the_robot_is_sent_out_and_where_that_is_forgotten(
    office: Office,
) -> None:
    office.at["r0"] = office.in_cabin("lift1")
    office.found(0.0)
    office.found(STAYS_S)
    office.busy.add("r0")
    assert office.found(STAYS_S + 50.0) == []
    assert office.closes == {"lift1"}
    later_s = max(office.dispatcher.closed_until_s().values()) + 1.0
    assert office.found(later_s) == [("lift1", Finding.ELEVATOR_DEAD)]


def test_after_a_restart_it_is_closed_until_the_robot_is_seen_outside(office: Office) -> None:
    office.at["r0"] = office.in_cabin("lift1")
    office.found(0.0)
    office.found(STAYS_S)
    office.begin_anew()
    assert office.found(STAYS_S + 1.0) == [], "where it is nobody knows yet"
    office.at["r0"] = office.in_cabin("lift1")
    assert office.found(STAYS_S + 2.0) == []
    assert office.closes == {"lift1"}
    office.at["r0"] = (0.0, 0.0, 0.0)
    assert office.found(STAYS_S + 3.0) == [("lift1", Finding.OPEN)]
    assert office.closes == set()


def test_what_others_say_of_it_stays_as_they_say(office: Office) -> None:
    office.at["r0"] = office.in_cabin("lift1")
    office.found(0.0)
    dead = Found(finding=Finding.ELEVATOR_DEAD, between=("F1/lift1", "F2/lift1"))
    office.dispatcher.found(dead, 1.0)
    office.closed.note(dead, "olga")
    assert office.found(STAYS_S) == []
    office.at.clear()
    assert office.found(STAYS_S + 1.0) == []
    assert office.closes == {"lift1"}, "somebody has closed it for another reason"


def test_who_holds_one_is_sent_where_nobody_is_and_again_after_a_while(office: Office) -> None:
    def sent(free: list[str], now_s: float) -> list[tuple[str, str]]:
        return list(office.cabins.to_send_out(free, now_s))

    office.at["r0"] = office.in_cabin("lift1")
    office.found(0.0)
    assert sent(["r0", "r1"], 0.0) == []
    office.found(STAYS_S)
    assert sent(["r1"], STAYS_S) == []
    assert sent(["r0", "r1"], STAYS_S) == [("r0", "F1/103")], "the other one stands at 102"
    assert sent(["r0", "r1"], STAYS_S + 1.0) == []
    office.dispatcher.submit(GoToRoom(name="visit", place="F1/103"), STAYS_S)
    assert sent(["r0", "r1"], STAYS_S + AGAIN_S) == [("r0", "F1/104")]


def test_it_is_news_only_when_something_changes(office: Office) -> None:
    there, away = office.in_cabin("lift1"), (0.0, 0.0, 0.0)
    office.busy.add("r0")
    assert not office.cabins.saw("r0", there, 0.0)
    assert not office.cabins.saw("r0", away, 1.0)
    office.busy.clear()
    assert office.cabins.saw("r0", there, 2.0)
    assert not office.cabins.saw("r0", there, 3.0)
    assert office.cabins.saw("r0", there, 2.0 + STAYS_S)
    office.at["r0"] = there
    office.found(2.0 + STAYS_S)
    assert not office.cabins.saw("r0", there, 3.0 + STAYS_S)
    assert office.cabins.saw("r0", away, 4.0 + STAYS_S)
