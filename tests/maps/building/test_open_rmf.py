"""Plans of Open-RMF become buildings in metres, their floors above each other."""

import math

import pytest
from pydantic import ValidationError

from mend.errors import WrongInputError
from mend.maps.building.building import Building, DoorOpening, PlaceKind
from mend.maps.building.building_file import check_building
from mend.maps.building.open_rmf import import_open_rmf
from mend.maps.building.tidying import Imported

FRONTS = [
    f"floor '{floor}': doors are called like others, or like an elevator: "
    f"'front' is called '{floor} front' here"
    for floor in ("L1", "L2")
]
"""What is told of the plan below, whose doors are called alike on both levels."""


def lane(a: int, b: int, **properties: object) -> list:
    kinds = {bool: 4, int: 2, float: 3, str: 1}
    given = {"bidirectional": True, "graph_idx": 0, **properties}
    return [a, b, {name: [kinds[type(value)], value] for name, value in given.items()}]


def level(**changes: object) -> dict:
    """A room (0) and a lift (1), 100 px apart; a pixel is 0.05 m; a door in a wall between."""
    return {
        "elevation": 0,
        "vertices": [
            [100.0, 200.0, 0, 4102],
            [200.0, 200.0, 0, "", {"lift_cabin": [1, "Lift1"]}],
            [150.0, 100.0, 0, ""], [150.0, 190.0, 0, ""],
            [150.0, 210.0, 0, ""], [150.0, 300.0, 0, ""],
        ],
        "lanes": [lane(0, 1)],
        "walls": [[2, 3, {}], [4, 5, {}]],
        "doors": [[3, 4, {"name": [1, "front"], "plugin": [1, "none"]}]],
        "measurements": [[0, 1, {"distance": [3, 5.0]}]],
        "fiducials": [[100.0, 200.0, "a"], [200.0, 200.0, "b"]],
        **changes,
    }  # fmt: skip


def turned(**changes: object) -> dict:
    """The same level drawn twice as large, and by a quarter turn."""
    one = level()
    points = [[500.0 - 2 * y, 2 * x, *rest] for x, y, *rest in one["vertices"]]
    fiducials = [[500.0 - 2 * y, 2 * x, name] for x, y, name in one["fiducials"]]
    return {**one, "vertices": points, "fiducials": fiducials, "elevation": 4, **changes}


def plan(**levels: dict) -> dict:
    doors = {name: ["lift_door"] for name in levels}
    return {"name": "hotel", "levels": levels, "lifts": {"Lift1": {"level_doors": doors}}}


def imported(content: dict, graphs: tuple[int, ...] = ()) -> tuple[Building, list[str]]:
    read: Imported = import_open_rmf(content, graphs)
    assert check_building(read.document) == []
    return Building(read.document), read.notes


def test_pixels_become_metres_with_y_upwards() -> None:
    hotel, notes = imported(plan(L1=level(), L2=level(elevation=4)))
    room = hotel.floors["L1"].places["4102"]
    assert (room.x, room.y, room.kind) == (5.0, -10.0, PlaceKind.ROOM)
    assert notes == FRONTS


def test_floors_lie_above_each_other_by_their_fiducials() -> None:
    hotel, _ = imported(plan(L1=level(), L2=turned()))
    for name in ("4102", "Lift1"):
        below, above = (hotel.floors[each].places[name] for each in ("L1", "L2"))
        assert math.dist((below.x, below.y), (above.x, above.y)) < 0.002
    assert list(hotel.floors) == ["L1", "L2"]


def test_a_lift_joins_floors_and_a_door_is_on_the_lane_through_it() -> None:
    hotel, _ = imported(plan(L1=level(), L2=turned()))
    assert hotel.document.elevators["Lift1"].stops == {"L1": "Lift1", "L2": "Lift1"}
    assert [each.doors for each in hotel.crossings] == [["L1 front"], ["L2 front"]]
    assert hotel.floors["L1"].doors["L1 front"].opens is DoorOpening.PEOPLE


