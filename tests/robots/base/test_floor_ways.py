"""Ways through a building lead along its lanes, not through its walls."""

import json
import math
from itertools import pairwise

import numpy as np
import pytest

from mend.maps.building.building import Building, BuildingDocument
from mend.maps.building.crossing import crossed_by
from mend.maps.building.random_building import random_building
from mend.robots.base.body import BasePose
from mend.robots.base.floor_ways import FloorWays
from mend.robots.execution.command_error import CommandError
from mend.tasks.frames import Frame


def document_of(name: str, floor: dict[str, object]) -> BuildingDocument:
    return BuildingDocument.model_validate_json(
        json.dumps({"building": name, "floors": {"F1": floor}})
    )


@pytest.mark.parametrize("seed", range(6))
def test_no_way_leads_through_a_wall_and_each_ends_at_its_goal(seed: int) -> None:
    building = Building(random_building(seed, 2, 12))
    frame = Frame(3.0, -1.0, quarters=seed % 4)
    ways = FloorWays(building, frame, 1.0, 0.3)
    for name, floor in building.floors.items():
        walls = np.array(floor.walls)
        poses = [
            BasePose(*frame.to_robot(each.x, each.y), 0.0, floor.height)
            for each in floor.places.values()
        ]
        for here, to in zip(poses, reversed(poses), strict=True):
            way = [(here.x, here.y), *ways.path(here, to)]
            assert math.dist(way[-1], (to.x, to.y)) < 1e-9
            for a, b in pairwise(way):
                leg = np.array([*frame.to_scene(*a), *frame.to_scene(*b)])
                assert not len(crossed_by(leg, walls)), f"{name}: {a} to {b}"


def test_a_door_on_the_way_has_its_name() -> None:
    building = Building(random_building(3, 1, 4))
    ways = FloorWays(building, Frame(), 1.0, 0.3)
    floor = building.floors["F1"]
    for name, door in floor.doors.items():
        (x0, y0), (x1, y1) = door.posts
        x, y = (x0 + x1) / 2, (y0 + y1) / 2
        assert ways.door_at(BasePose(x, y - 0.5, 0.0), (x, y + 0.5)) == name
        assert ways.door_at(BasePose(x, y - 0.5, 0.0), (x, y - 0.1)) is None


def test_what_is_on_no_floor_is_said() -> None:
    building = Building(random_building(3, 2, 4))
    ways = FloorWays(building, Frame(), 1.0, 0.3)
    here = BasePose(1.3, 0.0, 0.0)
    with pytest.raises(CommandError, match="no floor is 9 m high"):
        ways.path(here, BasePose(1.3, 0.0, 0.0, 9.0))
    with pytest.raises(CommandError, match="the way from F1 to F2 needs an elevator"):
        ways.path(here, BasePose(1.3, 0.0, 0.0, building.floors["F2"].height))


def test_lanes_are_kept_to_where_no_wall_is_and_doors_with_hours_are_gone_to() -> None:
    """Open ground is no way: the lanes lead round what the map does not have."""
    places: dict[str, object] = {"a": {"x": 0.0, "y": 0.0}, "b": {"x": 20.0, "y": 0.0}}
    places |= {"corner": {"x": 0.0, "y": 10.0}, "other": {"x": 20.0, "y": 10.0}}
    lanes = [("a", "corner"), ("corner", "other"), ("other", "b")]
    floor = {
        "places": places,
        "lanes": [{"between": each} for each in lanes],
        "doors": {"shop": {"posts": ((19.0, 5.0), (21.0, 5.0)), "open_s": ((10.0, 20.0),)}},
    }
    document = document_of("yard", floor)
    ways = FloorWays(Building(document), Frame(), 1.0, 0.3)
    path = ways.path(BasePose(0.0, 0.0, 0.0), BasePose(20.0, 0.0, 0.0))
    assert list(path) == [(0.0, 10.0), (20.0, 10.0), (20.0, 0.0)]


def test_nobody_leaves_the_lanes_through_a_gap_that_is_too_narrow() -> None:
    floor = {
        "places": {
            "a": {"x": 0.0, "y": 0.0},
            "b": {"x": 3.0, "y": 3.0},
            "by": {"x": 4.0, "y": 0.0},
        },
        "lanes": [{"between": ("a", "by")}, {"between": ("by", "b")}],
        "walls": ((0.0, 2.0, 1.8, 2.0), (2.2, 2.0, 3.2, 2.0)),
    }
    document = document_of("gap", floor)
    here, to = BasePose(1.0, 0.0, 0.0), BasePose(3.0, 3.0, 0.0)
    assert (4.0, 0.0) in FloorWays(Building(document), Frame(), 1.0, 0.3).path(here, to)


@pytest.mark.parametrize("quarters", range(4))
def test_walls_around_a_pose_are_known_also_where_nothing_is_seen(quarters: int) -> None:
    floor = {"walls": [[0.0, 1.0, 3.0, 1.0], [20.0, 0.0, 20.0, 9.0]]}
    frame = Frame(2.0, -1.0, quarters=quarters)
    ways = FloorWays(Building(document_of("hut", floor)), frame, 1.0, 0.3)
    here = BasePose(*frame.to_robot(1.0, 0.0), 0.4)
    walls = np.array([frame.to_scene(x, y) for x, y in ways.walls_near(here).tolist()])
    assert np.allclose(walls[:, 1], 1.0)
    assert np.all(np.diff(np.sort(walls[:, 0])) <= 0.15 + 1e-9)
    assert walls[:, 0].min() == pytest.approx(0.0)
    assert walls[:, 0].max() == pytest.approx(3.0)
