"""Deliveries between the offices of an office building, drawn at random.

A floor is a corridor with a door to an office every few metres on both sides and a lobby in the
middle; an elevator stops at every lobby. Robots live in the lobbies, items change robots there.
"""

from dataclasses import dataclass
from random import Random

from fleet.scheduling.delivery_document import (
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
from maps.navigation import WayKind

OFFICE_SPACING_M = 15.0
OFFICE_DEPTH_M = 4.0
BOARDING_S = 90.0
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


LOOSE = BuildingPlan(capacity=100.0, shift_s=None)
"""Nothing binds: one robot can do everything, and transfers gain nothing."""
BINDING = BuildingPlan()
"""Shifts and capacities that make robots share the work."""


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
        items=tuple(_item(number, offices, chance) for number in range(plan.items)),
        transfers=TransfersEntry(places=lobbies, service_s=TRANSFER_S),
        weights=WeightsEntry(),
    )


def _lobby(floor: int) -> str:
    return f"lobby{floor}"


def _add_floor(
    plan: BuildingPlan, floor: int, places: dict[str, PlaceEntry], ways: list[WayEntry]
) -> None:
    lobby, doors = _lobby(floor), (plan.offices + 1) // 2
    middle_m = OFFICE_SPACING_M * (doors - 1) / 2
    places[lobby] = PlaceEntry(x=middle_m, y=-OFFICE_DEPTH_M / 2, floor=floor)
    for door in range(doors):
        hall = f"hall{floor}_{door}"
        places[hall] = PlaceEntry(x=OFFICE_SPACING_M * door, y=0.0, floor=floor)
        if door:
            ways.append(WayEntry(between=(f"hall{floor}_{door - 1}", hall)))
        for side, y in (("a", OFFICE_DEPTH_M), ("b", -OFFICE_DEPTH_M)):
            if 2 * door + (side == "b") < plan.offices:
                office = f"office{floor}_{door}{side}"
                places[office] = PlaceEntry(x=OFFICE_SPACING_M * door, y=y, floor=floor)
                ways.append(WayEntry(between=(hall, office), kind=WayKind.DOOR))
    ways.append(WayEntry(between=(f"hall{floor}_{(doors - 1) // 2}", lobby)))
    for below in range(floor):
        ride_s = BOARDING_S + FLOOR_S * (floor - below)
        between = (_lobby(below), lobby)
        ways.append(WayEntry(between=between, kind=WayKind.ELEVATOR, length_m=0.0, delay_s=ride_s))


def _with_hours(way: WayEntry, locked: set[str], chance: Random) -> WayEntry:
    """The way, or where it is the door of a locked office: open only for some minutes."""
    if way.between[1] not in locked:
        return way
    opens_s = float(30 * chance.randrange(0, 6))
    lasts_s = float(30 * chance.randrange(6, 12))
    return way.model_copy(update={"open_s": ((opens_s, opens_s + lasts_s),)})


def _item(number: int, offices: list[str], chance: Random) -> ItemEntry:
    origin, destination = chance.sample(offices, 2)
    return ItemEntry(
        name=f"item{number + 1}",
        pickup=VisitEntry(place=origin),
        delivery=VisitEntry(place=destination),
    )
