"""A building: what its file says, and the navigation graph that follows from it.

Lengths are metres, in one frame for all floors (x right, y up), times seconds.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from math import hypot, inf
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from mend.documents.near_names import names_near
from mend.documents.spellings import WORDS
from mend.documents.strict_model import StrictModel
from mend.errors import NotFoundError
from mend.maps.building.crossing import crossed_by
from mend.maps.navigation import NavigationGraph, Place, Way, WayKind
from mend.maps.vector_map import FARTHEST_M, VectorMap

Metres = Annotated[float, Field(ge=-FARTHEST_M, le=FARTHEST_M, allow_inf_nan=False)]
Length = Annotated[float, Field(gt=0.0, le=FARTHEST_M, allow_inf_nan=False)]
Seconds = Annotated[float, Field(ge=0.0, le=1e9, allow_inf_nan=False)]
Speed = Annotated[float, Field(gt=0.0, le=10.0, allow_inf_nan=False)]
Name = Annotated[str, Field(min_length=1, max_length=64, pattern=WORDS)]
"""Any words without a slash, which stands between a floor and a place."""

RIDE_S = 15.0
"""To call an elevator and to get in and out of it; a floor more takes `FLOOR_S`."""
FLOOR_S = 5.0
ON_FLOOR_M = 0.5
"""What is so near to a floor's height is on it."""


class PlaceKind(StrEnum):
    """What a place is for."""

    WAYPOINT = "waypoint"
    ROOM = "room"
    CHARGER = "charger"
    PARKING = "parking"
    ELEVATOR = "elevator"


class FloorPlace(StrictModel):
    """A point that robots drive to or through."""

    x: Metres
    y: Metres
    kind: PlaceKind = PlaceKind.WAYPOINT


class Lane(StrictModel):
    """Where robots drive, straight from place to place; `one_way` from the first to the second."""

    between: tuple[Name, Name]
    one_way: bool = False
    speed_m_s: Speed | None = None


class DoorOpening(StrEnum):
    """Who opens a door."""

    ITSELF = "itself"
    PEOPLE = "people"


class Door(StrictModel):
    """A door across lanes, from post to post. `open_s`: when it may be passed; always if empty."""

    posts: tuple[tuple[Metres, Metres], tuple[Metres, Metres]]
    opens: DoorOpening = DoorOpening.PEOPLE
    open_s: tuple[tuple[Seconds, Seconds], ...] = ()


class Floor(StrictModel):
    """One floor; `walls` are rows x0, y0, x1, y1, without its doors."""

    height: Metres = 0.0
    places: dict[Name, FloorPlace] = {}
    lanes: tuple[Lane, ...] = ()
    walls: tuple[tuple[Metres, Metres, Metres, Metres], ...] = ()
    doors: dict[Name, Door] = {}

    @cached_property
    def wall_segments(self) -> NDArray[np.float64]:
        """Its walls as rows (n, 4), without its doors."""
        return np.array(self.walls, np.float64).reshape(-1, 4)

    def has_way_from(self, x: float, y: float) -> bool:
        """Whether no wall is between a point and one of its places: else no robot gets there."""
        places = sorted(self.places.values(), key=lambda at: hypot(at.x - x, at.y - y))
        return any(
            not len(crossed_by(np.array([x, y, at.x, at.y]), self.wall_segments)) for at in places
        )

    def lanes_twice(self) -> Mapping[int, int]:
        """The lanes that lead no other way than an earlier one, by their numbers."""
        ways: dict[tuple[str, str], int] = {}
        twice = {}
        for number, lane in enumerate(self.lanes):
            a, b = lane.between
            leads = [(a, b)] if lane.one_way else [(a, b), (b, a)]
            if all(way in ways for way in leads):
                twice[number] = ways[a, b]
            for way in leads:
                ways.setdefault(way, number)
        return twice

    @cached_property
    def vector_map(self) -> VectorMap:
        """Its walls, and its doors as if they were shut."""
        shut = [(*each.posts[0], *each.posts[1]) for each in self.doors.values()]
        return VectorMap.of([*self.walls, *shut])


class Caller(StrEnum):
    """Who calls an elevator, and presses the buttons in it."""

    ROBOTS = "robots"
    PEOPLE = "people"


class Elevator(StrictModel):
    """A cabin that stops at a place of each of its floors."""

    stops: Annotated[dict[Name, Name], Field(min_length=2)]
    ride_s: Seconds = RIDE_S
    floor_s: Seconds = FLOOR_S
    called_by: Caller = Caller.PEOPLE


class BuildingDocument(StrictModel):
    """What a building file says. Floors come from the lowest to the highest."""

    building: Name
    floors: Annotated[dict[Name, Floor], Field(min_length=1)]
    elevators: dict[Name, Elevator] = {}


