"""What of an imported plan robots can use: doorways where doors are, and what is connected."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from mend.errors import WrongInputError
from mend.maps.building.building import Building, BuildingDocument, Floor, Lane
from mend.maps.building.connection import usable
from mend.maps.building.naming import with_plain_door_names

Matrix = NDArray[np.float64]
Wall = tuple[float, float, float, float]

DOORWAY_M = 1.0
"""So wide is the doorway that is cut into a wall which a plan draws across a door."""

_DECIMALS = 3
_MOST_NAMED = 5


@dataclass(slots=True)
class Imported:
    """A building, and a sentence for whatever of its plan is otherwise in it, or not at all."""

    document: BuildingDocument
    notes: list[str] = field(default_factory=list)


def tidied(imported: Imported) -> Imported:
    """Without lanes that lead through walls, and without what robots cannot get to and back from.

    A plan may draw shut doors as walls: they are opened there. Doors get names of their own. Raises
    `WrongInputError` for a plan without lanes.
    """
    if not any(floor.lanes for floor in imported.document.floors.values()):
        raise WrongInputError("no lanes are in the plan: robots would have nowhere to drive")
    notes = [*imported.notes]
    opened = _with_doorways(Building(_each_once(_without_points(imported.document, notes), notes)))
    clear = _without_lanes_through_walls(Building(opened), notes)
    usable = _connected_part(Building(clear), notes)
    return Imported(with_plain_door_names(usable, notes), notes)


def _without_points(document: BuildingDocument, notes: list[str]) -> BuildingDocument:
    """Without lanes, doors and walls that begin and end in one place."""
    floors = {}
    for name, floor in document.floors.items():
        points = [each for each in floor.lanes if each.between[0] == each.between[1]]
        shut = [door for door, each in floor.doors.items() if each.posts[0] == each.posts[1]]
        if points:
            ends = [f"{each.between[0]} to itself" for each in points]
            notes.append(f"floor '{name}': {_counted(ends, 'lane')} left out")
        if shut:
            notes.append(f"floor '{name}': {_counted(shut, 'door')} without width, and left out")
        lanes = tuple(each for each in floor.lanes if each not in points)
        doors = {door: each for door, each in floor.doors.items() if door not in shut}
        walls = tuple(each for each in floor.walls if each[:2] != each[2:])
        floors[name] = floor.model_copy(update={"lanes": lanes, "doors": doors, "walls": walls})
    return document.model_copy(update={"floors": floors})


def _each_once(document: BuildingDocument, notes: list[str]) -> BuildingDocument:
    """Without lanes that lead no other way than another one, and doors where another one is.

    A plan may have the same lane in several graphs: nobody needs to hear of that.
    """
    floors = {}
    for name, floor in document.floors.items():
        twice = floor.lanes_twice()
        lanes = tuple(each for number, each in enumerate(floor.lanes) if number not in twice)
        first: dict[frozenset[tuple[float, float]], str] = {}
        for door, each in floor.doors.items():
            first.setdefault(frozenset(each.posts), door)
        doors = {door: floor.doors[door] for door in first.values()}
        if behind := [door for door in floor.doors if door not in doors]:
            notes.append(f"floor '{name}': {_counted(behind, 'door')} where another one is")
        floors[name] = floor.model_copy(update={"lanes": lanes, "doors": doors})
    return document.model_copy(update={"floors": floors})


def _with_doorways(building: Building) -> BuildingDocument:
    floors = {}
    for name, floor in building.floors.items():
        walls: list[Wall | None] = list(floor.walls)
        parts: list[Wall] = []
        for each in building.crossings:
            if each.floor != name or not each.doors:
                continue
            for number in each.walls.tolist():
                if (wall := walls[number]) is not None:
                    parts += _cut(wall, _way(floor, each.lane))
                    walls[number] = None
        kept = (*(wall for wall in walls if wall is not None), *parts)
        floors[name] = floor.model_copy(update={"walls": kept})
    return building.document.model_copy(update={"floors": floors})


def _way(floor: Floor, lane: Lane) -> Matrix:
    a, b = (floor.places[each] for each in lane.between)
    return np.array([[a.x, a.y], [b.x, b.y]])


def _cut(wall: Wall, way: Matrix) -> list[Wall]:
    """What is left of a wall beside a doorway where a way crosses it."""
    start, end = np.array(wall[:2]), np.array(wall[2:])
    along, ahead = end - start, way[1] - way[0]
    length_m = float(np.hypot(*along))
    to = way[0] - start
    share = (to[0] * ahead[1] - to[1] * ahead[0]) / (along[0] * ahead[1] - along[1] * ahead[0])
    half = DOORWAY_M / 2 / length_m
    ends = [(0.0, share - half), (share + half, 1.0)]
    return [
        tuple((np.concatenate([start + a * along, start + b * along]).round(_DECIMALS)).tolist())
        for a, b in ends
        if b > a
    ]


def _without_lanes_through_walls(building: Building, notes: list[str]) -> BuildingDocument:
    floors = {}
    for name, floor in building.floors.items():
        through = [
            each.lane for each in building.crossings if each.floor == name and len(each.walls)
        ]
        if through:
            ends = [f"{each.between[0]} to {each.between[1]}" for each in through]
            notes.append(f"floor '{name}': {_counted(ends, 'lane')} through walls, and left out")
        lanes = tuple(each for each in floor.lanes if each not in through)
        floors[name] = floor.model_copy(update={"lanes": lanes})
    return building.document.model_copy(update={"floors": floors})


def _connected_part(building: Building, notes: list[str]) -> BuildingDocument:
    graph = building.graph
    kept = {place.name for place, so in zip(graph.places, usable(graph), strict=True) if so}
    floors = {}
    for name, floor in building.floors.items():
        places = {key: each for key, each in floor.places.items() if f"{name}/{key}" in kept}
        if lost := [key for key in floor.places if key not in places]:
            notes.append(
                f"floor '{name}': {_counted(lost, 'place')} cut off from the rest, and left out"
            )
        if places:
            lanes = tuple(each for each in floor.lanes if set(each.between) <= places.keys())
            floors[name] = floor.model_copy(update={"places": places, "lanes": lanes})
    elevators = {}
    for name, each in building.document.elevators.items():
        stops = {floor: at for floor, at in each.stops.items() if f"{floor}/{at}" in kept}
        if len(stops) > 1:
            elevators[name] = each.model_copy(update={"stops": stops})
        else:
            notes.append(f"the elevator '{name}' leads nowhere, and is left out")
    return building.document.model_copy(update={"floors": floors, "elevators": elevators})


def _counted(names: Sequence[str], what: str) -> str:
    """How many there are, and what some of them are called."""
    shown = ", ".join(names[:_MOST_NAMED]) + (", ..." if len(names) > _MOST_NAMED else "")
    many = len(names) != 1
    return f"{len(names)} {what}{'s' if many else ''} ({shown}) {'are' if many else 'is'}"
