"""Who is told that robots get there only while doors are open is told what was found closed."""

from math import inf

from mend.fleet.dispatch.closed_words import with_closed
from mend.fleet.scheduling.constraint import WHILE_OPEN
from mend.maps.building.building import Building
from mend.maps.building.random_building import random_building

BUILDING = Building(random_building(1, 3, 33))
RIDES = [frozenset((f"F{a}/lift1", f"F{b}/lift1")) for a, b in ((1, 2), (1, 3), (2, 3))]
TOLD = f"r0 can get there {WHILE_OPEN}"


def test_an_elevator_is_told_once_and_a_way_by_its_ends() -> None:
    closed = {**dict.fromkeys(RIDES, 300.0), frozenset(("F1/101", "F1/w0_1")): inf}
    told = with_closed(TOLD, BUILDING, closed)
    assert told == (f"{TOLD}; found closed: lift1 until 300 s, the way between F1/101 and F1/w0_1")


def test_nothing_is_added_where_nothing_is_closed_or_that_is_not_why() -> None:
    assert with_closed(TOLD, BUILDING, {}) == TOLD
    assert with_closed("r0 is full", BUILDING, dict.fromkeys(RIDES, 300.0)) == "r0 is full"


def test_of_many_ways_some_are_told() -> None:
    closed = {frozenset((f"F1/a{n}", f"F1/b{n}")): 300.0 for n in range(7)}
    assert with_closed(TOLD, BUILDING, closed).endswith(", 2 more")


def test_doors_with_hours_are_named() -> None:
    document = BUILDING.document
    name, floor = next((n, each) for n, each in document.floors.items() if each.doors)
    door, plain = next(iter(floor.doors.items()))
    timed = plain.model_copy(update={"open_s": ((0.0, 300.0), (900.0, 1200.0))})
    other = floor.model_copy(update={"doors": {**floor.doors, door: timed}})
    floors = {**document.floors, name: other}
    told = with_closed(TOLD, Building(document.model_copy(update={"floors": floors})), {})
    hours = f"{door} on {name} (open 0 to 300 s and 900 to 1200 s)"
    assert told == f"{TOLD}; doors with hours: {hours}"
