"""A corridor of rooms 10 m apart on one floor for tests of a dispatcher; robots drive 1 m/s."""

from itertools import pairwise
from typing import Any

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import Leg, LegEnd, LegOutcome
from mend.fleet.dispatch.setting import FleetSetting, Policy, ServiceRobot
from mend.fleet.requests import request_of
from mend.maps.building.building import Building, BuildingDocument, Floor, FloorPlace, Lane

ROOMS = ("a", "b", "c", "d", "e")


def office() -> Building:
    """The rooms a to e in a row."""
    places = {name: FloorPlace(x=10.0 * number, y=0.0) for number, name in enumerate(ROOMS)}
    lanes = tuple(Lane(between=each) for each in pairwise(ROOMS))
    floor = Floor(places=places, lanes=lanes)
    return Building(BuildingDocument(building="office", floors={"f": floor}))


def fleet_of(*starts: str, **fields: Any) -> FleetSetting:
    """Robots `r0`, `r1`, ... that carry 2; everything by hand takes 5 s."""
    robots = tuple(
        ServiceRobot(name=f"r{number}", start=start, capacity=2.0)
        for number, start in enumerate(starts)
    )
    policy = fields.pop("policy", Policy())
    return FleetSetting(
        robots=robots, speed_m_s=1.0, starts_s=0.0, handling_s=5.0, policy=policy, **fields
    )


def dispatcher_for(*starts: str, **fields: Any) -> Dispatcher:
    """A dispatcher of such robots in the office."""
    return Dispatcher(office(), fleet_of(*starts, **fields))


def asked(name: str = "tea", origin: str = "b", destination: str = "d", **fields: Any) -> Any:
    """A transport."""
    ways = {"origin": origin, "destination": destination}
    return request_of({"kind": "transport", "name": name, "what": "tea", **ways, **fields})


def visit(name: str = "visit", place: str = "c", **fields: Any) -> Any:
    """A robot is wanted at a place."""
    return request_of({"kind": "go_to_room", "name": name, "place": place, **fields})


def only_leg(dispatcher: Dispatcher, now_s: float) -> Leg:
    """The one leg that is to begin now, begun."""
    (leg,) = dispatcher.legs_to_begin(now_s)
    dispatcher.began(leg, now_s)
    return leg


DONE = LegEnd(outcome=LegOutcome.DONE)
NOBODY = LegEnd(outcome=LegOutcome.FAILED, reason="nobody came")
GONE = LegEnd(outcome=LegOutcome.ITEM_LOST, reason="the basket is empty")


def make_leg(dispatcher: Dispatcher, now_s: float, after_s: float, end: LegEnd = DONE) -> Leg:
    """Begin the one leg that is to begin now, and end it later."""
    leg = only_leg(dispatcher, now_s)
    dispatcher.ended(leg, end, now_s + after_s)
    return leg
