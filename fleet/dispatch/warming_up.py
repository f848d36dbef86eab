"""Compiles what plans are made with, before anybody waits for one."""

from mend.fleet.dispatch.dispatcher import Dispatcher
from mend.fleet.dispatch.setting import FleetSetting, ServiceRobot
from mend.fleet.requests import GoToRoom, Transport
from mend.maps.building.building import Building, BuildingDocument, Floor, FloorPlace, Lane


def warm_up() -> None:
    """Have a fleet of two plan some requests in a building of three places."""
    places = {name: FloorPlace(x=float(x), y=0.0) for x, name in enumerate("abc")}
    lanes = (Lane(between=("a", "b")), Lane(between=("b", "c")))
    floor = Floor(places=places, lanes=lanes)
    building = Building(BuildingDocument(building="small", floors={"F1": floor}))
    robots = tuple(ServiceRobot(name=f"robot{n}", start="a") for n in (1, 2))
    dispatcher = Dispatcher(building, FleetSetting(robots=robots, transfer_places=("b",)))
    for number in range(3):
        there = GoToRoom(name=f"go{number}", place="c")
        bring = Transport(name=f"bring{number}", what="it", origin="a", destination="c")
        dispatcher.submit(there, 0.0)
        dispatcher.submit(bring, 0.0)
    dispatcher.cancel("bring0", 1.0)
    for leg in dispatcher.legs_to_begin(2.0):
        dispatcher.began(leg, 2.0)
