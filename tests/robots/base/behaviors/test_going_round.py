"""A base takes another way where one is barred, and asks people only where none leads round."""

import json
import math

import pytest
from cart_bench import CartBench

from mend.maps.building.building import Building, BuildingDocument
from mend.robots.base.behaviors import going_round
from mend.robots.base.floor_ways import FloorWays
from mend.robots.link.messages import (
    Avoid,
    ClosedWay,
    Finished,
    Holding,
    Interrupt,
    IssueDetected,
    Location,
    Look,
    Looked,
    Resume,
    Start,
    WayFound,
)
from mend.tasks.frames import Frame

BETWEEN = ["F/begin", "F/end"]
END = Location(x=6.0, y=0.0, z=0.0)
OFF_M = 7.0
FOR_LONG_S = 1e9
SOON_S = 10.0
"""The way round takes some 18 s longer."""


def yard(*, ring: bool = True) -> CartBench:
    """A cart where a lane of 6 m begins; another way, if any, is longer by twice `OFF_M`."""
    places = {"begin": {"x": 0.0, "y": 0.0}, "end": {"x": 6.0, "y": 0.0}}
    lanes = [("begin", "end")]
    if ring:
        places |= {"near": {"x": 0.0, "y": OFF_M}, "off": {"x": 6.0, "y": OFF_M}}
        lanes += [("begin", "near"), ("near", "off"), ("off", "end")]
    floor = {"places": places, "lanes": [{"between": each} for each in lanes]}
    document = {"building": "yard", "floors": {"F": floor}}
    building = Building(BuildingDocument.model_validate_json(json.dumps(document)))
    return CartBench(ways=FloorWays(building, Frame(), 1.0, 0.3))


def corridor(middle_m: float) -> CartBench:
    """A cart where a lane begins that has a place so far off, and no way round."""
    places = {name: {"x": x, "y": 0.0} for name, x in (("begin", 0.0), ("end", 6.0))}
    places["middle"] = {"x": middle_m, "y": 0.0}
    lanes = [{"between": each} for each in (("begin", "middle"), ("middle", "end"))]
    floor = {"places": places, "lanes": lanes}
    document = {"building": "corridor", "floors": {"F": floor}}
    building = Building(BuildingDocument.model_validate_json(json.dumps(document)))
    return CartBench(ways=FloorWays(building, Frame(), 1.0, 0.3))


def go(bench: CartBench, to: Location = END, execution: str = "e1") -> None:
    parameters = {"place": "far"}
    bench.send(
        Start(execution=execution, node="/0", behavior="go_to", parameters=parameters, target=to)
    )


def bar(bench: CartBench) -> None:
    """Visitors stand side by side across the lane, from the wall to beyond the lamp post."""
    bench.world.visitors = [(-1.0, 0.5 * each, 0.25) for each in range(-12, 5)]


def is_at(bench: CartBench, to: Location) -> bool:
    here = bench.cart.pose()
    return math.hypot(here.x - to.x, here.y - to.y) < 0.1


def test_it_takes_the_way_round_and_asks_nobody() -> None:
    bench = yard()
    bar(bench)
    go(bench)
    bench.run()
    assert bench.of(WayFound) == [WayFound(finding="blocked", between=BETWEEN)]
    assert not bench.of(IssueDetected)
    assert bench.of(Finished)
    assert is_at(bench, END)


def test_where_no_other_way_leads_it_asks() -> None:
    bench = yard(ring=False)
    bar(bench)
    go(bench)
    issue = bench.run_until(IssueDetected)
    assert issue.issue == "blocked"
    assert issue.detection is not None
    assert issue.detection.between == BETWEEN
    assert not bench.of(WayFound)


@pytest.mark.parametrize("middle_m", [2.0, 2.4, 2.6, 2.8, 2.9, 3.0, 3.2, 3.5])
def test_what_stands_about_where_lanes_meet_is_no_more_passed_than_elsewhere(
    middle_m: float,
) -> None:
    bench = corridor(middle_m)
    bar(bench)
    go(bench)
    assert bench.run_until(IssueDetected).issue == "blocked"
    assert not bench.of(WayFound)


def test_what_is_closed_is_kept_off_from_the_beginning_until_then() -> None:
    bench = yard()
    bench.send(Avoid(ways=[ClosedWay(between=BETWEEN, until=FOR_LONG_S)]))
    go(bench)
    farthest_m = 0.0
    while bench.robot.advance(0.1):
        farthest_m = max(farthest_m, bench.cart.pose().y)
    assert farthest_m == pytest.approx(OFF_M, abs=0.5)
    assert is_at(bench, END)
    back = Location(x=0.0, y=0.0, z=0.0)
    bench.send(Avoid())
    go(bench, back, "e2")
    while bench.robot.advance(0.1):
        assert bench.cart.pose().y < 0.5
    assert is_at(bench, back)