def test_lanes_of_other_graphs_are_left_out_where_some_are_chosen() -> None:
    both = level(lanes=[lane(0, 1), lane(0, 1, graph_idx=1, speed_limit=0.4)])
    hotel, _ = imported(plan(L1=both, L2=level(elevation=4)), (1,))
    assert [each.speed_m_s for each in hotel.floors["L1"].lanes] == [0.4]
    assert hotel.floors.keys() == {"L1"}


def test_what_cannot_be_used_is_told_and_left_out() -> None:
    vertices = [*level()["vertices"], [300.0, 200.0, 0, "attic"], [300.0, 250.0, 0, "4102"]]
    blind = level(
        vertices=vertices, lanes=[lane(0, 1), lane(0, 7)], walls=[*level()["walls"], [6, 5, {}]]
    )
    hotel, notes = imported(plan(L1=blind, L2=level(elevation=4)))
    told = "\n".join(notes)
    assert "has two places '4102'" in told
    assert "1 named vertices (attic)" in told
    assert "1 lane (4102 to 4102_2) is through walls" in told
    assert "1 place (4102_2) is cut off" in told
    assert "4102_2" not in hotel.floors["L1"].places


def test_degrees_become_metres_around_the_middle() -> None:
    vertices = [[103.78, 1.30, 0, "a"], [103.78, 1.301, 0, "b"]]
    campus = {
        "coordinate_system": "wgs84",
        "levels": {"L1": {"vertices": vertices, "lanes": [lane(0, 1, bidirectional=True)]}},
    }
    ground, _ = imported(campus)
    places = ground.floors["L1"].places
    assert math.dist(
        (places["a"].x, places["a"].y), (places["b"].x, places["b"].y)
    ) == pytest.approx(111.3, abs=0.1)


def test_a_level_that_nothing_measures_is_refused() -> None:
    with pytest.raises(WrongInputError, match="nothing on level 'L1' is measured"):
        import_open_rmf(plan(L1=level(measurements=[])))


def test_a_lane_to_a_vertex_that_is_not_there_is_refused() -> None:
    with pytest.raises(WrongInputError, match="lane 0 of level 'L1' joins 0 and 99"):
        import_open_rmf(plan(L1=level(lanes=[lane(0, 99)])))


@pytest.mark.parametrize(
    "content", [None, [], {"levels": 3}, {"levels": {"L1": {"vertices": [[1]]}}}]
)
def test_what_is_no_plan_is_refused(content: object) -> None:
    with pytest.raises((ValidationError, WrongInputError)):
        import_open_rmf(content)


def with_a_lift(yaw: float, **vertex: object) -> dict:
    """Two levels of an older editor: a vertex is in the cabin, and does not say so."""
    levels = {}
    for name, elevation in (("L1", 0), ("L2", 4)):
        one = level(elevation=elevation)
        one["vertices"][1] = [200.0, 200.0, 0, "", vertex] if vertex else [200.0, 200.0, 0, ""]
        levels[name] = one
    content = plan(**levels)
    # Its middle is 1 m below and 0.2 m right of the vertex; a pixel is 0.05 m.
    content["lifts"]["Lift1"] |= {
        "x": 204.0, "y": 220.0, "yaw": yaw, "width": 2.4, "depth": 0.6, "reference_floor_name": "L1"
    }  # fmt: skip
    return content


def test_a_lift_is_where_its_cabin_is_drawn_if_no_vertex_says_so() -> None:
    along_y, notes = imported(with_a_lift(math.pi / 2.0))
    assert along_y.document.elevators["Lift1"].stops == {"L1": "Lift1", "L2": "Lift1"}
    assert along_y.floors["L1"].places["Lift1"].kind is PlaceKind.ELEVATOR
    assert notes == FRONTS


def test_a_vertex_beside_the_cabin_is_not_in_it() -> None:
    along_x, notes = imported(with_a_lift(0.0))
    assert not along_x.document.elevators
    assert "the lift 'Lift1' has lanes on 0 of its levels: it is left out" in notes


def test_what_a_vertex_says_of_its_lift_counts_before_where_it_is() -> None:
    said, _ = imported(with_a_lift(math.pi / 2.0, lift_cabin=[1, "Lift1"]))
    assert said.document.elevators["Lift1"].stops == {"L1": "Lift1", "L2": "Lift1"}


