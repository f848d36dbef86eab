"""A scene of a building: what tasks may name in it, and where robots begin."""

import math
import re

from mend.errors import WrongInputError
from mend.maps.building.building import Building, FloorPlace, PlaceKind
from mend.maps.building.cabin import waiting_points
from mend.maps.building.naming import LONGEST, unlike
from mend.sim.building.building_robot import RADIUS_M
from mend.tasks.plain_letters import plain_letters
from mend.tasks.scene import Base, Place, Pose, Scene

SPARE_M = 0.05
"""A robot is so much farther from walls than its rim at least."""
NEEDS_M = RADIUS_M + SPARE_M
APART_M = 1.0
"""Robots begin so far from each other."""
_ODD = re.compile(r"[^A-Za-z0-9_-]+")
_BEGINS = (PlaceKind.CHARGER, PlaceKind.PARKING, PlaceKind.WAYPOINT, PlaceKind.ROOM)
"""Where robots begin on a floor, the first kind first: two hardly meet in a room's door."""


def scene_of(building: Building, name: str, robots: int) -> Scene:
    """A scene with all places that are not on the way only, and so many robots.

    A place is called after its floor and itself, as `F1-101`, and where two would be called alike
    the second has a number. That of an elevator is where one waits for it. Raises
    `WrongInputError` where there is no room for all robots.
    """
    named = [
        full
        for kind in PlaceKind
        if kind is not PlaceKind.WAYPOINT
        for full in building.of_kind(kind)
    ]
    places: dict[str, Place] = {}
    for full in named:
        if (pose := where_to_stand(building, full)) is not None:
            places[unlike(scene_name(full), places)] = Place(pose=pose)
    begins = _begins(building, robots)
    return Scene(
        name=name,
        objects={},
        places=places,
        robots={f"robot{number}": base for number, base in enumerate(begins, 1)},
        setting=building.document.model_dump(mode="json", exclude_defaults=True),
    )


def scene_name(full: str) -> str:
    """What a place, `FLOOR/PLACE`, is called in scenes, whose names are plainer.

    Robots say these names: of a letter with a mark the letter stays, as in `Buro`.
    """
    name = _ODD.sub("_", plain_letters(full).replace("/", "-"))
    return (name if name[0].isalpha() else f"L{name}")[:LONGEST]


def _begins(building: Building, robots: int) -> list[Base]:
    """One on each floor first, at a charger if it has one; then a second on each, and so on."""
    begins: list[Base] = []
    for full in _by_turns([each for kind in _BEGINS for each in building.of_kind(kind)]):
        pose = _pose(building, full)
        base = Base(x=pose.x, y=pose.y, z=pose.z or 0.0)
        if len(begins) < robots and all(_far(base, each) for each in begins):
            begins.append(base)
    if len(begins) < robots:
        raise WrongInputError(
            f"'{building.name}' has room for {len(begins)} robots at its places, not {robots}"
        )
    return begins


def _by_turns(places: list[str]) -> list[str]:
    """The first of each floor, then the second of each, and so on."""
    floors: dict[str, list[str]] = {}
    for each in places:
        floors.setdefault(each.split("/", 1)[0], []).append(each)
    longest = max((len(each) for each in floors.values()), default=0)
    return [each[turn] for turn in range(longest) for each in floors.values() if turn < len(each)]


def _far(a: Base, b: Base) -> bool:
    return a.z != b.z or math.hypot(a.x - b.x, a.y - b.y) >= APART_M


def where_to_stand(building: Building, full: str) -> Pose | None:
    """A place, or where one waits for the elevator that stops there; None without room for it."""
    pose, (floor, name) = _pose(building, full), full.split("/", 1)
    if not any(each.stops.get(floor) == name for each in building.document.elevators.values()):
        return pose
    waits = waiting_points(building.floors[floor], (pose.x, pose.y), NEEDS_M)
    return Pose(x=waits[0][0], y=waits[0][1], z=pose.z) if waits else None


def _pose(building: Building, full: str) -> Pose:
    floor, name = full.split("/", 1)
    place: FloorPlace = building.floors[floor].places[name]
    return Pose(x=place.x, y=place.y, z=building.floors[floor].height)
