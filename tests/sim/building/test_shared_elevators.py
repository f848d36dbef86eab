"""Several robots share several elevators: who would wait long for one takes another one."""

import json

import pytest
from building_bench import BuildingBench, made_up

from mend.maps.building.building import Building, BuildingDocument, Caller
from mend.robots.link.messages import Finished, IssueDetected, StepStarted, WayFound
from mend.sim.building.elevator_bank import ElevatorBank
from mend.sim.building.scene import scene_of

RIDE_S, FLOOR_S = 90.0, 5.0


def two_lifts(callers: tuple[Caller, Caller] = (Caller.ROBOTS, Caller.ROBOTS)) -> Building:
    document = made_up(floors=2, rooms=33, seed=5).document.model_dump(mode="json")
    for each, caller in zip(document["elevators"].values(), callers, strict=True):
        each |= {"called_by": caller, "ride_s": RIDE_S, "floor_s": FLOOR_S}
    return Building(BuildingDocument.model_validate_json(json.dumps(document)))


def test_an_elevator_tells_how_long_those_take_who_are_to_ride_before() -> None:
    bank = ElevatorBank(two_lifts())
    first, second, third = (bank.of_robot(number) for number in range(3))
    bank.cabins["lift1"].call(0, "F1", "F2")
    second.heads_for("lift1")
    assert first.waits_s() == {"lift1": 0.0, "lift2": 0.0}
    assert second.waits_s() == {"lift1": RIDE_S + FLOOR_S, "lift2": 0.0}
    assert third.waits_s() == {"lift1": 2.0 * RIDE_S + FLOOR_S, "lift2": 0.0}
    second.withdraw()
    first.withdraw()
    assert third.waits_s() == {"lift1": 0.0, "lift2": 0.0}


def test_of_what_people_call_nobody_knows_who_waits() -> None:
    bank = ElevatorBank(two_lifts((Caller.PEOPLE, Caller.ROBOTS)))
    bank.cabins["lift1"].call(0, "F1", "F2")
    assert bank.of_robot(1).waits_s() == {"lift2": 0.0}


def rode(bench: BuildingBench) -> set[str]:
    """The elevators that robots got into."""
    names = [each.name for each in bench.of(StepStarted)]
    return {name.removeprefix("get into ") for name in names if name.startswith("get into ")}


@pytest.mark.slow(2)
def test_two_that_set_out_together_take_one_each() -> None:
    bench = BuildingBench(scene_of(two_lifts(), "office", 4))
    below = [name for name, base in bench.scene.robots.items() if base.z == 0.0]
    for robot, room in zip(below, ("F2-201", "F2-202"), strict=True):
        bench.go(robot, room)
    bench.run()
    assert rode(bench) == {"lift1", "lift2"}
    assert len(bench.of(Finished)) == 2
    assert not bench.of(WayFound), "none of them is dead"


@pytest.mark.slow(2)
def test_nobody_is_asked_to_call_one_because_the_other_is_wanted() -> None:
    callers = {1: (Caller.PEOPLE, Caller.ROBOTS), 2: (Caller.ROBOTS, Caller.PEOPLE)}
    alone = BuildingBench(scene_of(two_lifts(), "office", 1))
    alone.go("robot1", "F2-201")
    alone.run()
    (nearest,) = rode(alone)
    bench = BuildingBench(scene_of(two_lifts(callers[3 - int(nearest[-1])]), "office", 4))
    below = [name for name, base in bench.scene.robots.items() if base.z == 0.0]
    for robot in below:
        bench.go(robot, "F2-201" if robot == below[0] else "F2-202")
    bench.run()
    assert rode(bench) == {nearest}
    assert not bench.of(IssueDetected)
