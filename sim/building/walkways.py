"""Where people walk on a floor: along its lanes, from seat to seat in its rooms."""

import math
from collections import deque
from collections.abc import Sequence

import numpy as np

from mend.maps.building.building import Building, Floor, PlaceKind
from mend.maps.building.clearance import clearance_m, distances_m
from mend.sim.building.bystander import RADIUS_M

Point = tuple[float, float]

_OFF_LANES_M = 0.8
"""Who sits so far from lanes and places leaves room for robots that pass."""
_SEATS_AT_M = (0.9, 1.2, 1.6, 2.0)
_DIRECTIONS = 16


class Walkways:
    """The lanes of one floor that no wall and no cabin is in, and a seat in each room."""

    def __init__(self, building: Building, name: str) -> None:
        floor = building.floors[name]
        self._floor = floor
        self._next: dict[str, list[str]] = {}
        for each in building.crossings:
            a, b = each.lane.between
            if each.floor != name or len(each.walls) or _is_stop(floor, a) or _is_stop(floor, b):
                continue
            self._next.setdefault(a, []).append(b)
            self._next.setdefault(b, []).append(a)
        rooms = [
            room
            for room, at in floor.places.items()
            if at.kind is PlaceKind.ROOM and room in self._next
        ]
        found = {room: _seat(floor, room) for room in rooms}
        self.seats: dict[str, Point] = {room: at for room, at in found.items() if at is not None}

    def way(self, start: str, end: str) -> list[Point] | None:
        """Points from a room's place to another's seat, by the fewest lanes, if there are."""
        before: dict[str, str] = {start: start}
        waiting = deque([start])
        while waiting and end not in before:
            here = waiting.popleft()
            for each in self._next.get(here, []):
                if each not in before:
                    before[each] = here
                    waiting.append(each)
        if end not in before:
            return None
        names = [end]
        while names[-1] != start:
            names.append(before[names[-1]])
        places = [self._floor.places[each] for each in reversed(names)]
        return [*((each.x, each.y) for each in places), self.seats[end]]


def _is_stop(floor: Floor, place: str) -> bool:
    return floor.places[place].kind is PlaceKind.ELEVATOR


def _seat(floor: Floor, room: str) -> Point | None:
    """Beside a room's place, off the lanes, nothing in between; the nearest, if any."""
    at = floor.places[room]
    walls = np.vstack([floor.wall_segments, _doors(floor)])
    for away_m in _SEATS_AT_M:
        for number in range(_DIRECTIONS):
            angle = 2.0 * math.pi * number / _DIRECTIONS
            seat = at.x + away_m * math.cos(angle), at.y + away_m * math.sin(angle)
            if (
                clearance_m((at.x, at.y), seat, walls) > RADIUS_M + 0.1
                and _from_lanes_m(floor, seat) > _OFF_LANES_M
            ):
                return seat
    return None


def _doors(floor: Floor) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    rows: Sequence[tuple[float, ...]] = [
        (*each.posts[0], *each.posts[1]) for each in floor.doors.values()
    ]
    return np.array(rows, np.float64).reshape(-1, 4)


def _from_lanes_m(floor: Floor, point: Point) -> float:
    places = floor.places
    lanes = [
        (places[a].x, places[a].y, places[b].x, places[b].y)
        for a, b in (each.between for each in floor.lanes)
    ]
    stand = [(each.x, each.y, each.x, each.y) for each in places.values()]
    return float(distances_m(np.array([point]), np.array([*lanes, *stand], np.float64))[0])
