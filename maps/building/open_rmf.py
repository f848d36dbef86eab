"""Buildings as Open-RMF's traffic editor has them (`building.yaml`).

Vertices are points of a floor's drawing in pixels, x right and y down; measured edges say how long
a pixel is, and fiducials of one name lie above each other. Where the drawing is a map of the globe
they are degrees of longitude and latitude.
"""

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

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
from mend.maps.building.naming import unlike
from mend.maps.building.tidying import Imported, tidied

Matrix = NDArray[np.float64]

EARTH_M = 6_378_137.0
"""The equator's radius (WGS 84)."""

_DECIMALS = 3

Text = Annotated[str, BeforeValidator(str)]
"""Names may be numbers there."""
Coordinate = Annotated[float, Field(ge=-1e9, le=1e9, allow_inf_nan=False)]
"""Of a drawing, in pixels, metres or degrees."""
Properties = dict[str, tuple[int, Any]]
Vertex = (
    tuple[Coordinate, Coordinate, float]
    | tuple[Coordinate, Coordinate, float, Text]
    | (tuple[Coordinate, Coordinate, float, Text, Properties])
)
Edge = tuple[int, int] | tuple[int, int, Properties]
Fiducial = tuple[Coordinate, Coordinate, Text]


class _Lenient(BaseModel):
    model_config = ConfigDict(extra="ignore")


class _Level(_Lenient):
    elevation: float = 0.0
    vertices: list[Vertex] = []
    lanes: list[Edge] = []
    walls: list[Edge] = []
    doors: list[Edge] = []
    measurements: list[Edge] = []
    fiducials: list[Fiducial] = []


class _Lift(_Lenient):
    """`x`, `y` in its reference level's drawing; `width` along its turned x axis, in metres."""

    level_doors: dict[Text, list[Text]] = {}
    reference_floor_name: Text | None = None
    x: Coordinate = 0.0
    y: Coordinate = 0.0
    yaw: float = 0.0
    width: float = 0.0
    depth: float = 0.0


class _Plan(_Lenient):
    name: Text = "building"
    coordinate_system: Literal["reference_image", "wgs84", "cartesian_meters"] = "reference_image"
    reference_level_name: Text | None = None
    levels: dict[Text, _Level]
    lifts: dict[Text, _Lift] = {}


def import_open_rmf(content: Any, graphs: Sequence[int] = ()) -> Imported:
    """The building of a plan that was read; with its lanes of some `graphs` only, where given.

    Raises `WrongInputError`, pydantic's `ValidationError` for what is no such plan.
    """
    plan = _Plan.model_validate(content)
    if not plan.levels:
        raise WrongInputError("the plan has no levels")
    for name, level in plan.levels.items():
        _require_vertices(name, level)
    notes: list[str] = []
    frames = _frames(plan)
    order = sorted(plan.levels, key=lambda each: plan.levels[each].elevation)
    shafts = _shafts(plan, frames)
    read = {
        name: _read_level(name, plan.levels[name], frames[name], graphs, shafts, notes)
        for name in order
    }
    elevators = _elevators(plan, read, notes)
    floors = {name: each.floor for name, each in read.items()}
    document = BuildingDocument(building=plan.name, floors=floors, elevators=elevators)
    return tidied(Imported(document, notes))


# --- From pixels to metres --------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Similarity:
    """Turns, scales and shifts points (n, 2)."""

    linear: Matrix
    shift: Matrix

    def __call__(self, points: Matrix) -> Matrix:
        return np.asarray(points @ self.linear.T + self.shift)


def _frames(plan: _Plan) -> dict[str, _Similarity]:
    """How each level's vertices become metres in the frame of the reference level."""
    if plan.coordinate_system == "wgs84":
        return dict.fromkeys(plan.levels, _from_globe(plan))
    if plan.coordinate_system == "cartesian_meters":
        return dict.fromkeys(plan.levels, _Similarity(np.eye(2), np.zeros(2)))
    reference = plan.reference_level_name or next(iter(plan.levels))
    if reference not in plan.levels:
        raise WrongInputError(f"the plan has no level '{reference}', which it names as reference")
    own = {name: _in_metres(name, each, plan) for name, each in plan.levels.items()}
    to = _fiducials(plan.levels[reference], own[reference])
    return {
        name: _laid_over(own[name], _fiducials(each, own[name]), to)
        for name, each in plan.levels.items()
    }


