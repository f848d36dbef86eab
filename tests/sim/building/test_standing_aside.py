"""A base that is told to make way drives there, waits, and goes on; or waits for who makes way."""

import pytest
from building_bench import BuildingBench, made_up

from mend.robots.link.messages import Finished, IssueDetected, MakeWay, WayPoint
from mend.sim.building.building_robot import LIMITS, RADIUS_M
from mend.sim.building.floor_pose import FloorPose
from mend.tasks.frames import frames_of

ROOM, GOAL = "101", "F1-103"


def driving() -> BuildingBench:
    """One that leaves a room, with another one beside it on its floor."""
    bench = BuildingBench(robots=2)
    room = made_up().floors["F1"].places[ROOM]
    bench.world.robots[0].stand(FloorPose("F1", room.x, room.y, 0.0))
    bench.go("robot1", GOAL)
    return bench


def in_the_door(bench: BuildingBench) -> None:
    """The other one stands in the door through which the first is to leave."""
    (ax, ay), (bx, by) = made_up().floors["F1"].doors[ROOM].posts
    bench.world.robots[1].stand(FloorPose("F1", (ax + bx) / 2.0, (ay + by) / 2.0, 0.0))


def aside(bench: BuildingBench, until_s: float, z: float = 0.0) -> MakeWay:
    """0.6 m beside where it stands."""
    at = bench.world.robots[0].at
    x, y = frames_of(bench.scene)["robot1"].to_robot(at.x + 0.6, at.y)
    return MakeWay(other="robot2", way=[WayPoint(x=x, y=y)], z=z, until=until_s)


def test_who_is_told_to_drives_aside_waits_there_and_goes_on() -> None:
    bench = driving()
    start = bench.world.robots[0].at
    bench.send("robot1", aside(bench, 8.0))
    while bench.group.time_s() < 7.5:
        bench.group.advance(0.1)
    here = bench.world.robots[0].at
    assert (here.x, here.y) == pytest.approx((start.x + 0.6, start.y), abs=0.1)
    bench.run()
    assert len(bench.of(Finished)) == 1
    assert not bench.of(IssueDetected)


@pytest.mark.parametrize(("until_s", "z"), [(0.0, 0.0), (60.0, 4.0)], ids=["late", "other floor"])
def test_what_is_not_for_now_or_not_for_here_changes_nothing(until_s: float, z: float) -> None:
    plain, told = driving(), driving()
    told.send("robot1", aside(told, until_s, z))
    for bench in (plain, told):
        bench.run()
    assert told.group.time_s() == plain.group.time_s()


def test_who_is_let_pass_asks_nobody_until_then() -> None:
    bench = driving()
    in_the_door(bench)
    bench.send("robot1", MakeWay(other="robot2", until=20.0))
    asked = bench.run_until(IssueDetected)
    assert asked.issue == "blocked"
    assert 20.0 < bench.group.time_s() < 30.0


def test_who_asks_nobody_because_of_another_one_goes_on_once_it_is_gone() -> None:
    bench = driving()
    in_the_door(bench)
    bench.send("robot1", MakeWay(other="robot2", until=30.0))
    while bench.group.time_s() < 10.0:
        bench.group.advance(0.1)
    hall = made_up().floors["F1"].places["102"]
    bench.world.robots[1].stand(FloorPose("F1", hall.x, hall.y, 0.0))
    bench.run()
    assert len(bench.of(Finished)) == 1
    assert not bench.of(IssueDetected)
    assert bench.group.time_s() < 30.0


def test_it_says_whether_what_it_sees_leaves_it_no_way_on() -> None:
    bench = driving()
    agent = bench.group.agents[0]
    base = agent.hello("1").base
    assert base is not None
    assert (base.radius_m, base.speed_m_s) == (RADIUS_M, LIMITS.speed_m_s)
    in_the_door(bench)
    bench.send("robot1", MakeWay(other="robot2", until=1e6))
    while bench.group.time_s() < 10.0:
        bench.group.advance(0.1)
    assert agent.poses().barred is True
    assert bench.group.agents[1].poses().barred is None
