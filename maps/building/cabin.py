"""The room that an elevator's cabin takes at its stops, and where one waits for it."""

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from mend.maps.building.building import Building, Floor
from mend.maps.building.clearance import apart_m, distances_m, is_clear

Matrix = NDArray[np.float64]
Point = tuple[float, float]

CABIN_M = 0.6
"""So far is a cabin's wall from its middle, its stop, on all eight sides."""
CABIN_DOOR_S = 2.0
"""Its door takes so long to open, and to shut."""
_SIDES = 8
CORNER_M = CABIN_M / math.cos(math.pi / _SIDES)
"""And so far its corners are."""
_CORNERS = (
    np.array(
        [(math.cos(turn), math.sin(turn)) for turn in (np.arange(_SIDES) + 0.5) * math.tau / _SIDES]
    )
    * CORNER_M
)
_WAITS_M = (1.2, 1.6, 2.0, 2.5, 3.0)
"""Who waits stands so far from the stop, the first that there is room for."""
_DIRECTIONS = 24
_BESIDE_LANES_M = 0.55
_APART_M = 0.7
_SAME_M = 1e-6
_EVERY_M = 0.15


def cabin_walls(stop: Point) -> Matrix:
    """The walls of a cabin that is shut at a stop, as rows (8, 4)."""
    corners = _CORNERS + stop
    return np.hstack([corners, np.roll(corners, -1, axis=0)])


def waiting_points(floor: Floor, stop: Point, needs_m: float) -> Sequence[Point]:
    """Where robots may wait that see the cabin, best first; who needs `needs_m` fits there.

    They are beside the lanes where there is room, so that whoever gets out gets past, and far
    enough from each other. Where some can be come to without going through the cabin, by every lane
    that leads there or by one, all can.
    Empty where there is no room at all.
    """
    lanes = np.array([_ends(floor, each.between) for each in floor.lanes]).reshape(-1, 4)
    candidates = [
        (stop[0] + away_m * math.cos(turn), stop[1] + away_m * math.sin(turn))
        for away_m in _WAITS_M
        for turn in np.arange(_DIRECTIONS) * math.tau / _DIRECTIONS
    ]
    free = [each for each in candidates if is_clear(each, stop, floor.wall_segments, needs_m)]
    if not free:
        return ()
    beside = distances_m(np.array(free), lanes) >= _BESIDE_LANES_M
    ranked = [each for each, so in zip(free, beside, strict=True) if so]
    ranked += [each for each, so in zip(free, beside, strict=True) if not so]
    lead_there = _lane_points(floor, stop)

    def lanes_past(at: Point) -> list[bool]:
        return [_leads_past(floor, at, stop, each, needs_m) for each in lead_there]

    # Lanes from both sides of a cabin lead to each other's side on other ways.
    fits = (lambda at: all(lanes_past(at)), lambda at: any(lanes_past(at)), lambda _: True)
    return next((found for each in fits if (found := _apart(ranked, each))), ())


def _apart(ranked: Sequence[Point], fits: Callable[[Point], bool]) -> Sequence[Point]:
    """The first of those that fit, far enough from each other."""
    chosen: list[Point] = []
    for each in ranked:
        if all(math.dist(each, other) >= _APART_M for other in chosen) and fits(each):
            chosen.append(each)
    return chosen


def _lane_points(floor: Floor, stop: Point) -> Sequence[Matrix]:
    """Points (n, 2) of each lane that leads to a stop, from its other end on."""
    ends = [_ends(floor, each.between) for each in floor.lanes]
    origins = {(a, b) for a, b, *to in ends if math.dist(to, stop) < _SAME_M}
    origins |= {(c, d) for a, b, c, d in ends if math.dist((a, b), stop) < _SAME_M}
    return [
        np.linspace(each, stop, max(2, math.ceil(math.dist(each, stop) / _EVERY_M)))
        for each in sorted(origins)
    ]


def _leads_past(floor: Floor, at: Point, stop: Point, lane: Matrix, needs_m: float) -> bool:
    """Whether a straight way leads from somewhere on a lane to a point, past the cabin."""
    ways = np.hstack([lane, np.broadcast_to(at, lane.shape)])
    past = lane[apart_m(np.array([stop]), ways)[0] >= CABIN_M + needs_m]
    return any(is_clear((x, y), at, floor.wall_segments, needs_m) for x, y in past.tolist())


def stop_of(building: Building, elevator: str, floor: str) -> Point:
    """Where the middle of a cabin is at a floor."""
    place = building.floors[floor].places[building.document.elevators[elevator].stops[floor]]
    return place.x, place.y


def elevator_around(building: Building, x: float, y: float, z: float) -> str | None:
    """The elevator in whose cabin, or shaft between floors, a position is; None outside of all."""
    floor = building.floor_at(z)
    for name, each in building.document.elevators.items():
        floors = [on for on in each.stops if floor in (None, on)]
        if any(math.dist(stop_of(building, name, on), (x, y)) < CABIN_M for on in floors):
            return name
    return None


def _ends(floor: Floor, between: tuple[str, str]) -> tuple[float, float, float, float]:
    a, b = (floor.places[each] for each in between)
    return a.x, a.y, b.x, b.y
