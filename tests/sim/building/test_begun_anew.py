"""Robots of a world that has begun anew, and have lost what they were doing, see what is so."""

import json

from building_bench import BuildingBench, made_up

from mend.maps.building.building import Building, BuildingDocument, Caller
from mend.robots.link.messages import IssueDetected, Look, Looked, Resume
from mend.sim.building.scene import scene_of
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scene import Scene

ROBOT = "robot1"
HELP = Intervention(act=Act.RELEASE)


def begun_anew(bench: BuildingBench) -> BuildingBench:
    return BuildingBench(bench.scene, snapshot=json.loads(json.dumps(bench.group.snapshot())))


def sees_way(bench: BuildingBench, place: str, within_s: float) -> bool:
    bench.send(ROBOT, Look(expect="way_clear", place=place, within_s=within_s))
    bench.run()
    return bool(bench.of(Looked)[-1].fulfilled)


def test_a_door_that_is_still_shut_is_seen_shut_until_somebody_opens_it() -> None:
    bench = BuildingBench(shut_doors=1.0)
    shut = next(n for n, each in bench.world.doors.items() if each.plan.opens.value == "people")
    room = shut.replace("/", "-")
    bench.go(ROBOT, room)
    assert bench.run_until(IssueDetected).issue == "door_closed"
    bench.run()
    again = begun_anew(bench)
    assert not sees_way(again, room, 3.0)
    assert again.world.intervene(HELP) == ""
    assert sees_way(again, room, 5.0)


def called_by_people(floors: int) -> Scene:
    document = made_up(floors=floors).document.model_dump(mode="json")
    for each in document["elevators"].values():
        each["called_by"] = Caller.PEOPLE
    building = Building(BuildingDocument.model_validate_json(json.dumps(document)))
    return scene_of(building, "office", 1)


def test_an_elevator_that_has_not_come_is_not_seen_until_somebody_calls_it() -> None:
    bench = BuildingBench(called_by_people(2))
    bench.go(ROBOT, "F2-201")
    assert bench.run_until(IssueDetected).issue == "elevator_help"
    bench.run()
    again = begun_anew(bench)
    assert not sees_way(again, "F2-201", 3.0)
    assert again.world.intervene(HELP) == ""
    assert sees_way(again, "F2-201", 60.0)


def test_a_wrong_floor_is_none_to_get_out_at_until_somebody_presses_another_button() -> None:
    bench = BuildingBench(called_by_people(3), wrong_floors=1.0)
    bench.go(ROBOT, "F2-201")
    issue = bench.run_until(IssueDetected)
    bench.run()
    assert bench.world.intervene(HELP) == ""
    assert sees_way(bench, "F2-201", 60.0)
    bench.send(ROBOT, Resume(execution=issue.execution))
    assert bench.run_until(IssueDetected).issue == "wrong_floor"
    bench.run()
    again = begun_anew(bench)
    assert not sees_way(again, "F2-201", 3.0)
    assert again.world.intervene(HELP) == ""
    assert sees_way(again, "F2-201", 60.0)
    again.go(ROBOT, "F2-201")
    again.run()
    assert again.world.robots[0].at.floor == "F2"


def who_waits(seed: int) -> BuildingBench:
    bench = BuildingBench(seed=seed)
    bench.go(ROBOT, "F1-101", "meet_person", person="Ms Lee")
    bench.run()
    return bench


def test_who_comes_late_is_seen_though_the_robot_has_begun_anew() -> None:
    bench = next(bench for bench in map(who_waits, range(20)) if bench.of(IssueDetected))
    assert bench.of(IssueDetected)[0].issue == "person_not_there"
    again = begun_anew(bench)
    for within_s, comes in ((0.0, False), (120.0, True)):
        again.send(ROBOT, Look(expect="accompanied", within_s=within_s))
        again.run()
        assert again.of(Looked)[-1].fulfilled is comes
