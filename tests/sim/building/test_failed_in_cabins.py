"""A robot that works no more stands in a cabin: who wants to ride says so, and it is pushed out."""

import math

import pytest
from building_bench import BuildingBench, made_up

from mend.maps.building.cabin import CORNER_M, stop_of
from mend.robots.link.messages import (
    Avoid,
    FailedRobot,
    Finished,
    IssueDetected,
    Look,
    Looked,
    Resume,
)
from mend.sim.building.cabin import CabinState
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.scene import scene_of
from mend.tasks.frames import frames_of
from mend.tasks.intervention import Act, Intervention

pytestmark = pytest.mark.slow(2)

BUILDING = made_up(floors=2)


def in_the_cabin(*, told: bool = True) -> BuildingBench:
    """The second robot stands in the cabin where the first one wants to ride."""
    bench = BuildingBench(scene_of(BUILDING, "office", 2))
    (name,) = BUILDING.document.elevators
    first = next(n for n, each in enumerate(bench.world.robots) if each.at.floor == "F1")
    assert first == 0, "the first one is on the first floor"
    x, y = stop_of(BUILDING, name, "F1")
    bench.world.robots[1].stand(FloorPose(f"/{name}", x, y))
    if told:
        at_x, at_y = frames_of(bench.scene)["robot1"].to_robot(x, y)
        height_m = BUILDING.floors["F1"].height
        failed = FailedRobot(robot="robot2", x=at_x, y=at_y, z=height_m)
        bench.send("robot1", Avoid(failed=[failed]))
    bench.go("robot1", "F2-201")
    return bench


def test_who_is_told_asks_for_that_and_rides_once_it_is_out() -> None:
    bench = in_the_cabin()
    issue = bench.run_until(IssueDetected)
    assert issue.issue == "elevator_help"
    assert issue.detection is not None
    assert issue.detection.robot == "robot2"
    assert "and robot2, which has failed, has to be pushed out" in issue.detection.explanation
    bench.run()
    assert not bench.world.intervene(Intervention(act=Act.RELEASE, object="robot2"))
    assert out_of_cabin(bench)
    bench.send("robot1", Look(expect="way_clear", within_s=120.0))
    bench.run()
    assert bench.of(Looked)[-1].fulfilled, "who pushed it out has pressed the button, too"
    bench.send("robot1", Resume(execution=issue.execution))
    bench.run_until(Finished)
    assert bench.world.robots[0].at.floor == "F2"
    assert bench.world.touches == 0


def test_a_cabin_stays_open_for_it_and_people_who_are_asked_anything_push_it_out() -> None:
    bench = in_the_cabin(told=False)
    issue = bench.run_until(IssueDetected)
    assert issue.detection is not None
    assert issue.detection.robot is None, "it was not told"
    bench.run()
    (cabin,) = bench.world.elevators.cabins.values()
    assert (cabin.state, cabin.floor) == (CabinState.OPEN, "F1")
    for _ in range(2):
        assert not bench.world.intervene(Intervention(act=Act.RELEASE))
    assert out_of_cabin(bench), "they press the button first, which does not help"


def out_of_cabin(bench: BuildingBench) -> bool:
    """Whether all of the second robot is."""
    at, stop = bench.world.robots[1].at, stop_of(BUILDING, "lift1", "F1")
    return at.floor == "F1" and math.dist((at.x, at.y), stop) > CORNER_M
