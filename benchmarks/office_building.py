"""Deliveries between the offices of an office building, drawn at random.

A floor is a corridor with a door to an office every few metres on both sides and a lobby in the
middle; an elevator stops at every lobby. Robots live in the lobbies, items change robots there.
"""

from dataclasses import dataclass, replace
from random import Random

from mend.fleet.scheduling.delivery_document import (
    DeliveryDocument,
    GraphEntry,
    ItemEntry,
    PlaceEntry,
    RobotEntry,
    TransfersEntry,
    TravelEntry,
    VisitEntry,
    WayEntry,
    WeightsEntry,
)
from mend.maps.navigation import WayKind

OFFICE_DEPTH_M = 4.0
FLOOR_S = 8.0
TRANSFER_S = 15.0


@dataclass(frozen=True, slots=True)
class BuildingPlan:
    """How big a building is and what its robots may do.

    `shift_s` None: as long as it takes. `office_hours` of the offices are locked for a part of the
    time.
    """

    floors: int = 3
    offices: int = 12
    robots: int = 3
    items: int = 5
    capacity: float = 2.0
    shift_s: float | None = 420.0
    office_hours: int = 0
    office_spacing_m: float = 15.0
    wing_m: float | None = None
    """How far the offices' corridor is from the lobby; None: the lobby is in its middle."""
    boarding_s: float = 90.0
    """How long a ride with the elevator takes besides the floors that are passed."""
    between_floors: bool = False
    """Whether every item goes to another floor."""


BINDING = BuildingPlan(
    capacity=3.0,
    shift_s=520.0,
    office_spacing_m=5.0,
    wing_m=60.0,
    boarding_s=20.0,
    between_floors=True,
)
"""Offices at the ends of long corridors, every item for another floor, and shifts in which a robot
can bring what it has to one other floor, but not to all: it pays to give things to who lives there.
"""
LOOSE = replace(BINDING, capacity=100.0, shift_s=None)
"""The same where nothing binds: one robot can do everything, and transfers gain nothing."""


def building_deliveries(
    plan: BuildingPlan, chance: Random, name: str = "offices"
) -> DeliveryDocument:
    """Deliveries in a building; `problem_file.problem_of` makes a problem of them.

    Not every draw with a short shift can be solved.
    """
    places: dict[str, PlaceEntry] = {}
    ways: list[WayEntry] = []
    for floor in range(plan.floors):
        _add_floor(plan, floor, places, ways)
    offices = [place for place in places if place.startswith("office")]
    locked = set(chance.sample(offices, min(plan.office_hours, len(offices))))
    graph = GraphEntry(places=places, ways=tuple(_with_hours(way, locked, chance) for way in ways))
    lobbies = tuple(_lobby(floor) for floor in range(plan.floors))
    return DeliveryDocument(
        name=name,
        travel=TravelEntry(graph=graph),
        robots=tuple(
            RobotEntry(
                name=f"robot{number + 1}",
                start=lobbies[number % plan.floors],
                end=lobbies[number % plan.floors],
                capacity=plan.capacity,
                shift_s=(0.0, plan.shift_s),
            )
            for number in range(plan.robots)
        ),
        items=tuple(_item(plan, number, offices, chance) for number in range(plan.items)),
        transfers=TransfersEntry(places=lobbies, service_s=TRANSFER_S),
        weights=WeightsEntry(),
    )


def _floor(office: str) -> str:
    return office.split("_")[0]


def _lobby(floor: int) -> str:
    return f"lobby{floor}"


def _add_floor(
    plan: BuildingPlan, floor: int, places: dict[str, PlaceEntry], ways: list[WayEntry]
) -> None:
    lobby, doors = _lobby(floor), (plan.offices + 1) // 2
    if plan.wing_m is None:
        lobby_m, nearest = plan.office_spacing_m * (doors - 1) / 2, (doors - 1) // 2
    else:
        lobby_m, nearest = -plan.wing_m, 0
    places[lobby] = PlaceEntry(x=lobby_m, y=-OFFICE_DEPTH_M / 2, floor=floor)
    for door in range(doors):
        hall = f"hall{floor}_{door}"
        places[hall] = PlaceEntry(x=plan.office_spacing_m * door, y=0.0, floor=floor)
        if door:
            ways.append(WayEntry(between=(f"hall{floor}_{door - 1}", hall)))
        for side, y in (("a", OFFICE_DEPTH_M), ("b", -OFFICE_DEPTH_M)):
            if 2 * door + (side == "b") < plan.offices:
                office = f"office{floor}_{door}{side}"
                places[office] = PlaceEntry(x=plan.office_spacing_m * door, y=y, floor=floor)
                ways.append(WayEntry(between=(hall, office), kind=WayKind.DOOR))
    ways.append(WayEntry(between=(f"hall{floor}_{nearest}", lobby)))
    for below in range(floor):
        ride_s = plan.boarding_s + FLOOR_S * (floor - below)
        between = (_lobby(below), lobby)
        ways.append(WayEntry(between=between, kind=WayKind.ELEVATOR, length_m=0.0, delay_s=ride_s))


def _with_hours(way: WayEntry, locked: set[str], chance: Random) -> WayEntry:
    """The way, or where it is the door of a locked office: open only for some minutes."""
    if way.between[1] not in locked:
        return way
    opens_s = float(30 * chance.randrange(0, 6))
    lasts_s = float(30 * chance.randrange(6, 12))
    return way.model_copy(update={"open_s": ((opens_s, opens_s + lasts_s),)})


def _item(plan: BuildingPlan, number: int, offices: list[str], chance: Random) -> ItemEntry:
    origin, destination = chance.sample(offices, 2)
    while plan.between_floors and _floor(origin) == _floor(destination):
        origin, destination = chance.sample(offices, 2)
    return ItemEntry(
        name=f"item{number + 1}",
        pickup=VisitEntry(place=origin),
        delivery=VisitEntry(place=destination),
    )
