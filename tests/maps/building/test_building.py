"""A building's places have names, and its ways follow from lanes, doors and elevators."""

import numpy as np
import pytest

from mend.errors import NotFoundError
from mend.maps.building.building import (
    Building,
    BuildingDocument,
    Door,
    Elevator,
    Floor,
    FloorPlace,
    Lane,
    PlaceKind,
)
from mend.maps.navigation import WayKind

DOOR = Door(posts=((5.0, -1.0), (5.0, 1.0)))


def floor(**changes) -> Floor:
    """Two places 10 m apart."""
    given = {
        "places": {"hall": FloorPlace(x=0.0, y=0.0), "lab": FloorPlace(x=10.0, y=0.0)},
        "lanes": (Lane(between=("hall", "lab")),),
    }
    return Floor(**{**given, **changes})


def building(**floors: Floor) -> Building:
    document = BuildingDocument(building="office", floors=floors)
    if len(floors) > 1:
        stops = dict.fromkeys(floors, "lab")
        lift = {"lift": Elevator(stops=stops, ride_s=20.0, floor_s=4.0)}
        document = document.model_copy(update={"elevators": lift})
    return Building(document)


def times(of: Building, **between) -> np.ndarray:
    return of.graph.shortest(1.0, **between)[1]


def test_a_name_that_one_floor_has_is_enough() -> None:
    upper = floor(places={"lab": FloorPlace(x=10.0, y=0.0)}, lanes=())
    two = building(F1=floor(), F2=upper)
    assert two.find("hall") == "F1/hall"
    assert two.find("F2/lab") == "F2/lab"
    with pytest.raises(NotFoundError, match="F1/lab or F2/lab"):
        two.find("lab")
    with pytest.raises(NotFoundError, match="has no place 'roof'; there is 'hall'"):
        two.find("roof")
    with pytest.raises(NotFoundError, match="has no place 'F2/Lob'; there is 'F2/lab'"):
        two.find("F2/Lob")


def test_places_are_found_by_their_kind() -> None:
    charger = FloorPlace(x=0.0, y=0.0, kind=PlaceKind.CHARGER)
    assert building(F1=floor(places={"dock": charger}, lanes=())).of_kind(PlaceKind.CHARGER) == [
        "F1/dock"
    ]


def test_a_one_way_lane_leads_back_nowhere() -> None:
    one = building(F1=floor(lanes=(Lane(between=("hall", "lab"), one_way=True),)))
    assert times(one)[0, 1] == 10.0
    assert times(one)[1, 0] == np.inf


def test_nobody_is_faster_than_a_lane_allows() -> None:
    slow = building(F1=floor(lanes=(Lane(between=("hall", "lab"), speed_m_s=0.5),)))
    assert times(slow)[0, 1] == 20.0


def test_a_lane_through_a_door_is_open_when_the_door_is() -> None:
    shop = building(
        F1=floor(doors={"front": DOOR.model_copy(update={"open_s": ((100.0, 200.0),)})})
    )
    (way,) = shop.graph.ways
    assert way.kind is WayKind.DOOR
    assert times(shop, from_s=110.0, until_s=190.0)[0, 1] == 10.0
    assert times(shop, from_s=150.0, until_s=250.0)[0, 1] == np.inf


def test_through_two_doors_one_comes_while_both_are_open() -> None:
    first = DOOR.model_copy(update={"open_s": ((0.0, 100.0),)})
    second = Door(posts=((6.0, -1.0), (6.0, 1.0)), open_s=((50.0, 150.0),))
    (way,) = building(F1=floor(doors={"first": first, "second": second})).graph.ways
    assert way.open_s == ((50.0, 100.0),)
    never = second.model_copy(update={"open_s": ((120.0, 150.0),)})
    (way,) = building(F1=floor(doors={"first": first, "second": never})).graph.ways
    assert way.closed


def test_an_elevator_takes_longer_for_each_floor() -> None:
    three = building(F1=floor(), F2=floor(), F3=floor())
    at = [three.graph.index(f"F{number}/lab") for number in (1, 2, 3)]
    assert times(three)[at[0], at[1]] == 24.0
    assert times(three)[at[0], at[2]] == 28.0


def test_walls_across_a_lane_are_told_and_those_beside_it_are_not() -> None:
    walls = ((3.0, -1.0, 3.0, 1.0), (3.0, 0.5, 4.0, 0.5), (10.0, -1.0, 10.0, 1.0))
    (crossing,) = building(F1=floor(walls=walls)).crossings
    assert crossing.walls.tolist() == [0]


def test_a_floors_map_has_its_doors_shut() -> None:
    assert len(floor(walls=((0.0, 1.0, 5.0, 1.0),), doors={"front": DOOR}).vector_map) == 2


def test_from_behind_all_walls_no_way_leads_anywhere() -> None:
    walls = ((-2.0, -2.0, 12.0, -2.0), (12.0, -2.0, 12.0, 2.0), (12.0, 2.0, -2.0, 2.0))
    around = floor(walls=(*walls, (-2.0, 2.0, -2.0, -2.0), (5.0, -2.0, 5.0, 1.0)))
    assert around.has_way_from(0.0, 1.9)
    assert around.has_way_from(11.9, -1.9)
    assert not around.has_way_from(12.3, 0.0)
    assert not around.has_way_from(0.0, -2.1)
    assert not floor(places={}, lanes=()).has_way_from(0.0, 0.0)