def test_a_long_way_round_is_taken_once_it_has_stood_as_long(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(going_round, "ASKS_BEYOND_S", SOON_S)
    bench = yard()
    bar(bench)
    go(bench)
    issue = bench.run_until(IssueDetected)
    assert issue.issue == "blocked"
    bench.run()
    assert bench.of(Holding)
    stood_since_s = bench.robot.time_s()
    bench.send(Look(expect="way_clear", within_s=3.0))
    bench.run()
    assert bench.of(Looked)[-1].fulfilled is False
    bench.send(Look(expect="way_clear", within_s=200.0))
    bench.run()
    looked = bench.of(Looked)[-1]
    assert (looked.fulfilled, looked.led_round) == (True, True)
    stood_s = bench.robot.time_s() - stood_since_s
    assert SOON_S < stood_s + 5.0 < 30.0
    bench.send(Resume(execution="e1"))
    bench.run()
    assert is_at(bench, END)
    assert len(bench.of(IssueDetected)) == 1


def test_what_it_sees_free_it_takes_and_only_once_passed_it_is_open(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(going_round, "ASKS_BEYOND_S", SOON_S)
    bench = yard()
    bar(bench)
    go(bench)
    bench.run_until(IssueDetected)
    bench.run()
    bench.send(Avoid(ways=[ClosedWay(between=BETWEEN, until=FOR_LONG_S)]))
    bench.world.visitors = []
    bench.send(Look(expect="way_clear", within_s=5.0))
    bench.run()
    looked = bench.of(Looked)[-1]
    assert (looked.fulfilled, looked.led_round) == (True, False)
    assert not bench.of(WayFound)
    bench.send(Resume(execution="e1"))
    while bench.robot.advance(0.1):
        assert bench.cart.pose().y < 0.5
    assert bench.of(WayFound) == [WayFound(finding="open", between=BETWEEN)]


def test_who_goes_round_does_not_say_that_it_is_open() -> None:
    bench = yard()
    bench.send(Avoid(ways=[ClosedWay(between=BETWEEN, until=FOR_LONG_S)]))
    go(bench)
    bench.run()
    assert is_at(bench, END)
    assert not bench.of(WayFound)


def test_another_way_that_opens_while_it_stands_is_taken() -> None:
    bench = yard()
    bench.send(Avoid(ways=[ClosedWay(between=["F/off", "F/near"], until=FOR_LONG_S)]))
    bar(bench)
    go(bench)
    assert bench.run_until(IssueDetected).issue == "blocked"
    bench.run()
    bench.send(Look(expect="way_clear", within_s=30.0))
    bench.run_for(3.0)
    bench.send(Avoid(ways=[ClosedWay(between=BETWEEN, until=FOR_LONG_S)]))
    bench.run()
    looked = bench.of(Looked)[-1]
    assert (looked.fulfilled, looked.led_round) == (True, True)


def test_before_it_asks_others_have_time_to_go_instead() -> None:
    bench = yard(ring=False)
    bench.send(Avoid(asks_after_s=4.0))
    bar(bench)
    go(bench)
    found = bench.run_until(WayFound)
    assert found == WayFound(finding="blocked", between=BETWEEN)
    since_s = bench.robot.time_s()
    bench.run_until(IssueDetected)
    assert 4.0 <= bench.robot.time_s() - since_s < 5.0
    assert len(bench.of(WayFound)) == 1


def test_who_is_told_to_stop_meanwhile_asks_nobody() -> None:
    bench = yard(ring=False)
    bench.send(Avoid(asks_after_s=4.0))
    bar(bench)
    go(bench)
    bench.run_until(WayFound)
    bench.send(Interrupt(retreat=True))
    bench.run()
    assert not bench.of(IssueDetected)


def test_others_are_told_of_it_once_however_often_it_asks() -> None:
    bench = yard(ring=False)
    bench.send(Avoid(asks_after_s=4.0))
    bar(bench)
    go(bench)
    for asked in (1, 2):
        bench.run_until(IssueDetected)
        bench.run()
        bench.send(Resume(execution="e1"))
        assert len(bench.of(IssueDetected)) == asked
    assert len(bench.of(WayFound)) == 1
