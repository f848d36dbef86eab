"""Robots of a building that find where they are: right, or lost and saying so; never a danger."""

import json
import math

import numpy as np
import pytest
from building_bench import BuildingBench, made_up
from sampled import sample

from mend.robots.link.messages import Finished, IssueDetected, Look, Looked, Resume
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.scene import scene_of

pytestmark = pytest.mark.slow(2)


def localized(rooms: int = 6, seed: int = 2, **options: float) -> BuildingBench:
    scene = scene_of(made_up(1, rooms), "office", 1)
    return BuildingBench(scene, seed=seed, localizer="enml", unmapped=0.33, **options)


def off_m(bench: BuildingBench) -> float:
    robot = bench.world.robots[0]
    assert robot.belief is not None
    return math.hypot(robot.belief.at.x - robot.at.x, robot.belief.at.y - robot.at.y)


def rooms_of(bench: BuildingBench) -> list[str]:
    return sorted(each for each in bench.scene.places if each.startswith("F1-1"))


def test_a_robot_among_furniture_gets_to_where_it_is_sent() -> None:
    bench = localized()
    for room in rooms_of(bench)[: sample(2, 4)]:
        bench.go("robot1", room)
        bench.run()
        at, pose = bench.world.robots[0].at, bench.scene.places[room].pose
        assert math.hypot(at.x - pose.x, at.y - pose.y) < 0.12
        assert off_m(bench) < 0.08
    assert len(bench.of(Finished)) == sample(2, 4)
    assert bench.world.touches == 0


def test_who_believes_wrongly_where_it_is_touches_nothing() -> None:
    bench = localized()
    robot = bench.world.robots[0]
    assert robot.belief is not None
    wrong_by = np.random.default_rng(1)
    for room in rooms_of(bench)[: sample(1, 2)]:
        bench.go("robot1", room)
        for _ in range(8):
            at = robot.at
            wrong = np.array([at.x, at.y, at.yaw]) + wrong_by.normal(0.0, [0.6, 0.6, 0.3])
            robot.belief.whereabouts.start_anew(wrong, np.array(robot.odometer.pose), lost=False)
            bench.group.advance(1.0)
    assert bench.world.touches == 0


def carried_to_where_places_look_alike() -> tuple[BuildingBench, IssueDetected]:
    """Seeds are tried until the robot does not find out by itself."""
    for seed in range(2, 12):
        bench = localized(rooms=8, seed=seed)
        bench.go("robot1", rooms_of(bench)[-1])
        for _ in range(40):
            bench.group.advance(0.1)
        floor = bench.world.building.floors["F1"]
        place = floor.places["101"]
        bench.world.robots[0].stand(FloorPose("F1", place.x, place.y, 0.3))
        for _ in range(120):
            bench.group.advance(0.1)
            lost = [each for each in bench.of(IssueDetected) if each.issue == "lost"]
            if lost and lost[0].detection is not None and lost[0].detection.guesses:
                bench.run()
                return bench, lost[0]
    raise AssertionError("no seed leaves anything open")


def test_who_is_carried_says_that_it_is_lost_and_goes_on_once_it_is_told() -> None:
    bench, issue = carried_to_where_places_look_alike()
    assert issue.detection is not None
    assert bench.world.robots[0].whereabouts.is_lost
    at = bench.world.robots[0].at
    bench.send("robot1", Look(expect="located"))
    bench.run()
    assert bench.of(Looked)[-1].fulfilled is False
    for guess in (*issue.detection.guesses, "at F1-101"):
        bench.send("robot1", Look(expect="located", guess="at nowhere"))
        bench.run()
        assert bench.of(Looked)[-1].fulfilled is False, "nothing that it sees says so"
        if guess.endswith("F1-101"):
            bench.send("robot1", Look(expect="located", guess=guess))
            bench.run()
            break
    assert bench.of(Looked)[-1].fulfilled
    robot = bench.world.robots[0]
    assert robot.at == at, "it stood"
    assert robot.belief is not None
    assert bench.scene.places["F1-101"].pose.x == pytest.approx(robot.belief.at.x, abs=2.0)
    bench.send("robot1", Resume(execution=issue.execution))
    bench.run_until(Finished)
    assert bench.world.touches == 0


def carried_on_its_way(draw: np.random.Generator) -> BuildingBench:
    """Into a room that looks like the others, soon after it set out."""
    bench = localized(rooms=int(draw.integers(5, 10)), seed=int(draw.integers(1, 1000)))
    goal, room = draw.choice(rooms_of(bench), 2, replace=False)
    bench.go("robot1", goal)
    for _ in range(int(draw.integers(15, 40))):
        bench.group.advance(0.1)
    place = bench.world.building.floors["F1"].places[room.removeprefix("F1-")]
    yaw = float(draw.uniform(-math.pi, math.pi))
    bench.world.robots[0].stand(FloorPose("F1", place.x, place.y, yaw))
    return bench


def test_who_is_carried_on_its_way_soon_says_so_or_knows_where_it_is() -> None:
    draw = np.random.default_rng(8)
    for _ in range(sample(3, 40)):
        bench = carried_on_its_way(draw)
        robot = bench.world.robots[0]
        assert robot.belief is not None
        for _ in range(100):
            bench.group.advance(0.1)
            if robot.belief.whereabouts.is_lost or off_m(bench) < 1.0:
                break
        else:
            raise AssertionError(f"{off_m(bench):.1f} m off without a word")


def test_what_a_robot_believed_is_kept() -> None:
    bench = localized()
    bench.go("robot1", rooms_of(bench)[1])
    for _ in range(60):
        bench.group.advance(0.05)
    robot = bench.world.robots[0]
    assert robot.belief is not None
    at = robot.belief.at
    wrong = np.array([at.x + 0.3, at.y, at.yaw])
    robot.belief.whereabouts.start_anew(wrong, np.array(robot.odometer.pose), lost=False)
    kept = json.loads(json.dumps(bench.world.snapshot(), allow_nan=False))
    other = localized(seed=9)
    other.world.restore(kept)
    belief = other.world.robots[0].belief
    assert belief is not None
    assert (belief.at.x, belief.at.y) == pytest.approx((wrong[0], wrong[1]))
    assert other.world.snapshot()["draws"] == kept["draws"]
    robot.belief.whereabouts.start_anew(wrong, np.array(robot.odometer.pose), lost=True)
    other.world.restore(json.loads(json.dumps(bench.world.snapshot())))
    assert belief.whereabouts.is_lost


def test_another_floor_is_entered_where_the_last_one_was_left() -> None:
    scene = scene_of(made_up(2, 4), "office", 1)
    bench = BuildingBench(scene, localizer="enml")
    robot = bench.world.robots[0]
    before = robot.pose()
    robot.get_out_at("F2", (0.0, 0.0))
    assert robot.at.floor == "F2"
    after = robot.pose()
    assert (after.x, after.y, after.yaw) == pytest.approx((before.x, before.y, before.yaw))
    assert after.z == scene.setting["floors"]["F2"]["height"]
