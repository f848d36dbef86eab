"""Drawn shifts: what happens can happen in the building, and what cannot is told."""

import json
from functools import cache
from itertools import pairwise

import pytest
from sampled import sample

from mend.errors import WrongInputError
from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.setting import FleetSetting, ServiceRobot
from mend.fleet.happenings import Cancelled, NobodyAnswers, RobotFails, WayBarred, WrongFloor
from mend.fleet.requests import LegAction, Transport
from mend.fleet.shifts.drawn_shift import CAPACITY, Shift, drawn_shift
from mend.fleet.shifts.ways import DeliveryWays
from mend.maps.building.building import Building, BuildingDocument, PlaceKind
from mend.maps.building.random_building import random_building

LASTS_S = 7200.0


def starts_in(building: Building) -> dict[str, str]:
    chargers = building.of_kind(PlaceKind.CHARGER)
    return {f"robot{number}": at for number, at in enumerate(chargers, 1)}


def goals_in(building: Building) -> list[str]:
    return [each for kind in PlaceKind if kind != "waypoint" for each in building.of_kind(kind)]


def shift_in(building: Building, seed: int = 1) -> Shift:
    return drawn_shift(building, starts_in(building), goals_in(building), seed, LASTS_S)


@cache
def office_and_shift(floors: int, seed: int) -> tuple[Building, Shift]:
    building = Building(random_building(seed, floors, 8))
    return building, shift_in(building, seed)


def changes_robots(building: Building, shift: Shift) -> bool:
    """Whether the plan of all that is asked for at the beginning has a thing change robots."""
    robots = starts_in(building).items()
    dispatcher = Dispatcher(
        building,
        FleetSetting(
            robots=tuple(
                ServiceRobot(name=name, start=at, capacity=CAPACITY) for name, at in robots
            ),
            transfer_places=shift.document.transfer_places,
        ),
    )
    for each in shift.document.requests:
        if each.name not in shift.document.asked_s:
            dispatcher.submit(each, 0.0)
    stops = dispatcher.stops().values()
    return any(action is LegAction.GIVE for left in stops for _, action in left)


def walled_row(*, doors: bool) -> Building:
    """Four rooms in a row, 4 m apart, in a corridor 2 m wide; a door between the middle ones."""
    names = ["1", "2", "3", "4"]
    floor = {
        "places": {
            name: {"x": 4.0 * number, "y": 0.0, "kind": "room"} for number, name in enumerate(names)
        },
        "lanes": [{"between": each} for each in pairwise(names)],
        "walls": [[-1.0, 1.0, 13.0, 1.0], [-1.0, -1.0, 13.0, -1.0]],
        "doors": {"d": {"posts": [[6.0, -1.0], [6.0, 1.0]]}} if doors else {},
    }
    document = {"building": "row", "floors": {"G": floor}}
    return Building(BuildingDocument.model_validate_json(json.dumps(document)))


@pytest.mark.drawn(2)
@pytest.mark.slow(2)
@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("floors", [1, 2])
def test_whatever_happens_is_on_the_way_of_what_is_asked_for_then(seed: int, floors: int) -> None:
    building, shift = office_and_shift(floors, seed)
    document = shift.document
    ways = DeliveryWays(building)
    asked = {document.asked_s.get(each.name, 0.0): each for each in document.requests}
    for each in document.happenings:
        if isinstance(each, WayBarred | WrongFloor):
            (transport,) = [asked[at] for at in asked if 0.0 <= at - each.at_s <= 30.0]
            assert isinstance(transport, Transport)
            if isinstance(each, WrongFloor):
                assert each.elevator in ways.elevators(*transport.places)
            else:
                barred = {hindrance.between for hindrance in ways.hindrances(*transport.places)}
                assert each.between in barred
    kinds = {type(each) for each in document.happenings}
    assert {WayBarred, NobodyAnswers, Cancelled} <= kinds
    assert (RobotFails in kinds) == (len(starts_in(building)) > 1)
    assert (WrongFloor in kinds) == (floors > 1)


@pytest.mark.slow(2)
@pytest.mark.parametrize("seed", range(sample(1, 2)))
def test_a_thing_changes_robots_or_it_is_told_that_none_does(seed: int) -> None:
    building, shift = office_and_shift(2, seed)
    told = any(note.startswith("no thing changes robots") for note in shift.notes)
    assert changes_robots(building, shift) != told


def test_the_same_seed_draws_the_same_and_another_another() -> None:
    building = Building(random_building(5, 1, 8))
    assert shift_in(building, 3).document == shift_in(building, 3).document
    assert shift_in(building, 3).document != shift_in(building, 4).document


def test_what_cannot_happen_is_told() -> None:
    row = walled_row(doors=False)
    told = drawn_shift(row, {"r": "G/1"}, goals_in(row), 1, LASTS_S).notes
    assert told == [
        "one robot alone: no thing changes robots, and nobody helps it out",
        "no wrong floor: no elevator is on the way between any two rooms",
        "a blocked hallway is waited for: no way leads round any",
        "no closed door: no door is on the way between any two rooms",
    ]


def test_what_nobody_gets_round_is_over_before_the_request_is_given_up() -> None:
    row = walled_row(doors=True)
    document = drawn_shift(row, {"r": "G/1"}, goals_in(row), 1, LASTS_S).document
    barred = [each for each in document.happenings if isinstance(each, WayBarred)]
    assert {frozenset(each.between) for each in barred} >= {frozenset(("G/2", "G/3"))}
    assert all(each.until_s - each.at_s <= 300.0 for each in barred)


def test_a_place_that_no_robot_gets_to_is_told_and_never_asked_for() -> None:
    row = walled_row(doors=False)
    floor = row.floors["G"]
    cut = floor.model_copy(update={"lanes": floor.lanes[:2]})
    building = Building(row.document.model_copy(update={"floors": {"G": cut}}))
    shift = drawn_shift(building, {"r": "G/1"}, goals_in(building), 1, LASTS_S)
    assert "robots do not get to 'G/4', where nobody asks then" in shift.notes
    assert all("G/4" not in each.places for each in shift.document.requests)


def test_a_place_behind_a_door_with_hours_is_told_with_them() -> None:
    row = walled_row(doors=True)
    floor = row.floors["G"]
    hours = {"d": floor.doors["d"].model_copy(update={"open_s": ((100.0, 500.0),)})}
    open_at_times = floor.model_copy(update={"doors": hours})
    building = Building(row.document.model_copy(update={"floors": {"G": open_at_times}}))
    shift = drawn_shift(building, {"r": "G/1"}, goals_in(building), 1, LASTS_S)
    assert (
        "robots do not get to 'G/3', 'G/4' at all times "
        "(doors with hours: d on G (open 100 to 500 s)), where nobody asks then"
    ) in shift.notes


def test_a_building_without_two_rooms_is_refused() -> None:
    row = walled_row(doors=False)
    with pytest.raises(WrongInputError, match=r"'row' has one room.*needs two"):
        drawn_shift(row, {"r": "G/1"}, ["G/1"], 1, LASTS_S)
