"""Where an elevator does not come, robots take another one, and say that it is dead."""

import json

import pytest
from building_bench import BuildingBench, made_up

from mend.maps.building.building import Building, BuildingDocument, Caller
from mend.robots.base.behaviors import other_elevator
from mend.robots.base.ways import Ride
from mend.robots.link.messages import (
    Avoid,
    ClosedWay,
    Finished,
    IssueDetected,
    Look,
    Looked,
    Resume,
    StepStarted,
    WayFound,
)
from mend.sim.building.elevator_bank import RobotElevators
from mend.sim.building.scene import scene_of

pytestmark = pytest.mark.slow(2)

STOPS = {name: [f"F1/{name}", f"F2/{name}"] for name in ("lift1", "lift2")}
SOON_S = 15.0


def two_lifts(caller: Caller) -> BuildingBench:
    document = made_up(floors=2, rooms=33, seed=5).document.model_dump(mode="json")
    for each in document["elevators"].values():
        each["called_by"] = caller
    building = Building(BuildingDocument.model_validate_json(json.dumps(document)))
    return BuildingBench(scene_of(building, "office", 1))


def kill(monkeypatch: pytest.MonkeyPatch, *dead: str) -> None:
    """These never open for anybody."""
    opens = RobotElevators.is_open_for

    def is_open_for(self: RobotElevators, ride: Ride) -> bool:
        return ride.elevator not in dead and opens(self, ride)

    monkeypatch.setattr(RobotElevators, "is_open_for", is_open_for)


def lift_gone_to(bench: BuildingBench) -> str:
    """Where it is going when it sets out."""
    bench.go("robot1", "F2-201")
    return bench.run_until(StepStarted).name.removeprefix("go to ")


def names_of(bench: BuildingBench) -> list[str]:
    return [each.name for each in bench.of(StepStarted)]


def test_one_that_does_not_come_is_left_for_another_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(other_elevator, "DEAD_S", SOON_S)
    bench = two_lifts(Caller.ROBOTS)
    first = lift_gone_to(bench)
    other = ({*STOPS} - {first}).pop()
    kill(monkeypatch, first)
    bench.run()
    assert bench.of(WayFound) == [WayFound(finding="elevator_dead", between=STOPS[first])]
    assert not bench.of(IssueDetected)
    assert bench.of(Finished)
    assert bench.world.robots[0].at.floor == "F2"
    assert names_of(bench) == [
        f"go to {first}",
        f"get into {first}",
        f"go to {other}",
        f"get into {other}",
        "ride to F2",
        "go to F2-201",
    ]


def test_who_waits_for_one_that_it_is_told_to_avoid_goes_to_the_other(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    bench = two_lifts(Caller.ROBOTS)
    first = lift_gone_to(bench)
    kill(monkeypatch, first)
    while names_of(bench)[-1] != f"get into {first}":
        assert bench.group.advance(0.1)
    bench.send("robot1", Avoid(ways=[ClosedWay(between=STOPS[first], until=1e6)]))
    bench.run()
    assert bench.world.robots[0].at.floor == "F2"
    assert "ride to F2" in names_of(bench)
    assert not bench.of(WayFound), "it was told so"


def test_one_for_which_nobody_comes_is_dead_once_it_has_asked_in_vain() -> None:
    bench = two_lifts(Caller.PEOPLE)
    first = lift_gone_to(bench)
    issue = bench.run_until(IssueDetected)
    assert issue.issue == "elevator_help"
    bench.run()
    bench.send("robot1", Look(expect="way_clear", within_s=other_elevator.GIVEN_UP_S))
    bench.run()
    assert bench.of(Looked)[-1].fulfilled is False
    assert not bench.of(WayFound)
    bench.go("robot1", "F2-201")
    assert bench.of(WayFound) == [WayFound(finding="elevator_dead", between=STOPS[first])]
    again = bench.run_until(IssueDetected)
    assert again.detection is not None
    assert first not in again.detection.explanation


def test_while_people_are_asked_another_one_leads_round(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(other_elevator, "DEAD_S", SOON_S)
    bench = two_lifts(Caller.PEOPLE)
    lift_gone_to(bench)
    issue = bench.run_until(IssueDetected)
    bench.run()
    bench.send("robot1", Look(expect="way_clear", within_s=60.0))
    bench.run()
    looked = bench.of(Looked)[-1]
    assert (looked.fulfilled, looked.led_round) == (True, True)
    bench.send("robot1", Resume(execution=issue.execution))
    again = bench.run_until(IssueDetected)
    assert [each.finding for each in bench.of(WayFound)] == ["elevator_dead"]
    assert again.detection != issue.detection
    bench.run()
    bench.send("robot1", Look(expect="way_clear", within_s=SOON_S + 10.0))
    bench.run()
    assert bench.of(Looked)[-1].fulfilled is False, "both are dead: it asks on"


def test_who_rode_one_that_was_closed_says_that_it_is_open() -> None:
    bench = two_lifts(Caller.ROBOTS)
    closed = [ClosedWay(between=each, until=1e6) for each in STOPS.values()]
    bench.send("robot1", Avoid(ways=closed))
    first = lift_gone_to(bench)
    bench.run()
    assert bench.of(Finished)
    assert bench.of(WayFound) == [WayFound(finding="open", between=STOPS[first])]