def test_a_plan_without_lanes_is_refused() -> None:
    with pytest.raises(WrongInputError, match="no lanes are in the plan"):
        import_open_rmf(plan(L1=level(lanes=[])))


def test_a_measured_edge_to_a_vertex_that_is_not_there_is_refused() -> None:
    measured = [[0, 77, {"distance": [3, 5.0]}]]
    with pytest.raises(WrongInputError, match="measurement 0 of level 'L1' joins 0 and 77"):
        import_open_rmf(plan(L1=level(measurements=measured)))


def test_what_begins_and_ends_in_one_place_is_left_out() -> None:
    pointless = level(lanes=[lane(0, 1), lane(0, 0)], doors=[[3, 3, {"name": [1, "slit"]}]])
    pointless["walls"] = []
    hotel, notes = imported(plan(L1=pointless, L2=level(elevation=4)))
    assert len(hotel.floors["L1"].lanes) == 1
    assert hotel.floors["L1"].doors == {}
    assert [each for each in notes if "left out" in each] == [
        "floor 'L1': 1 lane (4102 to itself) is left out",
        "floor 'L1': 1 door (slit) is without width, and left out",
    ]


def test_doors_of_one_level_that_are_called_alike_are_all_kept() -> None:
    names = ("null", "null_2", "null")
    ends = ((3, 4), (3, 5), (2, 4))
    hung = [[*posts, {"name": [1, name]}] for posts, name in zip(ends, names, strict=True)]
    hotel, _ = imported(plan(L1=level(doors=hung), L2=level(elevation=4)))
    assert list(hotel.floors["L1"].doors) == ["null", "null_2", "null_3"]


def test_lifts_that_are_called_alike_here_are_both_kept() -> None:
    content = plan(L1=level(), L2=level(elevation=4))
    for each in content["levels"].values():
        each["vertices"] = [
            [100.0, 200.0, 0, "room"],
            [200.0, 200.0, 0, "", {"lift_cabin": [1, "a/b"]}],
            [100.0, 300.0, 0, "", {"lift_cabin": [1, "a-b"]}],
        ]
        each |= {"lanes": [lane(0, 1), lane(0, 2)], "walls": [], "doors": []}
    content["lifts"] = {"a/b": {}, "a-b": {}}
    hotel, _ = imported(content)
    assert {name: set(each.stops.values()) for name, each in hotel.document.elevators.items()} == {
        "a-b": {"a-b"}, "a-b_2": {"a-b_2"},
    }  # fmt: skip


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"elevation": 1e6}, "level 'L1': 'height' must be less than or equal to 10000"),
        (
            {"lanes": [lane(0, 1, speed_limit=50.0)]},
            "the lane from '4102' to 'Lift1' of level 'L1': 'speed_m_s' must be less than",
        ),
        (
            {"vertices": [[9e8, 200.0, 0, 4102], *level()["vertices"][1:]], "measurements": []},
            "vertex 0 of level 'L1': 'x' must be less than or equal to 10000",
        ),
    ],
)
def test_a_number_that_cannot_be_is_told_with_what_it_is_of(
    changes: dict[str, object], told: str
) -> None:
    with pytest.raises(WrongInputError) as refused:
        import_open_rmf(plan(L1=level(**changes), L2=level(elevation=4)))
    assert told in str(refused.value)


def test_names_that_no_building_may_have_become_some_that_it_may() -> None:
    content = {**plan(**{"L/1": level()}), "name": "hotel \u202e" + "x" * 80}
    hotel, notes = imported(content)
    assert list(hotel.floors) == ["L-1"]
    assert "the level 'L/1' is called 'L-1' here" in notes
    assert hotel.name == "hotel " + "x" * 58


def test_what_is_there_twice_is_taken_once_and_told() -> None:
    doors = [*level()["doors"], [4, 3, {"name": [1, "back"], "plugin": [1, "none"]}]]
    walls = [*level()["walls"], [2, 2, {}]]
    twice = level(lanes=[lane(0, 1), lane(1, 0, bidirectional=False)], doors=doors, walls=walls)
    hotel, notes = imported(plan(L1=twice))
    assert (len(hotel.floors["L1"].lanes), list(hotel.floors["L1"].doors)) == (1, ["front"])
    assert "floor 'L1': 1 door (back) is where another one is" in notes
