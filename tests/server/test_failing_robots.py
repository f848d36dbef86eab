"""Which robot fails in a shift, where the request file names none."""

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.leg import LegEnd, LegOutcome
from mend.fleet.dispatch.setting import FleetSetting, ServiceRobot
from mend.fleet.requests import Transport
from mend.maps.building.building import Building, PlaceKind
from mend.maps.building.random_building import random_building
from mend.server.cli.failing_robot import who_brings

OFFICE = Building(random_building(1, 1, 30))
ROOMS = OFFICE.of_kind(PlaceKind.ROOM)
DONE = LegEnd(outcome=LegOutcome.DONE)


def fleet() -> Dispatcher:
    starts = (OFFICE.of_kind(PlaceKind.CHARGER)[0], ROOMS[-1])
    robots = tuple(
        ServiceRobot(name=f"r{n}", start=at, capacity=3.0) for n, at in enumerate(starts)
    )
    return Dispatcher(OFFICE, FleetSetting(robots=robots))


def bring(dispatcher: Dispatcher, origin: str, destination: str) -> str:
    """Have something collected and set out with it; the robot that does."""
    mail = Transport(name="mail", what="the mail", origin=origin, destination=destination)
    dispatcher.submit(mail, 0.0)
    (leg,) = dispatcher.legs_to_begin(0.0)
    dispatcher.began(leg, 0.0)
    assert who_brings(dispatcher) is None, "it has nothing yet"
    dispatcher.arrived(leg, leg.begins_s)
    dispatcher.ended(leg, DONE, leg.done_s)
    (leg,) = dispatcher.legs_to_begin(leg.done_s)
    dispatcher.began(leg, dispatcher.now_s)
    return leg.robot


def test_it_is_one_that_is_on_its_way_with_something() -> None:
    dispatcher = fleet()
    assert who_brings(dispatcher) is None
    robot = bring(dispatcher, ROOMS[0], ROOMS[-2])
    assert robot == who_brings(dispatcher)
    assert who_brings(dispatcher, out={robot}) is None, "it has failed already"


def test_it_is_none_that_is_there_soon() -> None:
    dispatcher = fleet()
    near = min(ROOMS[1:], key=lambda each: _away_m(ROOMS[0], each))
    bring(dispatcher, ROOMS[0], near)
    assert who_brings(dispatcher) is None


def _away_m(a: str, b: str) -> float:
    graph = OFFICE.graph
    return float(graph.shortest(1.0)[0][graph.index(a), graph.index(b)])
