"""What is wrong in the files of buildings and requests is told in every language of the console."""

import pytest
from languages_of_console import untold

from mend.documents.problem import InvalidFileError
from mend.errors import WrongInputError
from mend.fleet.request_file import read_request_text
from mend.fleet.requests import request_of
from mend.maps.building.building_file import read_building_text

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
REQUESTS = """
requests:
  - {name: parcel, kind: transport, what: the parcel, origin: 1/101, destination: 1/hall}
  - {name: lunch, kind: go_to_room, place: 2/lift, earliest_s: 5}
asked_s: {lunch: 60}
happenings:
  - {kind: way_barred, at_s: 10, until_s: 20, between: [1/101, 1/hall]}
  - {kind: robot_fails, at_s: 5, robot: robot}
  - {kind: nobody_answers, at_s: 5}
  - {kind: cancelled, at_s: 5, request: lunch}
  - {kind: wrong_floor, at_s: 5, elevator: main}
helpers: [anna]
transfer_places: [1/hall]
"""


def changed(text: str, before: str, after: str) -> str:
    assert before in text
    return text.replace(before, after, 1)


def told_of(problems: InvalidFileError) -> list[str]:
    return [each.message for each in problems.problems]


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (OFFICE, "- 1"),
        (OFFICE, "name: s\nobjects: {}\nplaces: {}"),
        (OFFICE, "building: [office"),
        ("[hall, lift]", "[hall, roof]"),
        ("[hall, lift]", "[hall, hall]"),
        ("[hall, lift]", "[hall]"),
        ("[hall, lift]", "hall"),
        ('"2": lift}', '"3": lift}'),
        ('"2": lift}', '"2": hall}'),
        ('"2": lift}', "}"),
        ("[[0.5, 1.5], [1.5, 1.5]]", "[[0.5, 1.5], [0.5, 1.5]]"),
        ("[[0.5, 1.5], [1.5, 1.5]]", "[[0.5, 1.5, 2.0], [0.5, 1.5]]"),
        ("opens: itself", "open_s: [[9.0, 8.0]]"),
        ("opens: itself", "opens: magic"),
        ("[0.0, 1.5, 0.5, 1.5]", "[0.0, 1.0, 6.0, 1.0]"),
        ("speed_m_s: 0.5", "one_way: true"),
        ("speed_m_s: 0.5", "one_way: 3"),
        ("speed_m_s: 0.5", "speed_m_s: 0"),
        ("speed_m_s: 0.5", "speed_m_s: 11"),
        ("speed_m_s: 0.5", "speed: 1"),
        ("kind: room", "kind: cellar"),
        ("building: office\n", ""),
        ("building: office", "building: ''"),
        ("building: office", "building: " + "x" * 65),
        ("building: office", "office: 1\nbuilding: 7"),
        ('      "101": {x', '      "1/01": {x'),
        ("x: 1.0, y: 3.0", "x: left, y: 3.0"),
        ("{x: 1.0, y: 3.0, kind: room}", "5"),
        ("places: {lift: {x: 5.0, y: 0.0, kind: elevator}}", "places: {}"),
        ("height: 3.5", "height: 1e6"),
        ("height: 3.5", "height: -3.5"),
        (
            "    lanes:",
            "      attic: {x: 9.0, y: 0.0}\n    lanes:\n      - {between: [lift, attic]}",
        ),
        ("{between: [hall, lift], speed_m_s: 0.5}", '{between: [hall, "101"]}'),
        ("[0.0, 1.5, 0.5, 1.5]", "[0.0, 1.5, 0.0, 1.5]"),
        ("opens: itself}", "opens: itself}\n      b: {posts: [[1.5, 1.5], [0.5, 1.5]]}"),
        ('"2": lift}}', '"2": lift}}\n  b: {stops: {"1": hall, "2": lift}}'),
        ("height: 3.5", "height: high"),
    ],
)
def test_mistakes_in_a_building_are(before: str, after: str) -> None:
    with pytest.raises(InvalidFileError) as refused:
        read_building_text(changed(OFFICE, before, after))
    assert untold(told_of(refused.value), ("clauses", "refusals")) == []


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (REQUESTS, "[]"),
        (REQUESTS, "building: b\nfloors: {}"),
        (REQUESTS, "requests: []"),
        (REQUESTS, "requests: ["),
        ("{lunch: 60}", "{brunch: 60}"),
        ("{lunch: 60}", "{lunch: -1}"),
        ("{lunch: 60}", "{7th: 60}"),
        ("request: lunch", "request: letter"),
        ("until_s: 20", "until_s: 10"),
        ("way_barred", "flood"),
        ("kind: way_barred, ", ""),
        ("name: lunch", "name: parcel"),
        ("name: lunch, ", ""),
        ("kind: transport", "kind: fly"),
        ("kind: transport, ", ""),
        ("what: the parcel, ", ""),
        ("what: the parcel", "what: ''"),
        ("what: the parcel", 'what: "a\\u0007b"'),
        ("what: the parcel", "what: " + "x" * 501),
        ("destination: 1/hall", "destination: 1/101"),
        ("earliest_s: 5", "earliest_s: 5, latest_s: 4"),
        ("earliest_s: 5", "earliest_s: 5, recurrence: {every_s: 60, until_s: 4}"),
        ("earliest_s: 5", "earliest_s: 5, recurrence: {every_s: 59}"),
        ("earliest_s: 5", "earliest_s: 5, stay_s: 3601"),
        ("earliest_s: 5", "earliest_s: soon"),
        ("earliest_s: 5", "soonest_s: 5"),
        ("[anna]", "[anna, anna]"),
        ("[anna]", "[anna, 5]"),
        ("[anna]", "anna"),
        ("[anna]", "['']"),
    ],
)
def test_mistakes_in_a_request_file_are(before: str, after: str) -> None:
    with pytest.raises(InvalidFileError) as refused:
        read_request_text(changed(REQUESTS, before, after))
    assert untold(told_of(refused.value), ("clauses", "refusals")) == []


@pytest.mark.parametrize(
    "asked",
    [
        {"kind": "fly"},
        {"kind": "go_to_room", "name": "x", "place": "1/hall", "earliest_s": 5, "latest_s": 4},
        {"kind": "escort", "name": "x", "person": "Ann", "origin": "a", "destination": "a"},
    ],
)
def test_what_is_wrong_with_a_request_is(asked: dict[str, object]) -> None:
    with pytest.raises(WrongInputError) as refused:
        request_of(asked)
    assert untold([str(refused.value)], ("clauses", "refusals")) == []
