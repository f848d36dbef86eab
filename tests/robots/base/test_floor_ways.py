"""Ways through a building lead along its lanes, not through its walls."""

import math
from itertools import pairwise

import numpy as np
import pytest

from mend.maps.building.building import Building
from mend.maps.building.crossing import crossed_by
from mend.maps.building.random_building import random_building
from mend.robots.base.body import BasePose
from mend.robots.base.floor_ways import FloorWays
from mend.robots.execution.command_error import CommandError
from mend.tasks.frames import Frame


@pytest.mark.parametrize("seed", range(6))
def test_no_way_leads_through_a_wall_and_each_ends_at_its_goal(seed: int) -> None:
    building = Building(random_building(seed, 2, 12))
    frame = Frame(3.0, -1.0, quarters=seed % 4)
    ways = FloorWays(building, frame, 1.0)
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
    ways = FloorWays(building, Frame(), 1.0)
    floor = building.floors["F1"]
    for name, door in floor.doors.items():
        (x0, y0), (x1, y1) = door.posts
        x, y = (x0 + x1) / 2, (y0 + y1) / 2
        assert ways.door_at(BasePose(x, y - 0.5, 0.0), (x, y + 0.5)) == name
        assert ways.door_at(BasePose(x, y - 0.5, 0.0), (x, y - 0.1)) is None


def test_what_is_on_no_floor_is_said() -> None:
    building = Building(random_building(3, 2, 4))
    ways = FloorWays(building, Frame(), 1.0)
    here = BasePose(1.3, 0.0, 0.0)
    with pytest.raises(CommandError, match="no floor is 9 m high"):
        ways.path(here, BasePose(1.3, 0.0, 0.0, 9.0))
    with pytest.raises(CommandError, match="I am on F1, and that is on F2"):
        ways.path(here, BasePose(1.3, 0.0, 0.0, building.floors["F2"].height))
