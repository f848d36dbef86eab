"""Buildings as Open-RMF's traffic editor has them (`building.yaml`).

Vertices are points of a floor's drawing in pixels, x right and y down; measured edges say how long
a pixel is, and fiducials of one name lie above each other. Where the drawing is a map of the globe
they are degrees of longitude and latitude.
"""

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mend.documents.validation import refusing
from mend.errors import WrongInputError
from mend.maps.building.building import (
    BuildingDocument,
    Caller,
    Door,
    DoorOpening,
    Elevator,
    Floor,
    FloorPlace,
    Lane,
    PlaceKind,
)
from mend.maps.building.naming import plain_name, unlike
from mend.maps.building.open_rmf_frames import Matrix, Similarity, frames_of
from mend.maps.building.open_rmf_plan import Edge, Level, Lift, Plan, Vertex, property_of
from mend.maps.building.tidying import Imported, tidied

_DECIMALS = 3


def import_open_rmf(content: Any, graphs: Sequence[int] = ()) -> Imported:
    """The building of a plan that was read; with its lanes of some `graphs` only, where given.

    Raises `WrongInputError`, pydantic's `ValidationError` for what is no such plan.
    """
    plan = Plan.model_validate(content)
    if not plan.levels:
        raise WrongInputError("the plan has no levels")
    for name, level in plan.levels.items():
        _require_vertices(name, level)
    notes: list[str] = []
    frames = frames_of(plan)
    order = sorted(plan.levels, key=lambda each: plan.levels[each].elevation)
    shafts = _shafts(plan, frames)
    read = {
        name: _read_level(name, plan.levels[name], frames[name], graphs, shafts, notes)
        for name in order
    }
    called = _floor_names(order, notes)
    document = BuildingDocument(
        building=plain_name(plan.name) or "building",
        floors={called[name]: each.floor for name, each in read.items()},
        elevators=_elevators(plan, read, called, notes),
    )
    return tidied(Imported(document, notes))


def _floor_names(levels: Sequence[str], notes: list[str]) -> dict[str, str]:
    """What each level is called here."""
    called: dict[str, str] = {}
    for level in levels:
        called[level] = unlike(plain_name(level) or "level", list(called.values()))
        if called[level] != level:
            notes.append(f"the level '{level}' is called '{called[level]}' here")
    return called


# --- Levels -----------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Shaft:
    """The room of a lift's cabin in metres, above each other on the levels where it has doors."""

    lift: str
    levels: Collection[str]
    middle: Matrix
    yaw: float
    width: float
    depth: float

    def away_m(self, point: Matrix) -> float | None:
        """How far a point is from the middle; None for one outside."""
        x, y = point - self.middle
        along = x * math.cos(self.yaw) + y * math.sin(self.yaw)
        across = y * math.cos(self.yaw) - x * math.sin(self.yaw)
        if abs(along) > self.width / 2.0 or abs(across) > self.depth / 2.0:
            return None
        return math.hypot(x, y)


def _shafts(plan: Plan, frames: Mapping[str, Similarity]) -> list[_Shaft]:
    shafts = []
    for name, each in plan.lifts.items():
        reference = each.reference_floor_name or plan.reference_level_name
        if reference is not None and reference in frames and each.width > 0.0 and each.depth > 0.0:
            middle = frames[reference](np.array([[each.x, each.y]]))[0]
            levels = _served(plan, each)
            shafts.append(_Shaft(name, levels, middle, each.yaw, each.width, each.depth))
    return shafts


def _served(plan: Plan, lift: Lift) -> list[str]:
    """The levels on which a lift has doors; where nothing is said of that, all."""
    return [level for level, doors in lift.level_doors.items() if doors] or list(plan.levels)


@dataclass(slots=True)
class _Read:
    """A level as a floor, and what its vertices are called there."""

    floor: Floor
    names: dict[int, str]
    cabins: dict[str, str]


def _read_level(
    name: str,
    level: Level,
    frame: Similarity,
    graphs: Sequence[int],
    shafts: Sequence[_Shaft],
    notes: list[str],
) -> _Read:
    points = frame(np.array([each[:2] for each in level.vertices], dtype=float).reshape(-1, 2))
    points = points.round(_DECIMALS) + 0.0
    lanes = [
        each for each in level.lanes if not graphs or property_of(each, "graph_idx", 0) in graphs
    ]
    on_lanes = sorted({end for each in lanes for end in each[:2]})
    lifts = _lifts_at(name, level, points, on_lanes, shafts)
    names = _names(name, level, on_lanes, lifts, notes)
    places = {}
    for each in on_lanes:
        kind = PlaceKind.ELEVATOR if each in lifts else _kind(level.vertices[each])
        with refusing(FloorPlace, f"vertex {each} of level '{name}'"):
            places[names[each]] = FloorPlace(x=points[each][0], y=points[each][1], kind=kind)
    with refusing(Floor, f"level '{name}'"):
        floor = Floor(
            height=level.elevation,
            places=places,
            lanes=tuple(_lanes(name, lanes, names)),
            walls=tuple(_segment(points, each) for each in level.walls),
            doors=_doors(name, level, points, notes),
        )
    return _Read(floor, names, {lift: names[each] for each, lift in lifts.items()})


