"""Places where somebody stands already: who meets people there comes as near as it can."""

import math

from building_bench import BuildingBench

from mend.robots.base.behaviors.behavior import MEETS_M
from mend.robots.link.messages import Finished, IssueDetected
from mend.sim.building.floor_pose import FloorPose


def taken_place() -> tuple[BuildingBench, str, tuple[float, float]]:
    """A bench of two robots, the second of which stands where a place of the first's is."""
    bench = BuildingBench(robots=2)
    place = next(each for each in bench.scene.places if each.startswith("F1-1"))
    at = bench.scene.places[place].pose
    bench.world.robots[1].stand(FloorPose("F1", at.x, at.y))
    return bench, place, (at.x, at.y)


def away_m(bench: BuildingBench, at: tuple[float, float]) -> float:
    here = bench.world.robots[0].at
    return math.dist((here.x, here.y), at)


def test_who_collects_something_asks_for_it_beside_who_stands_there() -> None:
    bench, place, at = taken_place()
    bench.go("robot1", place, "collect_item", item="mail")
    asked = bench.run_until(IssueDetected)
    assert asked.issue == "item_not_given"
    assert 2 * bench.world.robots[0].radius_m <= away_m(bench, at) <= MEETS_M
    assert bench.world.touches == 0


def test_who_is_to_be_near_a_place_is_there_as_near_as_that() -> None:
    bench, place, at = taken_place()
    bench.go("robot1", place, near_m=MEETS_M)
    bench.run_until(Finished)
    assert away_m(bench, at) <= MEETS_M
    assert not bench.of(IssueDetected)


def test_who_is_to_be_at_a_place_says_that_it_is_taken() -> None:
    bench, place, _ = taken_place()
    bench.go("robot1", place)
    asked = bench.run_until(IssueDetected)
    assert asked.issue == "blocked"
    assert not bench.of(Finished)


def test_a_place_that_is_free_is_gone_to_all_the_same() -> None:
    bench, place, at = taken_place()
    bench.world.robots[1].stand(FloorPose("F1", 1000.0, 1000.0))
    bench.go("robot1", place, near_m=MEETS_M)
    bench.run_until(Finished)
    assert away_m(bench, at) <= 0.05
