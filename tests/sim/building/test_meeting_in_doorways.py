"""Two robots meet in a doorway: one makes way, or else what each says is true and people help."""

import pytest
from building_bench import LONGEST_S, BuildingBench, made_up
from met_robots import MetRobots
from sampled import sample

from mend.robots.link.messages import Finished, Interrupt, IssueDetected, Resume
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.goods import Wish
from mend.tasks.intervention import Act, Intervention

CLEAR = Intervention(act=Act.RELEASE)
ROOM = "101"


def face_to_face(seed: int = 1) -> BuildingBench:
    """One is to go into a room that the other one is to leave."""
    bench = BuildingBench(robots=2, seed=seed)
    floor = made_up().floors["F1"]
    room, door = floor.places[ROOM], floor.doors[ROOM]
    (ax, ay), (bx, by) = door.posts
    x, y = (ax + bx) / 2.0, (ay + by) / 2.0
    outside = FloorPose("F1", 2.0 * x - room.x, 2.0 * y - room.y, 0.0)
    bench.world.robots[0].stand(outside)
    bench.world.robots[1].stand(FloorPose("F1", room.x, room.y, 0.0))
    bench.go("robot1", f"F1-{ROOM}")
    bench.go("robot2", "F1-103")
    return bench


def untold() -> BuildingBench:
    """Robots that no fleet has."""
    bench = face_to_face()
    while len(bench.of(IssueDetected)) < 2 and bench.group.advance(1.0):
        pass
    bench.run()
    return bench


@pytest.mark.parametrize("seed", sample(range(2), range(3)))
def test_who_is_told_makes_way_and_nobody_is_asked(seed: int) -> None:
    bench = face_to_face(seed)
    robots = MetRobots(bench, {"robot1": f"F1/{ROOM}", "robot2": "F1/103"})
    while robots.advance(0.5):
        assert bench.group.time_s() < LONGEST_S, "they stand before each other for ever"
    assert len(bench.of(Finished)) == 2
    assert not bench.of(IssueDetected)
    assert sorted(robot for robot, _ in robots.told) == ["robot1", "robot2"]
    assert sorted(bool(told.way) for _, told in robots.told) == [False, True]
    assert bench.world.touches == 0


def test_who_rests_in_the_way_is_sent_elsewhere() -> None:
    bench = face_to_face()
    bench.send("robot2", Interrupt(retreat=True))
    robots = MetRobots(bench, {"robot1": f"F1/{ROOM}"})
    door = made_up().floors["F1"].doors[ROOM].posts
    x, y = (sum(each) / 2.0 for each in zip(*door, strict=True))
    bench.world.robots[1].stand(FloorPose("F1", x, y, 0.0))
    while not robots.sent and not bench.of(IssueDetected):
        robots.advance(0.5)
    ((robot, place),) = robots.sent
    assert robot == "robot2"
    assert place not in (None, f"F1/{ROOM}")


def test_nobody_says_that_an_open_door_is_shut() -> None:
    bench = untold()
    assert [each.issue for each in bench.of(IssueDetected)] == ["blocked", "blocked"]


@pytest.mark.slow
def test_who_is_asked_pushes_one_aside_and_both_get_on() -> None:
    bench = untold()
    assert bench.world.intervene(CLEAR) == ""
    for number in (1, 2):
        bench.send(f"robot{number}", Resume(execution=f"e{number}"))
        bench.run()
    while len(bench.of(Finished)) < 2:
        asked = [name for name, each in bench.reports if isinstance(each, IssueDetected)]
        assert len(asked) < 10, "they stand before each other for ever"
        assert bench.world.intervene(CLEAR) == ""
        bench.send(asked[-1], Resume(execution=f"e{asked[-1][-1]}"))
        bench.run()
    assert bench.world.touches == 0


def test_who_waits_for_people_at_a_place_is_not_pushed_away() -> None:
    bench = BuildingBench(robots=2)
    at = bench.world.robots[0].at
    bench.world.robots[1].stand(FloorPose(at.floor, at.x + 1.2, at.y, 0.0))
    for number in range(2):
        bench.world.goods.wishes[number] = Wish("mail", "F1-101", hands_over=True)
    assert bench.world.intervene(CLEAR) == "nothing is in the way of any robot"
    bench.world.goods.wishes.clear()
    assert bench.world.intervene(CLEAR) == ""
