"""Delivery files: the problem that they pose, and one sentence with its line per mistake."""

import json
import re
from math import inf
from pathlib import Path
from random import Random

import jsonschema_rs
import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from office_building import (
    BINDING,
    LOOSE,
    BuildingPlan,
    building_deliveries,
)
from ticking_clock import TickingClock

from mend.fleet.scheduling.checker import check
from mend.fleet.scheduling.methods import solve
from mend.fleet.scheduling.problem import Window
from mend.fleet.scheduling.problem_file import (
    DeliveryFileError,
    delivery_schema,
    problem_of,
    read_delivery_file,
    read_delivery_text,
)

EXAMPLES = sorted((Path(__file__).parents[3] / "examples/deliveries").glob("*.yaml"))

TEXT = """\
name: two_floors
travel:
  graph:
    speed_m_s: 2.0
    places:
      lobby: {x: 0, y: 0}
      hall: {x: 0, y: 30, floor: 1}
      lab: {x: 40, y: 30, floor: 1}
      attic: {x: 0, y: 0, floor: 2}
    ways:
      - {between: [lobby, hall], kind: elevator, length_m: 0, delay_s: 60}
      - {between: [hall, lab], kind: door}
robots:
  - {name: ada, start: lobby, end: lobby, capacity: 2, shift_s: [0, 480]}
  - {name: ben, start: hall, capacity: 1, speed: 2}
items:
  - name: post
    pickup: {place: lobby, service_s: 5}
    delivery: {place: lab, window_s: [10, null], due_s: 90}
    max_on_board_s: 300
  - {name: cup, aboard: ben, delivery: {place: lab}}
transfers: {places: [hall], service_s: 15}
weights: {distance: 2}
"""


def test_file_becomes_a_problem() -> None:
    problem = read_delivery_text(TEXT).problem
    assert problem.places == ("lobby", "hall", "lab")
    assert problem.travel.time_s[0].tolist() == [0.0, 60.0, 80.0]
    assert problem.travel.distance_m[0].tolist() == [0.0, 0.0, 40.0]
    ada, ben = problem.robots
    assert (ada.end, ada.shift, ben.end, ben.speed) == (0, Window(0.0, 480.0), None, 2.0)
    post, cup = problem.items
    assert (post.delivery.window, post.delivery.due_s) == (Window(10.0, inf), 90.0)
    assert (cup.aboard, cup.pickup.place, cup.load) == (1, 1, 1.0)
    assert problem.transfers.places == (1,)
    assert (problem.weights.distance, problem.weights.lateness) == (2.0, 1.0)


def test_json_and_yaml_say_the_same() -> None:
    again = read_delivery_text(json.dumps(yaml.safe_load(TEXT))).problem
    first = read_delivery_text(TEXT).problem
    assert (again.robots, again.items, again.places) == (first.robots, first.items, first.places)


def test_transfers_are_possible_anywhere() -> None:
    problem = read_delivery_text(TEXT.replace("places: [hall], ser", "anywhere: true, ser")).problem
    assert problem.transfers.places == (0, 1, 2, 3)


MATRIX = """\
name: grid
travel:
  matrix: {places: [a, b], time_s: [[0, 5], [null, 0]], distance_m: [[0, 9], [9, 0]]}
robots: [{name: r, start: a, capacity: 1}]
items: [{name: i, pickup: {place: a}, delivery: {place: b}}]
"""


def test_matrix_has_no_way_where_it_says_null() -> None:
    travel = read_delivery_text(MATRIX).problem.travel
    assert np.array_equal(travel.time_s, [[0.0, 5.0], [inf, 0.0]])
    assert travel.distance_m[0, 1] == 9.0
    same = read_delivery_text(MATRIX.replace(", distance_m: [[0, 9], [9, 0]]", "")).problem.travel
    assert same.distance_m[0, 1] == 5.0


