"""Doors of an imported plan are called like nothing else that people may be asked about."""

import pytest

from mend.maps.building.building import BuildingDocument, Door, Elevator, Floor, FloorPlace
from mend.maps.building.naming import LONGEST, plain_name, unlike, with_plain_door_names

DOOR = Door(posts=((0.0, 0.0), (1.0, 0.0)))


def hotel(low: list[str], high: list[str]) -> BuildingDocument:
    floors = {
        name: Floor(places={"hall": FloorPlace(x=3.0, y=3.0)}, doors=dict.fromkeys(doors, DOOR))
        for name, doors in (("L1", low), ("L2", high))
    }
    stops = {"L1": "hall", "L2": "hall"}
    return BuildingDocument(
        building="hotel", floors=floors, elevators={"lift": Elevator(stops=stops)}
    )


def named(low: list[str], high: list[str]) -> tuple[list[list[str]], list[str]]:
    notes: list[str] = []
    floors = with_plain_door_names(hotel(low, high), notes).floors
    return [list(each.doors) for each in floors.values()], notes


def test_a_door_that_nothing_else_is_called_like_keeps_its_name() -> None:
    assert named(["front", "kitchen"], ["attic"]) == ([["front", "kitchen"], ["attic"]], [])


def test_doors_of_several_floors_are_called_after_their_floors_too() -> None:
    names, notes = named(["door0", "front"], ["Door0"])
    assert names == [["L1 door0", "front"], ["L2 Door0"]]
    assert notes[0] == (
        "floor 'L1': doors are called like others, or like an elevator: "
        "'door0' is called 'L1 door0' here"
    )


def test_a_hall_door_is_not_called_like_its_elevator() -> None:
    names, _ = named(["Lift"], ["lift"])
    assert names == [["L1 Lift door"], ["L2 lift door"]]


def test_a_longer_name_is_not_taken_from_another_door() -> None:
    names, _ = named(["door0", "L2 door0"], ["door0"])
    assert names == [["L1 door0", "L2 door0"], ["L2 door0_2"]]


def test_a_name_stays_short_enough() -> None:
    long = "x" * LONGEST
    assert unlike(long, {long}) == f"{'x' * (LONGEST - 2)}_2"


@pytest.mark.parametrize("low", [["a", "a_2"], ["a"]])
def test_doors_stay_in_their_order(low: list[str]) -> None:
    names, _ = named(low, ["b"])
    assert names == [low, ["b"]]


@pytest.mark.parametrize(
    "given", ["a" * (LONGEST - 1) + " bc", "a" * (LONGEST - 3) + " bc", "a/b\u202e\x01 c"]
)
def test_a_name_that_was_cut_is_one_that_a_place_may_have(given: str) -> None:
    plain = plain_name(given)
    for name in (plain, unlike(plain, {plain})):
        assert Floor(places={name: FloorPlace(x=0.0, y=0.0)}).places.keys() == {name}
