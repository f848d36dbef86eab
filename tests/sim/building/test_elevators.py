"""Robots ride elevators, ask people where they cannot call them, and notice the wrong floor."""

import json
import math
from typing import Any

import numpy as np
import pytest
from building_bench import BuildingBench, made_up
from sampled import sample

from mend.maps.building.building import Building, BuildingDocument, Caller
from mend.maps.building.cabin import CORNER_M, cabin_walls, stop_of
from mend.maps.building.clearance import distances_m
from mend.robots.base.body import Velocity
from mend.robots.link.messages import (
    Finished,
    Interrupt,
    IssueDetected,
    Look,
    Looked,
    Rejected,
    Resume,
    StepStarted,
)
from mend.sim.building.cabin import CabinState
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.scene import scene_of
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scene import Scene

PRESS = Intervention(act=Act.RELEASE)


def called_by(caller: Caller, floors: int = 2, seed: int = 3) -> Building:
    document = made_up(floors=floors, seed=seed).document.model_dump(mode="json")
    for each in document["elevators"].values():
        each["called_by"] = caller
    return Building(BuildingDocument.model_validate_json(json.dumps(document)))


def office(caller: Caller, floors: int = 2, robots: int = 1, seed: int = 3) -> Scene:
    return scene_of(called_by(caller, floors, seed), "office", robots)


def see_through(bench: BuildingBench, within_s: float = 60.0) -> bool:
    """Somebody does what was asked, and the robot looks whether that is so."""
    assert bench.world.intervene(PRESS) == ""
    bench.send("robot1", Look(expect="way_clear", within_s=within_s))
    bench.run()
    return bool(bench.of(Looked)[-1].fulfilled)


def test_a_robot_rides_to_a_room_of_another_floor() -> None:
    bench = BuildingBench(office(Caller.ROBOTS))
    bench.go("robot1", "F2-201")
    bench.run()
    assert bench.of(Finished)
    assert bench.world.robots[0].at.floor == "F2"
    assert bench.world.touches == 0
    names = [each.name for each in bench.of(StepStarted)]
    assert names == ["go to lift1", "get into lift1", "ride to F2", "go to F2-201"]


def test_ride_elevator_ends_before_the_elevator_on_the_other_floor() -> None:
    bench = BuildingBench(office(Caller.ROBOTS))
    bench.go("robot1", "F2-201", "ride_elevator")
    bench.run()
    at, elevators = bench.world.robots[0].at, bench.world.elevators
    assert at.floor == "F2"
    assert not elevators.is_in_a_cabin("F2", at.x, at.y, 0.25)
    bench.go("robot1", "F2-203", "ride_elevator")
    bench.run()
    assert bench.of(Finished)[-1].found_in_place


@pytest.mark.slow
def test_who_has_got_out_calls_the_elevator_no_more() -> None:
    bench = BuildingBench(office(Caller.ROBOTS))
    cabin = bench.world.elevators.cabins["lift1"]
    for goal in ("F2-201", "F1-102", "F2-203"):
        bench.reports.clear()
        bench.go("robot1", goal)
        bench.run()
        assert bench.of(Finished)
        assert not cabin.calls
        assert cabin.floor == goal[:2]


def test_an_elevator_that_people_call_is_asked_for() -> None:
    bench = BuildingBench(office(Caller.PEOPLE))
    bench.go("robot1", "F2-201")
    issue = bench.run_until(IssueDetected)
    assert issue.issue == "elevator_help"
    assert issue.detection is not None
    assert issue.detection.explanation == "I need lift1 to get from F1 to F2"
    bench.run()
    assert see_through(bench)
    bench.send("robot1", Resume(execution=issue.execution))
    bench.run()
    assert bench.of(Finished)
    assert bench.world.robots[0].at.floor == "F2"


def test_nobody_is_thanked_for_an_elevator_that_does_not_come() -> None:
    bench = BuildingBench(office(Caller.PEOPLE))
    bench.go("robot1", "F2-201")
    bench.run_until(IssueDetected)
    bench.run()
    bench.send("robot1", Look(expect="way_clear", within_s=30.0))
    bench.run()
    assert bench.of(Looked)[-1].fulfilled is False


def test_the_wrong_floor_is_noticed_and_left_by_another_ride() -> None:
    bench = BuildingBench(office(Caller.PEOPLE, floors=3), wrong_floors=1.0)
    bench.go("robot1", "F2-201")
    issue = bench.run_until(IssueDetected)
    bench.run()
    assert see_through(bench)
    bench.send("robot1", Resume(execution=issue.execution))
    noticed = bench.run_until(IssueDetected)
    assert noticed.issue == "wrong_floor"
    assert noticed.detection is not None
    assert noticed.detection.explanation == "lift1 has opened at F3, and I must get to F2"
    bench.run()
    bench.world.interveners.wrong_floors = 0.0
    assert see_through(bench)
    bench.send("robot1", Resume(execution=issue.execution))
    bench.run()
    assert bench.of(Finished)
    assert bench.world.robots[0].at.floor == "F2"
    assert bench.world.touches == 0