def _in_metres(name: str, level: _Level, plan: _Plan) -> _Similarity:
    """By its own measurements, or where it has none by those of all other levels."""
    scales = _scales(level) or [each for other in plan.levels.values() for each in _scales(other)]
    if not scales:
        raise WrongInputError(
            f"nothing on level '{name}' is measured: how long a pixel is, is unknown"
        )
    scale = float(np.mean(scales))
    return _Similarity(np.diag([scale, -scale]), np.zeros(2))


def _scales(level: _Level) -> list[float]:
    """Metres per pixel, by each measured edge."""
    found = []
    for each in level.measurements:
        a, b = (level.vertices[end] for end in each[:2])
        pixels, metres = math.hypot(a[0] - b[0], a[1] - b[1]), _property(each, "distance")
        if pixels > 0.0 and isinstance(metres, int | float) and metres > 0.0:
            found.append(metres / pixels)
    return found


def _fiducials(level: _Level, frame: _Similarity) -> dict[str, Matrix]:
    return {name: frame(np.array([[x, y]]))[0] for x, y, name in level.fiducials}


def _laid_over(own: _Similarity, of: Mapping[str, Matrix], to: Mapping[str, Matrix]) -> _Similarity:
    """Turned and shifted so that fiducials of one name lie best above each other.

    Umeyama, "Least-squares estimation of transformation parameters between two point patterns",
    IEEE PAMI 13 (1991), equations 40 to 42, without a scale.
    """
    both = [name for name in of if name in to]
    if len(both) < 2:
        return own
    a, b = (np.array([each[name] for name in both]) for each in (of, to))
    u, _, v = np.linalg.svd((b - b.mean(0)).T @ (a - a.mean(0)))
    turn = u @ np.diag([1.0, np.linalg.det(u @ v)]) @ v
    shift = b.mean(0) - turn @ a.mean(0)
    return _Similarity(turn @ own.linear, turn @ own.shift + shift)


def _from_globe(plan: _Plan) -> _Similarity:
    """A plane that touches the globe in the middle of the plan."""
    points = np.array([each[:2] for level in plan.levels.values() for each in level.vertices])
    middle = points.mean(axis=0) if len(points) else np.zeros(2)
    north_m = math.radians(1.0) * EARTH_M
    linear = np.diag([north_m * math.cos(math.radians(middle[1])), north_m])
    return _Similarity(linear, -linear @ middle)


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


def _shafts(plan: _Plan, frames: Mapping[str, _Similarity]) -> list[_Shaft]:
    shafts = []
    for name, each in plan.lifts.items():
        reference = each.reference_floor_name or plan.reference_level_name
        if reference is not None and reference in frames and each.width > 0.0 and each.depth > 0.0:
            middle = frames[reference](np.array([[each.x, each.y]]))[0]
            levels = _served(plan, each)
            shafts.append(_Shaft(name, levels, middle, each.yaw, each.width, each.depth))
    return shafts


def _served(plan: _Plan, lift: _Lift) -> list[str]:
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
    level: _Level,
    frame: _Similarity,
    graphs: Sequence[int],
    shafts: Sequence[_Shaft],
    notes: list[str],
) -> _Read:
    points = frame(np.array([each[:2] for each in level.vertices], dtype=float).reshape(-1, 2))
    points = points.round(_DECIMALS) + 0.0
    lanes = [
        each for each in level.lanes if not graphs or _property(each, "graph_idx", 0) in graphs
    ]
    on_lanes = sorted({end for each in lanes for end in each[:2]})
    lifts = _lifts_at(name, level, points, on_lanes, shafts)
    names = _names(name, level, on_lanes, lifts, notes)
    places = {
        names[each]: FloorPlace(
            x=points[each][0],
            y=points[each][1],
            kind=PlaceKind.ELEVATOR if each in lifts else _kind(level.vertices[each]),
        )
        for each in on_lanes
    }
    floor = Floor(
        height=level.elevation,
        places=places,
        lanes=tuple(_lanes(lanes, names)),
        walls=tuple(_segment(points, each) for each in level.walls),
        doors=_doors(name, level, points, notes),
    )
    return _Read(floor, names, {lift: names[each] for each, lift in lifts.items()})


