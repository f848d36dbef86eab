"""Two robots meet in a doorway: what each says is true, and somebody pushes one aside."""

from building_bench import BuildingBench, made_up

from mend.robots.link.messages import Finished, IssueDetected, Resume
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.goods import Wish
from mend.tasks.intervention import Act, Intervention

CLEAR = Intervention(act=Act.RELEASE)
ROOM = "101"


def face_to_face() -> BuildingBench:
    """One is to go into a room that the other one is to leave."""
    bench = BuildingBench(robots=2)
    floor = made_up().floors["F1"]
    room, door = floor.places[ROOM], floor.doors[ROOM]
    (ax, ay), (bx, by) = door.posts
    x, y = (ax + bx) / 2.0, (ay + by) / 2.0
    outside = FloorPose("F1", 2.0 * x - room.x, 2.0 * y - room.y, 0.0)
    bench.world.robots[0].stand(outside)
    bench.world.robots[1].stand(FloorPose("F1", room.x, room.y, 0.0))
    bench.go("robot1", f"F1-{ROOM}")
    bench.go("robot2", "F1-103")
    while len(bench.of(IssueDetected)) < 2 and bench.group.advance(1.0):
        pass
    bench.run()
    return bench


def test_nobody_says_that_an_open_door_is_shut() -> None:
    bench = face_to_face()
    assert [each.issue for each in bench.of(IssueDetected)] == ["blocked", "blocked"]


def test_who_is_asked_pushes_one_aside_and_both_get_on() -> None:
    bench = face_to_face()
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