@pytest.mark.slow
@pytest.mark.parametrize("seed", sample([3], [3, 4]))
def test_robots_that_want_one_elevator_ride_one_after_the_other(seed: int) -> None:
    bench = BuildingBench(office(Caller.ROBOTS, floors=2, robots=3, seed=seed), seed=seed)
    rooms = {"F1": "F2-201", "F2": "F1-101"}
    for number, robot in enumerate(bench.scene.robots):
        floor = bench.world.robots[number].at.floor
        bench.go(robot, f"{rooms[floor][:-1]}{number + 1}")
    bench.run()
    assert len(bench.of(Finished)) == 3
    assert not bench.of(IssueDetected)
    assert bench.world.touches == 0


@pytest.mark.parametrize("turn", range(16))
def test_a_cabin_shuts_on_nobody_who_stands_at_its_corner(turn: int) -> None:
    bench = BuildingBench(office(Caller.ROBOTS))
    world, robot = bench.world, bench.world.robots[0]
    cabin, (x, y) = world.elevators.cabins["lift1"], stop_of(world.building, "lift1", "F1")
    cabin.state, angle = CabinState.OPEN, turn * math.tau / 16
    robot.stand(FloorPose("F1", x + 0.87 * math.cos(angle), y + 0.87 * math.sin(angle)))
    for _ in range(200):
        world.advance_cycle()
    if cabin.state is not CabinState.OPEN:
        at = np.array([[robot.at.x, robot.at.y]])
        assert distances_m(at, cabin_walls((x, y)))[0] >= robot.radius_m


@pytest.mark.parametrize(("speed_m_s", "state"), [(1.0, CabinState.OPEN), (0.0, CabinState.SHUT)])
def test_a_cabin_shuts_on_nobody_who_drives_by_too_fast_to_stop(
    speed_m_s: float, state: CabinState
) -> None:
    bench = BuildingBench(office(Caller.ROBOTS))
    elevators, robot = bench.world.elevators, bench.world.robots[0]
    cabin, (x, y) = elevators.cabins["lift1"], stop_of(called_by(Caller.ROBOTS), "lift1", "F1")
    cabin.floor, cabin.state = "F1", CabinState.OPEN
    cabin.call(7, "F2", "F1")
    robot.stand(FloorPose("F1", x - CORNER_M - robot.radius_m - 0.4, y, 0.0))
    robot.move(Velocity(speed_m_s, 0.0, 0.0))
    for _ in range(40):
        robot.next_pose()
    elevators.pass_time(5.0, [robot], {}, lambda _: [])
    assert cabin.state is state


def test_who_gives_up_wants_the_elevator_no_more() -> None:
    bench = BuildingBench(office(Caller.PEOPLE))
    bench.go("robot1", "F2-201")
    bench.run_until(IssueDetected)
    bench.run()
    bench.send("robot1", Interrupt(retreat=True))
    bench.run()
    assert bench.world.intervene(PRESS) == "nothing is in the way of any robot"


def test_who_gives_up_in_a_cabin_gets_out_of_it() -> None:
    bench = BuildingBench(office(Caller.ROBOTS, floors=3))
    bench.go("robot1", "F3-301")
    while not any(each.name == "ride to F3" for each in bench.of(StepStarted)):
        bench.group.advance(0.5)
    bench.send("robot1", Interrupt(retreat=True))
    bench.run()
    at, elevators = bench.world.robots[0].at, bench.world.elevators
    assert not elevators.is_in_a_cabin(at.floor, at.x, at.y, 0.25)
    assert at.floor in bench.world.building.floors
    assert bench.world.touches == 0


def test_who_gave_up_in_a_cabin_goes_on_from_where_it_got_out() -> None:
    bench = BuildingBench(office(Caller.ROBOTS, floors=3))
    bench.go("robot1", "F3-301")
    while bench.world.elevators.cabins["lift1"].state is not CabinState.MOVING or not any(
        each.name == "ride to F3" for each in bench.of(StepStarted)
    ):
        bench.group.advance(0.5)
    bench.send("robot1", Interrupt(retreat=True))
    bench.run()
    bench.go("robot1", "F2-201")
    bench.run()
    assert bench.of(Finished)
    assert bench.world.robots[0].at.floor == "F2"
    assert bench.world.touches == 0


def rebuilt_between_floors() -> tuple[dict[str, Any], BuildingBench]:
    scene = office(Caller.ROBOTS)
    bench = BuildingBench(scene)
    bench.go("robot1", "F2-201")
    floors = bench.world.building
    while floors.floor_at(bench.world.robots[0].pose().z) is not None:
        bench.group.advance(0.05)
    snapshot = json.loads(json.dumps(bench.group.snapshot()))
    return snapshot, BuildingBench(scene, snapshot=snapshot)


def test_a_building_is_rebuilt_in_the_middle_of_a_ride() -> None:
    snapshot, again = rebuilt_between_floors()
    assert again.group.snapshot() == snapshot


def test_a_robot_that_begins_anew_between_floors_rides_on_before_it_does_anything() -> None:
    _, again = rebuilt_between_floors()
    again.go("robot1", "F2-201")
    again.run()
    assert [again.of(Rejected), len(again.of(Finished))] == [[], 1]
    assert again.world.robots[0].at.floor == "F2"
    assert again.world.touches == 0