def _lifts_at(
    name: str,
    level: _Level,
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
        if (lift := _property(level.vertices[each], "lift_cabin"))
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


def _require_vertices(name: str, level: _Level) -> None:
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
    level: _Level,
    on_lanes: Sequence[int],
    lifts: Mapping[int, str],
    notes: list[str],
) -> dict[int, str]:
    """What the vertices on lanes are called: as they are there, or by their numbers."""
    names: dict[int, str] = {}
    taken: set[str] = set()
    for each in on_lanes:
        vertex = level.vertices[each]
        own = _plain(_name_of(vertex)) or _plain(lifts.get(each, "")) or f"v{each}"
        called = unlike(own, taken)
        if called != own:
            notes.append(f"level '{name}' has two places '{own}': one is called '{called}' here")
        names[each] = called
        taken.add(called)
    lost = [
        own
        for number, each in enumerate(level.vertices)
        if (own := _plain(_name_of(each))) and number not in names
    ]
    if lost:
        shown = ", ".join(lost[:5]) + (", ..." if len(lost) > 5 else "")
        notes.append(f"level '{name}': no lane leads to {len(lost)} named vertices ({shown})")
    return names


def _lanes(lanes: Sequence[Edge], names: Mapping[int, str]) -> Iterator[Lane]:
    for each in lanes:
        speed = _property(each, "speed_limit", 0.0)
        yield Lane(
            between=(names[each[0]], names[each[1]]),
            one_way=not _property(each, "bidirectional", False),
            speed_m_s=float(speed) if isinstance(speed, int | float) and speed > 0.0 else None,
        )


def _doors(name: str, level: _Level, points: Matrix, notes: list[str]) -> dict[str, Door]:
    doors: dict[str, Door] = {}
    for number, each in enumerate(level.doors):
        own = _plain(str(_property(each, "name", ""))) or f"door{number}"
        called = unlike(own, doors)
        if called != own:
            notes.append(f"level '{name}' has two doors '{own}': one is called '{called}' here")
        x0, y0, x1, y1 = _segment(points, each)
        # What the traffic editor gives no motor is a doorway that people use.
        itself = _property(each, "plugin", "normal") == "normal"
        opens = DoorOpening.ITSELF if itself else DoorOpening.PEOPLE
        doors[called] = Door(posts=((x0, y0), (x1, y1)), opens=opens)
    return doors


def _elevators(plan: _Plan, read: Mapping[str, _Read], notes: list[str]) -> dict[str, Elevator]:
    elevators: dict[str, Elevator] = {}
    for lift, each in plan.lifts.items():
        served = _served(plan, each)
        stops = {
            name: level.cabins[lift]
            for name, level in read.items()
            if name in served and lift in level.cabins
        }
        if len(stops) < 2:
            notes.append(
                f"the lift '{lift}' has lanes on {len(stops)} of its levels: it is left out"
            )
        else:
            called = unlike(_plain(lift) or "lift", elevators)
            elevators[called] = Elevator(stops=stops, called_by=Caller.ROBOTS)
    return elevators


def _kind(vertex: Vertex) -> PlaceKind:
    if _property(vertex, "is_charger"):
        return PlaceKind.CHARGER
    if _property(vertex, "is_parking_spot"):
        return PlaceKind.PARKING
    return PlaceKind.ROOM if _plain(_name_of(vertex)) else PlaceKind.WAYPOINT


def _name_of(vertex: Vertex) -> str:
    return str(vertex[3]) if len(vertex) > 3 else ""


def _plain(name: str) -> str:
    """A name without what stands between a floor and a place."""
    return " ".join(name.replace("/", "-").split())[:64]


def _segment(points: Matrix, edge: Edge) -> tuple[float, float, float, float]:
    (x0, y0), (x1, y1) = points[edge[0]], points[edge[1]]
    return float(x0), float(y0), float(x1), float(y1)


def _property(of: Vertex | Edge, name: str, otherwise: Any = None) -> Any:
    """The value of a property, which comes as a number for its type and the value."""
    last = of[-1]
    return last[name][1] if isinstance(last, dict) and name in last else otherwise
