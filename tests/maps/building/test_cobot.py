"""Navigation graphs of the CoBots become buildings, an elevator where somebody says so."""

import numpy as np
import pytest

from mend.errors import WrongInputError
from mend.maps.building.building import Building, DoorOpening, PlaceKind
from mend.maps.building.building_file import check_building
from mend.maps.building.cobot import CobotFloor, import_cobot
from mend.maps.vector_map import VectorMap


def graph(*edges: dict, nodes: int = 3) -> dict:
    return {
        "nodes": [{"id": each, "loc": {"x": 4.0 * each, "y": 0.0}} for each in range(nodes)],
        "edges": list(edges),
    }


def edge(a: int, b: int, **changes: object) -> dict:
    return {"s0_id": a, "s1_id": b, "max_speed": 1.0, **changes}


HALL = graph(edge(0, 1), edge(1, 2, has_door=True, has_automated_door=True))
SHUT = VectorMap(np.array([[6.0, -3.0, 6.0, 3.0]]))


def test_a_door_is_in_the_middle_of_its_edge_and_opens_the_wall_there() -> None:
    floor = CobotFloor(HALL, SHUT)
    read = import_cobot("lab", {"F1": floor})
    assert check_building(read.document) == []
    (door,) = read.document.floors["F1"].doors.values()
    assert sorted(door.posts) == [(6.0, -0.5), (6.0, 0.5)]
    assert door.opens is DoorOpening.ITSELF
    assert sorted(read.document.floors["F1"].walls) == [
        (6.0, -3.0, 6.0, -0.5),
        (6.0, 0.5, 6.0, 3.0),
    ]


def test_an_elevator_joins_the_nodes_that_are_said_to_be_one() -> None:
    floors = {"F1": CobotFloor(HALL), "F2": CobotFloor(HALL)}
    read = import_cobot("lab", floors, {"lift": {"F1": 2, "F2": 0}})
    assert read.notes[2:] == [
        "how high floors are is not said: give each its 'height' before robots drive there",
        "floor 'F1': ways end at n0, which count as rooms",
        "floor 'F2': ways end at n2, which count as rooms",
    ]
    graph_of = Building(read.document).graph
    assert np.isfinite(graph_of.shortest(1.0)[0]).all()


def test_floors_that_nothing_joins_are_left_out() -> None:
    small = graph(edge(0, 1), nodes=2)
    read = import_cobot("lab", {"F1": CobotFloor(HALL), "F2": CobotFloor(small)})
    assert list(read.document.floors) == ["F1"]
    assert "floor 'F2': 2 places (n0, n1) are cut off" in read.notes[0]
    assert "no elevator was said to stop on 'F2': left out" in read.notes[1]


def test_nobody_is_told_to_say_an_elevator_that_was_said() -> None:
    """It leads to a part of the first floor that is cut off, and so does all beyond it."""
    low = graph(edge(0, 1), edge(1, 2), edge(2, 3), edge(3, 4), edge(5, 6), nodes=7)
    floors = {"F1": CobotFloor(low), "F2": CobotFloor(graph(edge(0, 1), nodes=2))}
    read = import_cobot("lab", floors, {"lift": {"F1": 6, "F2": 0}})
    assert list(read.document.floors) == ["F1"]
    assert not any("no elevator was said" in each for each in read.notes)


def test_a_door_that_one_of_two_directions_has_is_there() -> None:
    for edges in (
        [edge(0, 1), edge(1, 0, has_door=True)],
        [edge(0, 1, has_door=True), edge(1, 0)],
    ):
        read = import_cobot("lab", {"F1": CobotFloor(graph(*edges, nodes=2))})
        assert len(read.document.floors["F1"].doors) == 1
        assert len(read.document.floors["F1"].lanes) == 1


def test_an_elevator_has_stops_on_two_floors() -> None:
    with pytest.raises(WrongInputError, match="'lift' needs stops on two floors at least, and has"):
        import_cobot("lab", {"F1": CobotFloor(HALL), "F2": CobotFloor(HALL)}, {"lift": {"F1": 2}})


def test_robots_take_no_stairs() -> None:
    stairs = graph(edge(0, 1), edge(1, 2, has_stairs=True))
    assert "n2" not in import_cobot("lab", {"F1": CobotFloor(stairs)}).document.floors["F1"].places


def test_what_is_not_there_is_told() -> None:
    with pytest.raises(WrongInputError, match="stops at node 9 of 'F1': there is none"):
        import_cobot("lab", {"F1": CobotFloor(HALL)}, {"lift": {"F1": 9}})
    with pytest.raises(WrongInputError, match="leads to node 7"):
        import_cobot("lab", {"F1": CobotFloor(graph(edge(0, 7)))})


def test_where_a_way_ends_is_a_room() -> None:
    # 3 is where an elevator is that nobody has said to be one.
    forked = graph(edge(0, 1), edge(1, 0), edge(1, 2), edge(1, 3, has_elevator=True), nodes=4)
    read = import_cobot("lab", {"F1": CobotFloor(forked)})
    kinds = {name: each.kind for name, each in read.document.floors["F1"].places.items()}
    assert kinds == {
        "n0": PlaceKind.ROOM,
        "n1": PlaceKind.WAYPOINT,
        "n2": PlaceKind.ROOM,
        "n3": PlaceKind.WAYPOINT,
    }
    assert read.notes == ["floor 'F1': ways end at n0, n2, which count as rooms"]


def test_doors_of_several_floors_are_told_apart() -> None:
    floors = {"F1": CobotFloor(HALL), "F2": CobotFloor(HALL)}
    read = import_cobot("lab", floors, {"lift": {"F1": 0, "F2": 0}})
    doors = [list(each.doors) for each in read.document.floors.values()]
    assert doors == [["F1 door_1_2"], ["F2 door_1_2"]]