@dataclass(frozen=True, slots=True)
class LaneCrossing:
    """A lane of a floor, and the doors and walls across it."""

    floor: str
    lane: Lane
    doors: Sequence[str]
    walls: NDArray[np.intp]


class Building:
    """A building as its document has it, with the ways through it."""

    def __init__(self, document: BuildingDocument) -> None:
        self.document = document

    @property
    def name(self) -> str:
        return self.document.building

    @property
    def floors(self) -> Mapping[str, Floor]:
        return self.document.floors

    def find(self, name: str) -> str:
        """The full name of a place, given as `FLOOR/PLACE`, or as a name that no other place has.

        Raises `NotFoundError`.
        """
        if name in self._places:
            return name
        found = [each for each in self._places if each.split("/", 1)[1] == name]
        if len(found) == 1:
            return found[0]
        if not found:
            raise NotFoundError(
                f"the building '{self.name}' has no place '{name}'; there is "
                f"{names_near(name, self._names_like(name))}"
            )
        raise NotFoundError(f"'{name}' is on several floors: say {' or '.join(found)}")

    def _names_like(self, name: str) -> Iterable[str]:
        """All places, as fully as `name` has been given."""
        return self._places if "/" in name else {each.split("/", 1)[1] for each in self._places}

    def floor_at(self, height_m: float) -> str | None:
        """The floor at a height; None where there is none."""
        for name, each in self.floors.items():
            if abs(each.height - height_m) < ON_FLOOR_M:
                return name
        return None

    def of_kind(self, kind: PlaceKind) -> list[str]:
        """The full names of all places of one kind."""
        return [name for name, each in self._places.items() if each.kind is kind]

    @cached_property
    def crossings(self) -> Sequence[LaneCrossing]:
        """Every lane, with what is across it."""
        return [each for name, floor in self.floors.items() for each in _crossings(name, floor)]

    @cached_property
    def graph(self) -> NavigationGraph:
        """All places by their full names, and the ways between them."""
        numbers = {name: number for number, name in enumerate(self.floors)}
        places = [
            Place(name, each.x, each.y, numbers[name.split("/", 1)[0]])
            for name, each in self._places.items()
        ]
        return NavigationGraph(places, [*self._lanes(), *self._rides()])

    @cached_property
    def _places(self) -> dict[str, FloorPlace]:
        return {
            f"{floor}/{name}": place
            for floor, each in self.floors.items()
            for name, place in each.places.items()
        }

    def _lanes(self) -> Iterator[Way]:
        for each in self.crossings:
            a, b = each.lane.between
            doors = [self.floors[each.floor].doors[name] for name in each.doors]
            spans = _all_open(doors)
            yield Way(
                f"{each.floor}/{a}",
                f"{each.floor}/{b}",
                WayKind.DOOR if doors else WayKind.CORRIDOR,
                open_s=() if spans == [(0.0, inf)] else tuple(spans),
                closed=not spans,
                one_way=each.lane.one_way,
                speed_m_s=each.lane.speed_m_s,
            )

    def _rides(self) -> Iterator[Way]:
        order = list(self.floors)
        for elevator in self.document.elevators.values():
            stops = sorted(elevator.stops.items(), key=lambda each: order.index(each[0]))
            for number, (low, at_low) in enumerate(stops):
                for high, at_high in stops[number + 1 :]:
                    floors = order.index(high) - order.index(low)
                    delay_s = elevator.ride_s + floors * elevator.floor_s
                    ends = f"{low}/{at_low}", f"{high}/{at_high}"
                    yield Way(*ends, WayKind.ELEVATOR, length_m=0.0, delay_s=delay_s)


def _crossings(name: str, floor: Floor) -> Iterator[LaneCrossing]:
    doors = np.array([(*d.posts[0], *d.posts[1]) for d in floor.doors.values()]).reshape(-1, 4)
    walls, door_names = np.array(floor.walls, dtype=float).reshape(-1, 4), list(floor.doors)
    for lane in floor.lanes:
        a, b = (floor.places[each] for each in lane.between)
        way = np.array([a.x, a.y, b.x, b.y])
        through = [door_names[each] for each in crossed_by(way, doors)]
        yield LaneCrossing(name, lane, through, crossed_by(way, walls))


def _all_open(doors: Sequence[Door]) -> list[tuple[float, float]]:
    """When all of some doors may be passed."""
    spans = [(0.0, inf)]
    for each in (door.open_s for door in doors if door.open_s):
        both = [(max(a, c), min(b, d)) for a, b in spans for c, d in each]
        spans = [(a, b) for a, b in both if a < b]
    return spans
