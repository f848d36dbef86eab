"""Hallways that are blocked: people stand side by side in them, and let nobody through."""

import math
from collections.abc import Collection, Iterator

import numpy as np

from mend.maps.building.building import Building, Floor, PlaceKind
from mend.maps.building.clearance import distances_m
from mend.sim.building.bystander import RADIUS_M, Bystander
from mend.sim.building.floor_pose import FloorPose

Point = tuple[float, float]

SHORTEST_M = 1.5
"""In shorter ones, one end of which is at every door, nobody stands."""
_FROM_ROBOTS_M = 2.0
_WIDEST_M = 4.0
"""Wider ones are not blocked."""


def blocked_lanes(building: Building, share: float, seed: int) -> list[tuple[str, str]]:
    """Of the lanes between two places that are only passed, so many that are blocked; drawn."""
    rng = np.random.default_rng([seed, 0x6A7])
    return [
        (f"{name}/{a}", f"{name}/{b}")
        for name, floor in building.floors.items()
        for a, b in (lane.between for lane in floor.lanes)
        if _is_hallway(floor, a, b) and rng.random() < share
    ]


def gatherings(
    building: Building, share: float, seed: int, stand: Collection[FloorPose]
) -> list[Bystander]:
    """Those who block these lanes, in the middle of each, but not where a robot `stand`s."""
    found: list[Bystander] = []
    for first, second in blocked_lanes(building, share, seed):
        name, a = first.split("/", 1)
        floor, b = building.floors[name], second.split("/", 1)[1]
        row = [FloorPose(name, *at) for at in _row(floor, a, b)]
        if all(_is_far(each, robot) for each in row for robot in stand):
            found += [Bystander(each) for each in row]
    return found


def _is_hallway(floor: Floor, a: str, b: str) -> bool:
    ends = floor.places[a], floor.places[b]
    if any(each.kind is not PlaceKind.WAYPOINT for each in ends):
        return False
    return math.dist(*((each.x, each.y) for each in ends)) >= SHORTEST_M


def _row(floor: Floor, a: str, b: str) -> list[Point]:
    """Where people stand from wall to wall; nowhere where the walls are too far apart."""
    (x0, y0), (x1, y1) = ((floor.places[each].x, floor.places[each].y) for each in (a, b))
    away_m = math.dist((x0, y0), (x1, y1))
    across = (y0 - y1) / away_m, (x1 - x0) / away_m
    middle = (x0 + x1) / 2, (y0 + y1) / 2
    sides = [list(_to_wall(floor, middle, across, sign)) for sign in (-1, 1)]
    if any(RADIUS_M * 2 * len(each) > _WIDEST_M / 2 for each in sides):
        return []
    return [middle, *sides[0], *sides[1]]


def _to_wall(floor: Floor, middle: Point, across: Point, sign: int) -> Iterator[Point]:
    """One beside the other as far as there is room; what is left is too narrow for a robot."""
    for number in range(1, math.ceil(_WIDEST_M / RADIUS_M)):
        off_m = sign * number * 2 * RADIUS_M
        at = middle[0] + off_m * across[0], middle[1] + off_m * across[1]
        if distances_m(np.array([at]), floor.wall_segments)[0] < RADIUS_M:
            return
        yield at


def _is_far(one: FloorPose, other: FloorPose) -> bool:
    apart_m = math.hypot(one.x - other.x, one.y - other.y)
    return one.floor != other.floor or apart_m >= _FROM_ROBOTS_M
