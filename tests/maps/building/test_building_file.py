"""Building files are read, checked with one sentence for each mistake, and written."""

from pathlib import Path

import pytest

from mend.maps.building.building_file import (
    BuildingFileError,
    building_text,
    read_building_file,
    read_building_text,
)

OFFICE = """
building: office
floors:
  "1":
    places:
      "101": {x: 1.0, y: 3.0, kind: room}
      hall: {x: 1.0, y: 0.0}
      lift: {x: 5.0, y: 0.0, kind: elevator}
    lanes:
      - {between: ["101", hall]}
      - {between: [hall, lift], speed_m_s: 0.5}
    walls: [[0.0, 1.5, 0.5, 1.5], [1.5, 1.5, 6.0, 1.5]]
    doors:
      "101": {posts: [[0.5, 1.5], [1.5, 1.5]], opens: itself}
  "2":
    height: 3.5
    places: {lift: {x: 5.0, y: 0.0, kind: elevator}}
elevators:
  main: {stops: {"1": lift, "2": lift}}
"""


def mistakes_of(*changes: tuple[str, str]) -> str:
    text = OFFICE
    for before, after in changes:
        assert before in text
        text = text.replace(before, after)
    with pytest.raises(BuildingFileError) as told:
        read_building_text(text)
    return str(told.value)


def test_a_building_is_the_same_once_it_was_written() -> None:
    office = read_building_text(OFFICE)
    assert read_building_text(building_text(office.document)).document == office.document


def test_a_building_is_read_from_a_file(tmp_path: Path) -> None:
    path = tmp_path / "office.yaml"
    path.write_text(OFFICE, encoding="utf-8")
    assert read_building_file(path).find("101") == "1/101"


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (("[hall, lift]", "[hall, roof]"), ":11: this floor has no place 'roof'"),
        (("[hall, lift]", "[hall, hall]"), "a lane from 'hall' to itself leads nowhere"),
        (('"2": lift}', '"3": lift}'), "there is no floor '3'; there are '1', '2'"),
        (('"2": lift}', '"2": hall}'), "stops at 'hall', which the floor '2' has not"),
        (("[[0.5, 1.5], [1.5, 1.5]]", "[[0.5, 1.5], [0.5, 1.5]]"), "posts of the door '101'"),
        (("opens: itself", "open_s: [[9.0, 8.0]]"), "the door '101' shuts before it opens"),
        (("[0.0, 1.5, 0.5, 1.5]", "[0.0, 1.0, 6.0, 1.0]"), "goes through a wall"),
        (("{between: [hall, lift], speed_m_s: 0.5}", "{between: [hall, lift], one_way: true}"),
         "no way leads from"),
        (("kind: room", "kind: cellar"), "'floors.1.places.101.kind' must be"),
        (("building: office\n", ""), "'building' is missing"),
        (('      "101": {x', '      "1/01": {x'), "1/01"),
        (("{between: [hall, lift], speed_m_s: 0.5}",
          "{between: [hall, lift]}\n      - {between: [lift, hall], one_way: true}"),
         ":12: the lane from 'lift' to 'hall' is there already: it is lane 1"),
        (("[[0.0, 1.5, 0.5, 1.5]", "[[0.0, 1.5, 0.0, 1.5]"),
         ":12: the wall begins and ends at (0, 1.5)"),
        (("opens: itself}", "opens: itself}\n      b: {posts: [[1.5, 1.5], [0.5, 1.5]]}"),
         ":15: the door 'b' is where the door '101' is"),
        (("height: 3.5", "height: -3.5"),
         "floors come from the lowest to the highest, but '2' is at -3.5 m and '1' before it at 0"),
        (('main: {stops: {"1": lift, "2": lift}}',
          'main: {stops: {"1": lift, "2": lift}}\n  b: {stops: {"2": lift, "1": hall}}'),
         ":20: the elevator 'main' stops at '2/lift' already"),
        (("building: office", 'building: "of\\u202Efice"'), "'building' must be words without"),
    ],
)  # fmt: skip
def test_a_mistake_is_told_where_it_is(change: tuple[str, str], told: str) -> None:
    assert told in mistakes_of(change)


def test_a_place_behind_an_elevator_is_told_as_robots_drive_through_no_cabin() -> None:
    behind = "      attic: {x: 9.0, y: 0.0}\n    lanes:\n      - {between: [lift, attic]}\n"
    told = mistakes_of(("    lanes:\n", behind))
    assert "no lane leads to '1/attic' and back from the rest of its floor" in told


def test_one_way_there_and_another_back_are_two_lanes() -> None:
    text = OFFICE.replace("[hall, lift]", "[hall, lift], one_way: true").replace(
        "    walls:", "      - {between: [lift, hall], one_way: true}\n    walls:", 1
    )
    assert len(read_building_text(text).floors["1"].lanes) == 3


def test_what_is_no_mapping_is_no_building() -> None:
    with pytest.raises(BuildingFileError, match="a building file is a mapping"):
        read_building_text("- 1")
