"""A way round a locked door leads through another door, or through none."""

from math import inf

from mend.fleet.shifts.ways import DeliveryWays
from mend.maps.building.building import (
    Building,
    BuildingDocument,
    Door,
    Floor,
    FloorPlace,
    Lane,
    PlaceKind,
)


def ways(*, back_door: bool) -> DeliveryWays:
    """Two lanes lead from a hall through one door into a room; another door may be behind it."""
    places = {"left": (0.0, 0.0), "right": (1.0, 0.0), "room": (0.5, 3.0), "yard": (3.0, 6.0)}
    lanes = [("left", "right"), ("left", "room"), ("right", "room"), ("right", "yard")]
    doors = {"front": Door(posts=((0.0, 1.5), (1.0, 1.5)))}
    if back_door:
        lanes.append(("yard", "room"))
        doors["back"] = Door(posts=((1.75, 4.0), (1.75, 5.0)))
    floor = Floor(
        places={name: FloorPlace(x=x, y=y, kind=PlaceKind.ROOM) for name, (x, y) in places.items()},
        lanes=tuple(Lane(between=each) for each in lanes),
        doors=doors,
    )
    return DeliveryWays(Building(BuildingDocument(building="shed", floors={"F": floor})))


def test_another_lane_through_the_same_door_leads_round_nothing() -> None:
    (door,) = ways(back_door=False).hindrances("F/left", "F/room")
    assert (door.is_door, door.longer_s) == (True, inf)


def test_another_door_does() -> None:
    (door,) = ways(back_door=True).hindrances("F/left", "F/room")
    assert 5.0 < door.longer_s < inf


def test_what_stands_right_across_a_hall_bars_all_lanes_there() -> None:
    corners = {"a": (0.0, 0.0), "b": (4.0, 0.0), "c": (0.0, 2.0), "d": (4.0, 2.0)}
    sides = [(-1.0, -1.0, 5.0, -1.0), (-1.0, 3.0, 5.0, 3.0)]
    lanes = [("a", "b"), ("c", "d"), ("a", "c"), ("b", "d")]
    floor = Floor(
        places={name: FloorPlace(x=x, y=y) for name, (x, y) in corners.items()},
        lanes=tuple(Lane(between=each) for each in lanes),
        walls=tuple(sides),
    )
    hall = DeliveryWays(Building(BuildingDocument(building="hall", floors={"F": floor})))
    (across,) = hall.hindrances("F/a", "F/b")
    assert (across.is_door, across.longer_s) == (False, inf)