def _lifts_at(
    name: str,
    level: Level,
    points: Matrix,
    on_lanes: Sequence[int],
    shafts: Sequence[_Shaft],
) -> dict[int, str]:
    """The lift of each vertex on a lane that is in a cabin.

    Either the vertex says so, or where it is: plans of older editors leave it at that.
    """
    lifts = {
        each: str(lift)
        for each in on_lanes
        if (lift := property_of(level.vertices[each], "lift_cabin"))
    }
    for shaft in shafts:
        if shaft.lift in lifts.values() or name not in shaft.levels:
            continue
        inside = [
            (away_m, each)
            for each in on_lanes
            if each not in lifts and (away_m := shaft.away_m(points[each])) is not None
        ]
        if inside:
            lifts[min(inside)[1]] = shaft.lift
    return lifts


def _require_vertices(name: str, level: Level) -> None:
    kinds = {
        "lane": level.lanes,
        "wall": level.walls,
        "door": level.doors,
        "measurement": level.measurements,
    }
    for what, edges in kinds.items():
        for number, each in enumerate(edges):
            if not all(0 <= end < len(level.vertices) for end in each[:2]):
                raise WrongInputError(
                    f"{what} {number} of level '{name}' joins {each[0]} and {each[1]}, but there "
                    f"are {len(level.vertices)} vertices, from 0 on"
                )


def _names(
    name: str,
    level: Level,
    on_lanes: Sequence[int],
    lifts: Mapping[int, str],
    notes: list[str],
) -> dict[int, str]:
    """What the vertices on lanes are called: as they are there, or by their numbers."""
    names: dict[int, str] = {}
    taken: set[str] = set()
    for each in on_lanes:
        vertex = level.vertices[each]
        own = plain_name(_name_of(vertex)) or plain_name(lifts.get(each, "")) or f"v{each}"
        called = unlike(own, taken)
        if called != own:
            notes.append(f"level '{name}' has two places '{own}': one is called '{called}' here")
        names[each] = called
        taken.add(called)
    lost = [
        own
        for number, each in enumerate(level.vertices)
        if (own := plain_name(_name_of(each))) and number not in names
    ]
    if lost:
        shown = ", ".join(lost[:5]) + (", ..." if len(lost) > 5 else "")
        notes.append(f"level '{name}': no lane leads to {len(lost)} named vertices ({shown})")
    return names


def _lanes(level: str, lanes: Sequence[Edge], names: Mapping[int, str]) -> Iterator[Lane]:
    for each in lanes:
        speed = property_of(each, "speed_limit", 0.0)
        between = names[each[0]], names[each[1]]
        with refusing(Lane, f"the lane from '{between[0]}' to '{between[1]}' of level '{level}'"):
            lane = Lane(
                between=between,
                one_way=not property_of(each, "bidirectional", False),
                speed_m_s=float(speed) if isinstance(speed, int | float) and speed > 0.0 else None,
            )
        yield lane


def _doors(name: str, level: Level, points: Matrix, notes: list[str]) -> dict[str, Door]:
    doors: dict[str, Door] = {}
    for number, each in enumerate(level.doors):
        own = plain_name(str(property_of(each, "name", ""))) or f"door{number}"
        called = unlike(own, doors)
        if called != own:
            notes.append(f"level '{name}' has two doors '{own}': one is called '{called}' here")
        x0, y0, x1, y1 = _segment(points, each)
        # What the traffic editor gives no motor is a doorway that people use.
        itself = property_of(each, "plugin", "normal") == "normal"
        opens = DoorOpening.ITSELF if itself else DoorOpening.PEOPLE
        with refusing(Door, f"door {number} of level '{name}'"):
            doors[called] = Door(posts=((x0, y0), (x1, y1)), opens=opens)
    return doors


def _elevators(
    plan: Plan, read: Mapping[str, _Read], floors: Mapping[str, str], notes: list[str]
) -> dict[str, Elevator]:
    elevators: dict[str, Elevator] = {}
    for lift, each in plan.lifts.items():
        served = _served(plan, each)
        stops = {
            floors[name]: level.cabins[lift]
            for name, level in read.items()
            if name in served and lift in level.cabins
        }
        if len(stops) < 2:
            notes.append(
                f"the lift '{lift}' has lanes on {len(stops)} of its levels: it is left out"
            )
        else:
            called = unlike(plain_name(lift) or "lift", elevators)
            elevators[called] = Elevator(stops=stops, called_by=Caller.ROBOTS)
    return elevators


def _kind(vertex: Vertex) -> PlaceKind:
    if property_of(vertex, "is_charger"):
        return PlaceKind.CHARGER
    if property_of(vertex, "is_parking_spot"):
        return PlaceKind.PARKING
    return PlaceKind.ROOM if plain_name(_name_of(vertex)) else PlaceKind.WAYPOINT


def _name_of(vertex: Vertex) -> str:
    return str(vertex[3]) if len(vertex) > 3 else ""


def _segment(points: Matrix, edge: Edge) -> tuple[float, float, float, float]:
    (x0, y0), (x1, y1) = points[edge[0]], points[edge[1]]
    return float(x0), float(y0), float(x1), float(y1)
