"""A dead elevator is closed as a whole, where another one leads there."""

import pytest
from dispatch_office import fleet_of
from pydantic import ValidationError

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import Finding, Found
from mend.fleet.requests import GoToRoom
from mend.maps.building.building import Building
from mend.maps.building.random_building import random_building
from mend.server.fleets.operator_requests import WayReport
from mend.server.fleets.robot_findings import is_led_round

DEAD = ("F1/lift1", "F2/lift1")
ALL_RIDES = {
    frozenset((f"F{a}/lift1", f"F{b}/lift1")) for a in range(1, 4) for b in range(1, 4) if a != b
}


@pytest.fixture(scope="module")
def building() -> Building:
    return Building(random_building(1, 3, 33))


def test_all_its_rides_are_closed_and_opened_together(building: Building) -> None:
    dispatcher = Dispatcher(building, fleet_of("F1/101"))
    dispatcher.submit(GoToRoom(name="up", place="F3/301"), 0.0)
    dispatcher.found(Found(finding=Finding.ELEVATOR_DEAD, between=DEAD, by="r0"), 0.0)
    assert dispatcher.closed_until_s().keys() == ALL_RIDES
    assert dispatcher.expected("up") is not None, "the other one rides there"
    again = Dispatcher.restored(building, fleet_of("F1/101"), dispatcher.snapshot())
    assert again.closed_until_s() == dispatcher.closed_until_s()
    back = ("F3/lift1", "F1/lift1")
    dispatcher.found(Found(finding=Finding.OPEN, between=back, by="r0"), 10.0)
    assert not dispatcher.closed_until_s()


def test_it_is_led_round_as_long_as_another_one_rides_there(building: Building) -> None:
    found = Found(finding=Finding.ELEVATOR_DEAD, between=DEAD)
    assert is_led_round(building.graph, (), found, "F3/301")
    others = building.graph.together(("F1/lift2", "F2/lift2"))
    assert not is_led_round(building.graph, others, found, "F3/301")


@pytest.mark.parametrize(
    ("finding", "more", "why"),
    [
        ("blocked", {}, "expected either the two places"),
        ("open", {"between": ["a", "b"], "elevator": "lift1"}, "expected either the two places"),
        ("blocked", {"elevator": "lift1"}, "an elevator is 'elevator_dead' or 'open'"),
    ],
)
def test_it_is_either_a_way_or_an_elevator(finding: str, more: dict[str, object], why: str) -> None:
    with pytest.raises(ValidationError, match=why):
        WayReport.model_validate({"finding": finding, **more})
