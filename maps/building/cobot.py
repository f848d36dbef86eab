"""Buildings as the CoBot navigation graphs have them, a file and perhaps a vector map a floor.

Nodes have numbers and places, edges say whether a door or an elevator is on them. Which elevators
of two floors are one, how floors lie above each other, and which nodes are more than on the way,
the files do not say: where a way ends robots are to go.
"""

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel, ConfigDict

from mend.documents.problem import list_names
from mend.documents.validation import refusing
from mend.errors import WrongInputError
from mend.maps.building.building import (
    BuildingDocument,
    Door,
    DoorOpening,
    Elevator,
    Floor,
    FloorPlace,
    Lane,
    PlaceKind,
)
from mend.maps.building.tidying import Imported, tidied
from mend.maps.vector_map import VectorMap

_DECIMALS = 3
DOOR_M = 1.0
"""How wide a door is: the files say only where one is."""


class _Point(BaseModel):
    model_config = ConfigDict(extra="ignore")
    x: float
    y: float


class _Node(BaseModel):
    model_config = ConfigDict(extra="ignore")
    id: int
    loc: _Point


class _Edge(BaseModel):
    model_config = ConfigDict(extra="ignore")
    s0_id: int
    s1_id: int
    has_door: bool = False
    has_automated_door: bool = False
    has_elevator: bool = False
    has_stairs: bool = False
    max_speed: float | None = None


class _Graph(BaseModel):
    model_config = ConfigDict(extra="ignore")
    nodes: list[_Node]
    edges: list[_Edge]


@dataclass(frozen=True, slots=True)
class CobotFloor:
    """What was read of one floor: its navigation graph, and its walls where they are known."""

    graph: Any
    walls: VectorMap | None = None


def import_cobot(
    name: str,
    floors: Mapping[str, CobotFloor],
    elevators: Mapping[str, Mapping[str, int]] | None = None,
) -> Imported:
    """The building of floors, from the lowest to the highest.

    `elevators` say which nodes of which floors one cabin stops at. Raises `WrongInputError`, and
    pydantic's `ValidationError` for what is no such graph.
    """
    read = {floor: _Graph.model_validate(each.graph) for floor, each in floors.items()}
    cabins = elevators or {}
    for elevator, stops in cabins.items():
        for floor, node in stops.items():
            if floor not in read or all(each.id != node for each in read[floor].nodes):
                raise WrongInputError(
                    f"the elevator '{elevator}' stops at node {node} of '{floor}': there is none"
                )
        if len(stops) < 2:
            raise WrongInputError(
                f"the elevator '{elevator}' needs stops on two floors at least, and has "
                f"{len(stops)}"
            )
    document = BuildingDocument(
        building=name,
        floors={
            floor: _floor(
                each,
                floors[floor].walls,
                [stops[floor] for stops in cabins.values() if floor in stops],
            )
            for floor, each in read.items()
        },
        elevators={
            elevator: Elevator(stops={floor: f"n{node}" for floor, node in stops.items()})
            for elevator, stops in cabins.items()
        },
    )
    imported = tidied(Imported(document))
    without = [floor for floor in floors if all(floor not in stops for stops in cabins.values())]
    return Imported(imported.document, [*imported.notes, *_not_said(imported.document, without)])


def _not_said(document: BuildingDocument, without: Sequence[str]) -> Iterator[str]:
    """What the files leave open, and what of it somebody has to say; `without`: floors on which no
    elevator was said to stop."""
    if left_out := [floor for floor in without if floor not in document.floors]:
        yield (
            f"no elevator was said to stop on {list_names(left_out)}: left out with all that is "
            "there (--elevator says where one stops)"
        )
    if len(document.floors) > 1:
        yield "how high floors are is not said: give each its 'height' before robots drive there"
    for name, floor in document.floors.items():
        rooms = [place for place, each in floor.places.items() if each.kind is PlaceKind.ROOM]
        if rooms:
            yield f"floor '{name}': ways end at {', '.join(rooms)}, which count as rooms"


def _floor(graph: _Graph, walls: VectorMap | None, cabins: Sequence[int]) -> Floor:
    at = {
        each.id: (round(each.loc.x, _DECIMALS), round(each.loc.y, _DECIMALS))
        for each in graph.nodes
    }
    # Robots take no stairs; an edge may be there in both directions.
    # What only one of them says of a door holds.
    said_first = sorted(graph.edges, key=lambda each: not each.has_door)
    once = {_ends(each): each for each in said_first[::-1] if not each.has_stairs}
    edges = [each for each in graph.edges if once.get(_ends(each)) is each]
    for each in edges:
        missing = [end for end in (each.s0_id, each.s1_id) if end not in at]
        if missing:
            raise WrongInputError(f"an edge leads to node {missing[0]}, which is not there")
    on_lanes = Counter(end for each in once for end in each)
    in_cabins = {end for each in edges if each.has_elevator for end in (each.s0_id, each.s1_id)}

    def kind(number: int) -> PlaceKind:
        if number in cabins:
            return PlaceKind.ELEVATOR
        is_end = on_lanes[number] == 1 and number not in in_cabins
        return PlaceKind.ROOM if is_end else PlaceKind.WAYPOINT

    places = {}
    for number, (x, y) in at.items():
        if number in on_lanes:
            with refusing(FloorPlace, f"node {number}"):
                places[f"n{number}"] = FloorPlace(x=x, y=y, kind=kind(number))
    lanes = []
    for each in edges:
        between = f"n{each.s0_id}", f"n{each.s1_id}"
        with refusing(Lane, f"the edge from node {each.s0_id} to node {each.s1_id}"):
            lanes.append(Lane(between=between, speed_m_s=each.max_speed))
    return Floor(
        places=places,
        lanes=tuple(lanes),
        walls=() if walls is None else tuple(tuple(row) for row in walls.segments.tolist()),
        doors={
            f"door_{each.s0_id}_{each.s1_id}": _door(at[each.s0_id], at[each.s1_id], each)
            for each in edges
            if each.has_door
        },
    )


def _ends(edge: _Edge) -> tuple[int, int]:
    return min(edge.s0_id, edge.s1_id), max(edge.s0_id, edge.s1_id)


def _door(a: tuple[float, float], b: tuple[float, float], edge: _Edge) -> Door:
    """Across the middle of a lane."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    half = DOOR_M / 2 / (math.hypot(dx, dy) or 1.0)
    x, y = (a[0] + b[0]) / 2, (a[1] + b[1]) / 2
    posts = (x - dy * half, y + dx * half), (x + dy * half, y - dx * half)
    return Door(
        posts=posts, opens=DoorOpening.ITSELF if edge.has_automated_door else DoorOpening.PEOPLE
    )
