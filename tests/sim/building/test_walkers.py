"""People walk from room to room; they touch no robot, no wall, and nobody else."""

import json
import math

import numpy as np
import pytest
from building_bench import BuildingBench, made_up
from sampled import sample

from mend.maps.building.clearance import distances_m
from mend.sim.building.bystander import RADIUS_M, Bystander
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.scene import scene_of


def busy(seed: int, **more: float) -> BuildingBench:
    scene = scene_of(made_up(rooms=8, seed=seed), "office", 2)
    return BuildingBench(scene, seed=seed, people=4, **more)  # type: ignore[arg-type]


def assert_nobody_is_touched(bench: BuildingBench) -> None:
    people = bench.world.walkers.people
    for number, each in enumerate(people):
        floor = bench.world.building.floors[each.at.floor]
        here = np.array([[each.at.x, each.at.y]])
        assert distances_m(here, floor.wall_segments)[0] >= RADIUS_M
        others = [(e.at, RADIUS_M) for e in people[number + 1 :]]
        for at, radius_m in [*others, *((e.at, e.radius_m) for e in bench.world.robots)]:
            if at.floor == each.at.floor:
                away_m = math.hypot(at.x - each.at.x, at.y - each.at.y)
                assert away_m >= radius_m + RADIUS_M - 1e-9


@pytest.mark.slow(2)
@pytest.mark.parametrize("seed", sample([3], [3, 4, 5]))
def test_nobody_is_touched_while_robots_and_people_are_about(seed: int) -> None:
    bench = busy(seed, shut_doors=0.5)
    rooms = sorted(each for each in bench.scene.places if each.startswith("F1-1"))
    assert bench.world.walkers.people
    began = {id(each): each.at for each in bench.world.walkers.people}
    for turn in range(2):
        for number, robot in enumerate(bench.scene.robots):
            bench.go(robot, rooms[(turn * 3 + number * 2) % len(rooms)])
        for _ in range(600):
            bench.world.advance_cycle()
            assert_nobody_is_touched(bench)
        while bench.group.advance(0.05) and bench.group.time_s() < 150.0:
            assert_nobody_is_touched(bench)
    assert bench.world.touches == 0
    assert any(began[id(each)] != each.at for each in bench.world.walkers.people)


def test_people_come_and_go_through_doors_that_people_open() -> None:
    bench = busy(3, shut_doors=1.0)
    sat = {id(each): {each.room} for each in bench.world.walkers.people}
    for _ in range(4000):
        bench.world.advance_cycle()
        for each in bench.world.walkers.people:
            if not each.way:
                sat[id(each)].add(each.room)
    assert sum(len(rooms) > 1 for rooms in sat.values()) >= 2


def test_who_cannot_get_on_goes_back() -> None:
    bench = busy(3)
    world = bench.world
    for _ in range(2000):
        world.advance_cycle()
        walking = [
            each
            for each in world.walkers.people
            if each.way and math.dist((each.at.x, each.at.y), each.way[0]) > 1.0
        ]
        if walking:
            break
    who = walking[0]
    left, room = who.left, who.room
    world.bystanders.append(Bystander(FloorPose(who.at.floor, *who.way[0])))
    for _ in range(600):
        world.advance_cycle()
        if who.room == left:
            break
    assert (who.room, who.left) == (left, room)


def test_people_go_on_from_a_snapshot_as_if_nothing_had_been() -> None:
    bench, other = busy(4), busy(4)
    for _ in range(700):
        bench.world.advance_cycle()
    kept = json.loads(json.dumps(bench.world.snapshot(), allow_nan=False))
    other.world.restore(kept)
    for _ in range(700):
        bench.world.advance_cycle()
        other.world.advance_cycle()
    assert other.world.walkers.snapshot() == bench.world.walkers.snapshot()


def test_a_snapshot_from_before_people_walked_is_still_read() -> None:
    bench = BuildingBench()
    kept = bench.world.snapshot()
    del kept["walkers"], kept["walkers_draws"]
    bench.world.restore(kept)
    assert bench.world.walkers.people == []
