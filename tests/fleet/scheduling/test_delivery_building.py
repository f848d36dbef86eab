"""Deliveries are planned in a building that has a file of its own."""

from pathlib import Path

import pytest

from mend.fleet.scheduling.problem_file import (
    DeliveryFileError,
    read_delivery_file,
    read_delivery_text,
)
from mend.maps.building.building_file import building_text
from mend.maps.building.random_building import random_building

DELIVERIES = """
name: office
travel:
  building: {file: plans/office.yaml, speed_m_s: 0.5}
robots:
  - {name: ada, start: charger1, capacity: 1}
items:
  - {name: mail, pickup: {place: "101"}, delivery: {place: F2/202}}
transfers: {places: [F1/lift1]}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "plans").mkdir()
    office = building_text(random_building(4, 2, 5))
    (tmp_path / "plans" / "office.yaml").write_text(office, encoding="utf-8")
    return tmp_path


def read(folder: Path, text: str = DELIVERIES):
    path = folder / "deliveries.yaml"
    path.write_text(text, encoding="utf-8")
    return read_delivery_file(path)


def test_places_are_found_by_their_short_names(folder: Path) -> None:
    problem = read(folder).problem
    (item,) = problem.items
    assert problem.places[item.pickup.place] == "F1/101"
    assert problem.places[item.delivery.place] == "F2/202"
    assert problem.places[problem.robots[0].start] == "F1/charger1"


def test_it_takes_as_long_as_the_building_says(folder: Path) -> None:
    slow = read(folder).problem.travel
    fast = read(folder, DELIVERIES.replace("0.5", "1.0")).problem.travel
    ride_s = 20.0
    assert slow.time_s.max() == pytest.approx(2 * (fast.time_s.max() - ride_s) + ride_s)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (('"101"', '"109"'), "deliveries.yaml:8: the building 'building_4' has no place '109'"),
        (("charger1", "lift1"), "'lift1' is on several floors: say F1/lift1 or F2/lift1"),
        (("plans/office.yaml", "../office.yaml"), "must be below the folder"),
        (("plans/office.yaml", "plans/hall.yaml"), "deliveries.yaml:4: "),
    ],
)  # fmt: skip
def test_what_the_building_has_not_is_told(folder: Path, change: tuple, told: str) -> None:
    with pytest.raises(DeliveryFileError, match=r"deliveries\.yaml") as error:
        read(folder, DELIVERIES.replace(*change))
    assert told in str(error.value)


def test_a_text_alone_names_no_file() -> None:
    with pytest.raises(DeliveryFileError, match="can be named in a file alone"):
        read_delivery_text(DELIVERIES)
