"""Places as requests call them and as tasks do, and where others get to a robot."""

import math

import pytest
from building_bench import made_up

from mend.errors import WrongInputError
from mend.maps.building.building import PlaceKind
from mend.server.fleets.place_names import BESIDE_M, PlaceNames
from mend.sim.building.scene import scene_of

OFFICE = made_up(floors=2, rooms=6)
SCENE = scene_of(OFFICE, "office", 1)
NAMES = PlaceNames(OFFICE, SCENE)


def test_rooms_chargers_and_elevators_have_names_in_the_scene() -> None:
    for kind in (PlaceKind.ROOM, PlaceKind.CHARGER, PlaceKind.ELEVATOR):
        for each in OFFICE.of_kind(kind):
            assert NAMES.in_scene(each) == each.replace("/", "-")


def test_nobody_is_sent_to_what_is_only_passed() -> None:
    passed = OFFICE.of_kind(PlaceKind.WAYPOINT)[0]
    with pytest.raises(WrongInputError, match="robots are not sent to"):
        NAMES.in_scene(passed)


def test_beside_who_stands_at_a_place_is_the_nearest_other_one_to_which_robots_are_sent() -> None:
    place = SCENE.places["F1-101"].pose
    where = place.x, place.y, place.z or 0.0
    assert NAMES.nearest(*where) == "F1/101"
    beside = NAMES.beside(*where)
    assert beside in NAMES.names
    other = OFFICE.floors["F1"].places[beside.split("/")[1]]
    assert math.dist((other.x, other.y), where[:2]) >= BESIDE_M
    assert NAMES.beside(*where[:2], 1000.0) is None


def test_between_floors_the_nearest_place_is_one_of_the_floor_that_is_nearer() -> None:
    stop, height = OFFICE.floors["F1"].places["lift1"], OFFICE.floors["F2"].height
    assert NAMES.nearest(stop.x, stop.y, 0.45 * height) == "F1/lift1"
    assert NAMES.nearest(stop.x, stop.y, 0.55 * height) == "F2/lift1"


def test_who_began_where_no_robot_is_sent_goes_back_to_the_nearest_place() -> None:
    assert NAMES.home("F1/101") == "F1/101"
    passed = OFFICE.of_kind(PlaceKind.WAYPOINT)[0]
    assert NAMES.home(passed) in NAMES.names
