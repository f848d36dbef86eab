"""Office buildings drawn by a seed: corridors with rooms on both sides, the same elevators through
all floors.

Corridors run along x, one above the other; where there are several, corridors across join them at
both ends, so that there is a way round.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import count, pairwise

import numpy as np

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

CORRIDOR_M = 2.6
DOOR_M = 1.1
STOREY_M = 3.5
MOST_FLOORS, MOST_ROOMS = 30, 80
"""Of a building, and of a floor."""

_NARROWEST_M, _WIDEST_M = 3.6, 6.5
_SHALLOWEST_M, _DEEPEST_M = 4.0, 6.0
_PER_CORRIDOR = 16
"""A corridor has about so many rooms."""
_OWN_DOORS = 0.25
"""Such a share of the doors opens by itself."""


@dataclass(frozen=True, slots=True)
class Room:
    """A slot beside a corridor: along x from `left` to `right`, above it or below."""

    left_m: float
    right_m: float
    above: bool
    kind: PlaceKind = PlaceKind.ROOM

    @property
    def middle_m(self) -> float:
        return (self.left_m + self.right_m) / 2


@dataclass(frozen=True, slots=True)
class _Plan:
    """What all floors of a building have in common."""

    corridors: list[list[Room]]
    begin_m: float
    depth_m: float
    length_m: float
    own_doors: set[tuple[int, int]]

    def corridor_y_m(self, number: int) -> float:
        return number * (CORRIDOR_M + 2 * self.depth_m)


def random_building(seed: int, floors: int, rooms: int, name: str = "") -> BuildingDocument:
    """A building with so many floors, and rooms on each of them.

    Raises `ValueError` unless there are 1 to `MOST_FLOORS` and 1 to `MOST_ROOMS`.
    """
    if not 1 <= floors <= MOST_FLOORS or not 1 <= rooms <= MOST_ROOMS:
        expected = f"1 to {MOST_FLOORS} floors and 1 to {MOST_ROOMS} rooms on each"
        raise ValueError(f"expected {expected}, got {floors} and {rooms}")
    plan = _draw_plan(np.random.default_rng(seed), floors, rooms)
    elevators = [each for row in plan.corridors for each in row if each.kind is PlaceKind.ELEVATOR]
    return BuildingDocument(
        building=name or f"building_{seed}",
        floors={
            f"F{number}": _FloorDrawing(plan, number).floor((number - 1) * STOREY_M)
            for number in range(1, floors + 1)
        },
        elevators={
            f"lift{index}": Elevator(
                stops={f"F{number}": f"lift{index}" for number in range(1, floors + 1)},
                called_by=Caller.ROBOTS if (seed + index) % 2 else Caller.PEOPLE,
            )
            for index in range(1, len(elevators) + 1)
        },
    )


def _draw_plan(rng: np.random.Generator, floors: int, rooms: int) -> _Plan:
    rows = max(1, round(rooms / _PER_CORRIDOR))
    begin = CORRIDOR_M if rows > 1 else 0.0
    kinds = [PlaceKind.ROOM] * rooms + [PlaceKind.CHARGER]
    if floors > 1:
        kinds += [PlaceKind.ELEVATOR] * (1 if rooms < 2 * _PER_CORRIDOR else 2)
    kinds = [kinds[each] for each in rng.permutation(len(kinds))]
    corridors = [_row(rng, list(kinds[number::rows]), begin) for number in range(rows)]
    length_m = max(each.right_m for row in corridors for each in row) + begin
    own = {
        (row, number)
        for row, slots in enumerate(corridors)
        for number, each in enumerate(slots)
        if each.kind is PlaceKind.ELEVATOR or rng.random() < _OWN_DOORS
    }
    depth_m = round(float(rng.uniform(_SHALLOWEST_M, _DEEPEST_M)), 2)
    return _Plan(corridors, begin, depth_m, length_m, own)


def _row(rng: np.random.Generator, kinds: list[PlaceKind], begin_m: float) -> list[Room]:
    """The slots along one corridor, each on the side that is shorter so far."""
    ends = {True: begin_m, False: begin_m}
    row = []
    for kind in kinds:
        above = ends[True] <= ends[False]
        width_m = round(float(rng.uniform(_NARROWEST_M, _WIDEST_M)), 2)
        row.append(Room(ends[above], round(ends[above] + width_m, 2), above, kind))
        ends[above] = row[-1].right_m
    return row


@dataclass(slots=True)
class _FloorDrawing:
    """One floor as it is drawn."""

    plan: _Plan
    number: int
    places: dict[str, FloorPlace] = field(default_factory=dict)
    lanes: list[Lane] = field(default_factory=list)
    walls: list[tuple[float, float, float, float]] = field(default_factory=list)
    doors: dict[str, Door] = field(default_factory=dict)

    def floor(self, height_m: float) -> Floor:
        """The whole floor."""
        names = {
            PlaceKind.ROOM: (f"{100 * self.number + each}" for each in count(1)),
            PlaceKind.CHARGER: iter([f"charger{self.number}"]),
            PlaceKind.ELEVATOR: (f"lift{each}" for each in count(1)),
        }
        ends = []
        for corridor, row in enumerate(self.plan.corridors):
            stops = self._corridor(corridor, row)
            ends.append((stops[min(stops)], stops[max(stops)]))
            for index, room in enumerate(row):
                name = next(names[room.kind])
                self._room(corridor, room, name, (corridor, index) in self.plan.own_doors)
                self.lanes.append(Lane(between=(stops[room.middle_m], name)))
        for below, above in pairwise(ends):
            self.lanes += [Lane(between=pair) for pair in zip(below, above, strict=True)]
        self._outline()
        return Floor(
            height=height_m,
            places=self.places,
            lanes=tuple(self.lanes),
            walls=tuple(self.walls),
            doors=self.doors,
        )

    def _corridor(self, corridor: int, row: Sequence[Room]) -> dict[float, str]:
        """The waypoints along a corridor, by x, with lanes between them and walls beside rooms."""
        y, length_m = self.plan.corridor_y_m(corridor), self.plan.length_m
        ends = {CORRIDOR_M / 2, length_m - CORRIDOR_M / 2}
        xs = sorted(ends | {each.middle_m for each in row})
        stops = {x: f"w{corridor}_{number}" for number, x in enumerate(xs)}
        self.places |= {name: FloorPlace(x=x, y=y) for x, name in stops.items()}
        self.lanes += [Lane(between=pair) for pair in pairwise(stops.values())]
        for above in (True, False):
            begin_m = self.plan.begin_m
            last_m = max((each.right_m for each in row if each.above is above), default=begin_m)
            front, back = self._sides_m(corridor, above)
            if last_m < length_m - begin_m:
                self._wall(last_m, front, length_m - begin_m, front)
                self._wall(last_m, back, length_m - begin_m, back)
            self._wall(length_m - begin_m, front, length_m - begin_m, back)
        return stops

    def _room(self, corridor: int, room: Room, name: str, opens_itself: bool) -> None:
        front, back = self._sides_m(corridor, room.above)
        left, right = room.middle_m - DOOR_M / 2, room.middle_m + DOOR_M / 2
        self.places[name] = FloorPlace(x=room.middle_m, y=(front + back) / 2, kind=room.kind)
        self._wall(room.left_m, front, room.left_m, back)
        self._wall(room.right_m, front, room.right_m, back)
        self._wall(room.left_m, back, room.right_m, back)
        self._wall(room.left_m, front, left, front)
        self._wall(right, front, room.right_m, front)
        if room.kind is not PlaceKind.CHARGER:
            opens = DoorOpening.ITSELF if opens_itself else DoorOpening.PEOPLE
            # An elevator is called so on every floor, and none of its doors is.
            door = f"F{self.number} {name} door" if room.kind is PlaceKind.ELEVATOR else name
            self.doors[door] = Door(posts=((left, front), (right, front)), opens=opens)

    def _outline(self) -> None:
        length_m, begin_m = self.plan.length_m, self.plan.begin_m
        bottom = -CORRIDOR_M / 2
        top = self.plan.corridor_y_m(len(self.plan.corridors) - 1) + CORRIDOR_M / 2
        for x in (0.0, length_m):
            self._wall(x, bottom, x, top)
        for y in (bottom, top):
            if begin_m > 0.0:
                self._wall(0.0, y, begin_m, y)
                self._wall(length_m - begin_m, y, length_m, y)

    def _sides_m(self, corridor: int, above: bool) -> tuple[float, float]:
        """y of a corridor's wall, and of the back of the rooms along it."""
        sign = 1.0 if above else -1.0
        front = self.plan.corridor_y_m(corridor) + sign * CORRIDOR_M / 2
        return front, front + sign * self.plan.depth_m

    def _wall(self, *ends: float) -> None:
        x0, y0, x1, y1 = (round(each, 3) for each in ends)
        self.walls.append((x0, y0, x1, y1))