def told(text: str) -> list[str]:
    with pytest.raises(DeliveryFileError) as caught:
        read_delivery_text(text, source="f")
    return str(caught.value).splitlines()


PLACES = "'attic', 'hall', 'lab', 'lobby'"


@pytest.mark.parametrize(
    ("before", "after", "sentence"),
    [
        ("start: lobby", "start: moon", f"f:14: there is no place 'moon'; there are {PLACES}"),
        ("[hall, lab]", "[hall, bar]", f"f:12: there is no place 'bar'; there are {PLACES}"),
        ("[hall, lab]", "[hall, hall]", "f:12: the way leads from 'hall' to itself"),
        ("kind: elevator", "kind: door", "f:11: the way joins floors 0 and 1, which only an "
         "'elevator' does"),
        ("[10, null]", "[10, 5]", "f:19: 'items.0.delivery.window_s' ends at 5 s, before it begins "
         "at 10 s"),
        ("name: cup", "name: post", "f:21: the name 'post' is given twice"),
        ("name: ada", "name: ben", "f:15: the name 'ben' is given twice"),
        ("aboard: ben", "aboard: eve", "f:21: there is no robot 'eve'; there are 'ada', 'ben'"),
        ("capacity: 2", "capacity: -2", "f:14: 'robots.0.capacity' must be greater than or equal "
         "to 0, but it is -2"),
        ("capacity: 2", "capacity: .nan", "f:14: 'robots.0.capacity' must be a number, but "
         'it is ".nan"'),
        ("  - {name: cup, aboard: ben,", "  - {name: cup,", "f:21: 'items.1': an item must have "
         "either 'pickup' or 'aboard'"),
        ("places: [hall], ser", "places: [hall], anywhere: true, ser", "f:22: 'transfers': 'places'"
         " say nothing more where transfers are possible 'anywhere'"),
        ("weights:", "colour: red\nweights:", "f:23: unknown key 'colour'; known are 'description',"
         " 'items', 'name', 'robots', 'transfers', 'travel', 'weights'"),
    ],
)  # fmt: skip
def test_each_mistake_is_one_sentence_with_its_line(before: str, after: str, sentence: str) -> None:
    assert told(TEXT.replace(before, after, 1)) == [sentence]


@pytest.mark.parametrize(
    ("before", "after", "sentence"),
    [
        ("[null, 0]]", "[1, 2]]", "f:3: from 'b' to itself must be 0"),
        ("[null, 0]]", "[1]]", "f:3: the row has 1 numbers for 2 places"),
        (", [null, 0]]", "]", "f:3: 'time_s' has 1 rows for 2 places"),
        ("[a, b]", "[a, a]", "f:3: the name 'a' is given twice"),
    ],
)
def test_matrix_that_is_wrong_is_told(before: str, after: str, sentence: str) -> None:
    assert sentence in told(MATRIX.replace(before, after, 1))


def test_several_mistakes_are_told_in_the_order_of_their_lines() -> None:
    text = TEXT.replace("start: hall", "start: moon").replace("place: lab", "place: mars")
    assert [line.split(":")[1] for line in told(text)] == ["15", "19", "21"]


def test_file_without_items_is_told_what_is_missing() -> None:
    text = TEXT[: TEXT.index("items:")] + "items: []\n"
    assert "'items' must have at least 1 entry, but it has 0" in "; ".join(told(text))


@pytest.mark.parametrize("text", ["", "[1, 2]", "name: x", "\t{", "name: !!python/object x"])
def test_what_is_no_delivery_file_is_refused(text: str) -> None:
    assert told(text)


def test_infeasibilities_are_told_with_the_line_of_their_item() -> None:
    text = TEXT.replace("window_s: [10, null]", "window_s: [10, 30]")
    (infeasibility,) = read_delivery_text(text).infeasibilities
    assert infeasibility.line == 17
    assert "to drop post at lab must begin by 30 s" in infeasibility.message


