"""Every building that is made up can be driven through."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.maps.building.building import Building, PlaceKind
from mend.maps.building.building_file import building_text, check_building, read_building_text
from mend.maps.building.drawing import floor_picture
from mend.maps.building.random_building import MOST_FLOORS, MOST_ROOMS, random_building


@pytest.mark.slow(2)
@given(st.integers(0, 2**32), st.integers(1, 6), st.integers(1, MOST_ROOMS))
def test_it_has_no_mistakes_and_as_many_rooms_as_were_asked_for(
    seed: int, floors: int, rooms: int
) -> None:
    document = random_building(seed, floors, rooms)
    assert check_building(document) == []
    building = Building(document)
    assert len(building.of_kind(PlaceKind.ROOM)) == floors * rooms
    assert len(building.of_kind(PlaceKind.CHARGER)) == floors
    assert (len(document.elevators) > 0) == (floors > 1)


def test_a_seed_gives_the_same_building_and_another_one_another() -> None:
    one, again, other = (random_building(seed, 2, 10) for seed in (1, 1, 2))
    assert one == again
    assert one.floors != other.floors


def test_it_is_the_same_once_it_was_written() -> None:
    document = random_building(5, 3, 30)
    assert read_building_text(building_text(document)).document == document


@pytest.mark.parametrize(
    ("floors", "rooms"), [(0, 1), (1, 0), (MOST_FLOORS + 1, 1), (1, MOST_ROOMS + 1)]
)
def test_one_without_floors_or_rooms_cannot_be_made_up(floors: int, rooms: int) -> None:
    with pytest.raises(ValueError, match="1 to 30 floors and 1 to 80 rooms"):
        random_building(1, floors, rooms)


def test_a_picture_of_a_floor_names_its_rooms_and_not_its_waypoints() -> None:
    building = Building(random_building(1, 2, 6))
    picture = floor_picture(building, "F2")
    assert all(f">{200 + number}</text>" in picture for number in range(1, 7))
    assert ">w0_0<" not in picture
    assert picture.count("<line") >= len(building.floors["F2"].walls)


def test_no_door_is_called_like_another_one_or_like_an_elevator() -> None:
    for seed in range(6):
        made = random_building(seed, 4, 50)
        doors = [name.casefold() for floor in made.floors.values() for name in floor.doors]
        assert len({*doors, *made.elevators}) == len(doors) + len(made.elevators)
