"""What people take out of a broken robot's basket for another one is missed by nobody."""

import math

from building_bench import BuildingBench, made_up

from mend.robots.link.messages import Finished, IssueDetected, NoteTaken, Resume
from mend.sim.building.floor_pose import FloorPose
from mend.sim.building.scene import scene_of
from mend.tasks.intervention import Act, Intervention

HERE = "F1-101"


def collects(bench: BuildingBench, robot: str, **more: str) -> None:
    bench.go(robot, HERE, "collect_item", item="mail", **more)
    issue = bench.run_until(IssueDetected)
    assert issue.issue == "item_not_given"
    bench.run()
    assert bench.world.intervene(Intervention(act=Act.PUT_IN)) == ""
    bench.send(robot, Resume(execution=issue.execution))
    bench.run()


def rescued() -> BuildingBench:
    """The first robot has the mail and stands aside; people put it into the second one's basket."""
    bench = BuildingBench(robots=2)
    collects(bench, "robot1")
    first = bench.world.robots[0]
    first.stand(FloorPose(first.at.floor, first.at.x, first.at.y - 2.0, -math.pi / 2))
    collects(bench, "robot2", held_by="robot1")
    assert len(bench.of(Finished)) == 2
    assert bench.world.goods.items["mail"].robot == 1
    return bench


def test_people_bring_it_from_wherever_on_the_floor_that_robot_stands() -> None:
    bench = BuildingBench(scene=scene_of(made_up(rooms=12), "office", 2), robots=2)
    collects(bench, "robot1")
    first, here = bench.world.robots[0], bench.scene.places[HERE].pose
    poses = [each.pose for each in bench.scene.places.values()]
    far = max(poses, key=lambda each: math.hypot(each.x - here.x, each.y - here.y))
    assert math.hypot(far.x - here.x, far.y - here.y) > 10.0
    first.stand(FloorPose(first.at.floor, far.x, far.y, 0.0))
    collects(bench, "robot2", held_by="robot1")
    assert bench.world.goods.items["mail"].robot == 1


def test_a_robot_that_is_told_misses_nothing_when_it_works_again() -> None:
    bench = rescued()
    bench.send("robot1", NoteTaken(items=["mail"]))
    bench.go("robot1", "F1-103", "go_to")
    bench.run()
    assert not [each for each in bench.of(IssueDetected) if each.issue == "item_taken"]
    assert len(bench.of(Finished)) == 3
    assert bench.world.baskets[0].memory.items == {}


def test_a_robot_that_is_told_nothing_asks_for_it() -> None:
    bench = rescued()
    bench.go("robot1", "F1-103", "go_to")
    assert bench.run_until(IssueDetected).issue == "item_taken"


def test_who_is_told_while_it_asks_feels_its_basket_as_it_is_to_be() -> None:
    bench = rescued()
    bench.go("robot1", "F1-103", "go_to")
    issue = bench.run_until(IssueDetected)
    bench.run()
    bench.send("robot1", NoteTaken(items=["mail"]))
    assert bench.world.baskets[0].memory.items == {}
    bench.send("robot1", Resume(execution=issue.execution))
    bench.run()
    assert len(bench.of(Finished)) == 3