def test_door_in_a_file_opens_and_closes() -> None:
    text = TEXT.replace("kind: door}", "kind: door, open_s: [[100, 200], [300, null]]}")
    travel = read_delivery_text(text).problem.travel
    assert travel.trip(1, 2, 0.0).arrival_s == 120.0
    assert travel.trip(1, 2, 190.0).arrival_s == 320.0


def test_schema_accepts_the_examples_and_refuses_what_is_unknown() -> None:
    validator = jsonschema_rs.validator_for(delivery_schema())
    for path in EXAMPLES:
        assert validator.is_valid(yaml.safe_load(path.read_text()))
    assert not validator.is_valid({"name": "x"})


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_can_be_solved(path: Path) -> None:
    delivery = read_delivery_file(path)
    assert delivery.infeasibilities == ()
    found = solve(delivery.problem, "insertion", seconds=60.0, clock=TickingClock())
    assert found.schedule is not None
    assert check(delivery.problem, found.schedule) == []


def test_example_in_the_documentation_is_a_delivery_file() -> None:
    document = (Path(__file__).parents[3] / "docs/scheduling.md").read_text()
    example = document.split("```yaml\n")[1].split("```")[0]
    assert read_delivery_text(example).infeasibilities == ()


def test_example_of_the_corridor_needs_a_transfer() -> None:
    (path,) = (path for path in EXAMPLES if path.stem == "corridor")
    problem = read_delivery_file(path).problem
    found = solve(problem, "insertion", seconds=60.0, clock=TickingClock())
    assert found.schedule is not None
    assert found.schedule.transfers > 0


@given(st.integers(0, 1000), st.integers(1, 4), st.integers(1, 13), st.integers(0, 4))
@settings(deadline=None, max_examples=25)
def test_buildings_drawn_are_files_without_mistakes(
    seed: int, floors: int, offices: int, hours: int
) -> None:
    plan = BuildingPlan(floors, max(2, offices), robots=2, items=3, office_hours=hours)
    document = building_deliveries(plan, Random(seed))
    text = json.dumps(document.model_dump(mode="json", exclude_none=True))
    problem = read_delivery_text(text.replace('"shift_s": [0.0]', '"shift_s": [0.0, null]')).problem
    again = problem_of(building_deliveries(plan, Random(seed)))
    assert (problem.items, problem.robots) == (again.items, again.robots)
    assert np.isfinite(problem.travel.time_s).all()


def test_loose_building_has_one_robot_that_can_do_everything() -> None:
    problem = problem_of(building_deliveries(LOOSE, Random(1)))
    alone = solve(problem.without_transfers(), "insertion", seconds=60.0, clock=TickingClock())
    assert alone.schedule is not None
    assert problem_of(building_deliveries(BINDING, Random(1))).robots[0].shift.latest_s == 520.0


NASTY = ("-1", "1e308", ".inf", "null", "[]", "{}", "''", "yes", "west", "0", "[1, 0]", "!x", "*a")


@given(
    st.sampled_from([path.read_text() for path in EXAMPLES]),
    st.lists(st.tuples(st.integers(0, 10_000), st.sampled_from(NASTY)), min_size=1, max_size=3),
)
@settings(deadline=None, max_examples=80)
def test_absurd_values_are_told_or_make_sense(text: str, changes: list[tuple[int, str]]) -> None:
    for number, nasty in changes:
        values = list(re.finditer(r"(?<=[:\[,] )[\w.]+(?=[,\]}\n])", text))
        if not values:
            break
        value = values[number % len(values)]
        text = text[: value.start()] + nasty + text[value.end() :]
    try:
        delivery = read_delivery_text(text)
    except DeliveryFileError:
        return
    if not delivery.infeasibilities:
        found = solve(delivery.problem, "greedy", seconds=60.0, clock=TickingClock())
        if found.schedule is not None:
            assert check(delivery.problem, found.schedule) == []
