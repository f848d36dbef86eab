"""Robots drive through a building, stop before people and shut doors, and touch nothing."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from building_bench import BuildingBench, made_up

from mend.maps.building.clearance import distances_m
from mend.robots.link.messages import Finished, IssueDetected, Look, Looked, Resume
from mend.sim.building.bystander import RADIUS_M
from mend.sim.building.scene import scene_of
from mend.tasks.intervention import Act, Intervention

AWAY = Intervention(act=Act.RELEASE)


def rooms(bench: BuildingBench) -> list[str]:
    return sorted(each for each in bench.scene.places if each.startswith("F1-1"))


def test_a_robot_goes_to_every_room_and_touches_nothing() -> None:
    bench = BuildingBench()
    for room in rooms(bench):
        bench.go("robot1", room)
        bench.run()
        at, pose = bench.world.robots[0].at, bench.scene.places[room].pose
        assert math.hypot(at.x - pose.x, at.y - pose.y) < 0.06
    assert len(bench.of(Finished)) == len(rooms(bench))
    assert bench.world.touches == 0


def test_a_shut_door_is_named_and_opened_by_who_is_asked() -> None:
    bench = BuildingBench(shut_doors=1.0)
    by_hand = [
        name for name, each in bench.world.doors.items() if each.plan.opens.value == "people"
    ]
    room = by_hand[0].replace("/", "-")
    bench.go("robot1", room)
    issue = bench.run_until(IssueDetected)
    assert issue.issue == "door_closed"
    assert issue.detection is not None
    assert by_hand[0].split("/")[1] in issue.detection.explanation
    bench.run()
    assert bench.world.intervene(AWAY) == ""
    bench.send("robot1", Look(expect="way_clear", within_s=5.0))
    bench.run()
    assert bench.of(Looked)[-1].fulfilled
    bench.send("robot1", Resume(execution=issue.execution))
    bench.run()
    assert bench.of(Finished)
    assert bench.world.touches == 0


def test_nobody_says_that_a_door_is_open_that_is_shut() -> None:
    bench = BuildingBench(shut_doors=1.0)
    shut = next(n for n, each in bench.world.doors.items() if each.plan.opens.value == "people")
    bench.go("robot1", shut.replace("/", "-"))
    bench.run_until(IssueDetected)
    bench.run()
    bench.send("robot1", Look(expect="way_clear", within_s=3.0))
    bench.run()
    assert bench.of(Looked)[-1].fulfilled is False


@pytest.mark.slow(2)
def test_robots_on_one_floor_pass_each_other_without_touching() -> None:
    bench = BuildingBench(scene_of(made_up(rooms=8), "office", 3), seed=2)
    names = sorted(each for each in bench.scene.places if each.startswith("F1-1"))
    for turn in range(2):
        for number, robot in enumerate(bench.scene.robots):
            bench.go(robot, names[(turn * 3 + number * 2) % len(names)])
        bench.run()
    assert bench.world.touches == 0
    assert len(bench.of(Finished)) == 6


def test_the_same_seed_is_the_same_building() -> None:
    ends = []
    for seed in (5, 5):
        bench = BuildingBench(shut_doors=0.5, seed=seed)
        bench.go("robot1", rooms(bench)[0])
        bench.run()
        ends.append(bench.world.snapshot())
    assert ends[0] == ends[1]


def test_a_snapshot_is_gone_on_from() -> None:
    bench = BuildingBench(shut_doors=0.5)
    bench.go("robot1", rooms(bench)[1])
    for _ in range(60):
        bench.group.advance(0.05)
    kept = json.loads(json.dumps(bench.world.snapshot(), allow_nan=False))
    other = BuildingBench(shut_doors=0.5, seed=9)
    other.world.restore(kept)
    assert other.world.snapshot() == kept
    with pytest.raises(ValueError, match="expected 2 robots, got 1"):
        BuildingBench(robots=2).world.restore(kept)


def test_people_do_what_can_be_done_in_a_building() -> None:
    bench = BuildingBench()
    block = Intervention(act=Act.BLOCK)
    assert bench.world.intervene(block) == "nobody stands in the way of robots that stand"
    assert bench.world.intervene(AWAY) == "nothing is in the way of any robot"
    bench.go("robot1", rooms(bench)[0])
    for _ in range(30):
        bench.group.advance(0.05)
    assert bench.world.intervene(block) == ""
    assert len(bench.world.bystanders) == 1
    bench.run()
    assert bench.of(Finished), "it goes round one who stands in a corridor"
    assert bench.world.touches == 0
    cover = Intervention(act=Act.COVER)
    assert "nothing in a building" in bench.world.intervene(cover)


def test_nobody_stands_in_a_wall_or_in_a_robot() -> None:
    bench = BuildingBench()
    room = rooms(bench)[0]
    bench.go("robot1", room)
    answers = set()
    while bench.group.advance(0.25):
        answers.add(bench.world.intervene(Intervention(act=Act.BLOCK)))
        for each in bench.world.bystanders:
            away_m = distances_m(
                np.array([[each.at.x, each.at.y]]),
                bench.world.building.floors[each.at.floor].wall_segments,
            )
            assert away_m[0] >= RADIUS_M
        bench.world.bystanders.clear()
    assert "" in answers
    assert bench.world.touches == 0


def test_robots_show_on_which_floor_they_are() -> None:
    scene = scene_of(made_up(floors=2), "office", 2)
    bench = BuildingBench(scene)
    bench.go("robot2", next(each for each in scene.places if each.startswith("F2-")))
    bench.run()
    shown = [each.poses().base[2] for each in bench.group.agents]
    assert shown == [each.z for each in scene.robots.values()]
    assert shown[0] != shown[1]


def test_a_shut_door_is_still_shut_for_who_stands_beside_the_lane() -> None:
    bench = BuildingBench(scene_of(made_up(1, 6, 7), "office", 2), shut_doors=1.0, unmapped=0.2)
    bench.go("robot1", "F1-101")
    bench.run_until(IssueDetected)
    bench.run()
    robot = bench.world.robots[0]
    at = robot.at
    for aside_m in (-0.3, 0.0, 0.3):
        robot.stand(replace(at, x=at.x + aside_m))
        bench.send("robot1", Look(expect="way_clear", within_s=1.0))
        bench.run()
        assert bench.of(Looked)[-1].fulfilled is False


def test_a_snapshot_of_before_there_were_baskets_is_gone_on_from() -> None:
    bench = BuildingBench()
    kept = bench.world.snapshot()
    for later in ("items", "wishes", "baskets", "batteries"):
        del kept[later]
    again = BuildingBench().world
    again.restore(kept)
    assert again.snapshot()["robots"] == kept["robots"]
