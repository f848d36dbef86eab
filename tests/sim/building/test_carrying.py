"""Who carries a robot puts it where somebody can: on a floor, not into an elevator's shaft."""

import numpy as np
from building_bench import BuildingBench, made_up

from mend.maps.building.building import PlaceKind
from mend.robots.base.body import Velocity
from mend.sim.building.carrying import Carrying
from mend.sim.building.scene import scene_of


def test_a_robot_is_put_at_any_place_of_its_floor_but_into_no_shaft() -> None:
    world = BuildingBench(scene_of(made_up(2), "office", 1)).world
    (robot,) = world.robots
    places = world.building.floors[robot.at.floor].places.values()
    carrying, put = Carrying(1.0, np.random.default_rng(1)), set()
    for _ in range(400):
        robot.move(Velocity(0.5))
        assert carrying.carry_one([robot], world.building, lambda *_: False)
        put.add((robot.at.x, robot.at.y))
    shafts = {(each.x, each.y) for each in places if each.kind is PlaceKind.ELEVATOR}
    assert shafts
    assert put == {(each.x, each.y) for each in places} - shafts
