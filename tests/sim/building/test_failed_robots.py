"""A robot that has failed and stands in a way: others say so, and people push it aside."""

import math

import pytest
from building_bench import BuildingBench, made_up

from mend.robots.link.messages import (
    Avoid,
    FailedRobot,
    Finished,
    IssueDetected,
    Look,
    Looked,
    Resume,
)
from mend.sim.building.floor_pose import FloorPose
from mend.tasks.frames import frames_of
from mend.tasks.intervention import Act, Intervention

THERE = "F1-103"


def in_a_doorway(localizer: str = "exact") -> BuildingBench:
    """The second robot has failed in the door of the room where the first one is to go."""
    bench = BuildingBench(robots=2, localizer=localizer)
    door = made_up().floors["F1"].doors["103"]
    (ax, ay), (bx, by) = door.posts
    failed = bench.world.robots[1]
    failed.stand(FloorPose("F1", (ax + bx) / 2.0, (ay + by) / 2.0, 0.0))
    return bench


def tell(bench: BuildingBench) -> None:
    """The first robot is told where the second one stands, in its own frame."""
    at = bench.world.robots[1].at
    x, y = frames_of(bench.scene)["robot1"].to_robot(at.x, at.y)
    height_m = made_up().floors["F1"].height
    stands = FailedRobot(robot="robot2", x=x, y=y, z=height_m)
    bench.send("robot1", Avoid(failed=[stands]))


def asks(bench: BuildingBench) -> IssueDetected:
    bench.go("robot1", THERE)
    issue = bench.run_until(IssueDetected)
    bench.run()
    return issue


def push(bench: BuildingBench) -> str:
    return bench.world.intervene(Intervention(act=Act.RELEASE, object="robot2"))


def test_who_is_told_says_that_it_is_a_robot_that_has_failed() -> None:
    bench = in_a_doorway()
    tell(bench)
    issue = asks(bench)
    assert issue.issue == "blocked"
    assert issue.detection is not None
    assert issue.detection.robot == "robot2"
    assert issue.detection.explanation.startswith("robot2 has failed, and has stood ")
    assert issue.detection.explanation.endswith("; it may be pushed aside")


def test_who_is_told_nothing_says_no_more_than_it_sees() -> None:
    issue = asks(in_a_doorway())
    assert issue.detection is not None
    assert issue.detection.robot is None
    assert "robot2" not in issue.detection.explanation


def test_who_asks_for_it_is_let_through_by_people() -> None:
    bench = in_a_doorway()
    tell(bench)
    issue = asks(bench)
    before = bench.world.robots[1].at
    assert push(bench) == ""
    now = bench.world.robots[1].at
    assert now.floor == before.floor
    assert 0.9 < math.dist((now.x, now.y), (before.x, before.y)) < 1.7
    bench.send("robot1", Look(expect="way_clear", within_s=10.0))
    bench.run()
    assert bench.of(Looked)[-1].fulfilled
    bench.send("robot1", Resume(execution=issue.execution))
    bench.run()
    assert bench.of(Finished)
    assert bench.world.touches == 0


def test_who_was_pushed_aside_finds_out_where_it_is_or_asks() -> None:
    bench = in_a_doorway("enml")
    assert push(bench) == ""
    bench.go("robot2", "F1-101")
    bench.run()
    asked = {each.issue for each in bench.of(IssueDetected)}
    assert bench.of(Finished) or asked == {"lost"}
    assert bench.world.touches == 0


@pytest.mark.parametrize(("floor", "why"), [("/lift1", "does not stand where anybody")])
def test_nobody_pushes_a_robot_in_a_cabin_that_is_shut(floor: str, why: str) -> None:
    bench = in_a_doorway()
    bench.world.robots[1].ride(floor)
    assert why in push(bench)
