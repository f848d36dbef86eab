"""Drawn buildings in which the quickest way to a room is blocked, and another one leads round."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from mend.maps.building.building import Building, PlaceKind
from mend.maps.building.random_building import random_building
from mend.maps.navigation import NavigationGraph
from mend.sim.building.gatherings import blocked_lanes
from mend.sim.building.scene import scene_of
from mend.tasks.scene import Scene

ROOMS = 26
SHARE = 0.06
SPEED_M_S = 1.0
FIRST = {1: 26, 2: 89}
"""Of how many robots none is found before: to draw all of them takes long."""

Lane = frozenset[str]


@dataclass(frozen=True)
class BlockedRing:
    """A scene of some robots; people block `lane` on the way of each from where it begins to a room
    of its own."""

    scene: Scene
    seed: int
    lane: Lane
    rooms: tuple[str, ...]

    @property
    def options(self) -> dict[str, float | str]:
        """Those of its world: nothing else is in anybody's way."""
        exact: dict[str, float | str] = {"localizer": "exact", "unmapped": 0.0, "shut_doors": 0.0}
        return {**exact, "blocked_hallways": SHARE}


def blocked_ring(robots: int, longer_s: float) -> BlockedRing:
    """The first one in which ways round are free, and from there longer by that at most."""
    seeds = range(FIRST[robots], 500)
    return next(found for seed in seeds for found in _in(seed, robots, longer_s))


def _in(seed: int, robots: int, longer_s: float) -> Iterator[BlockedRing]:
    building = Building(random_building(seed, 1, ROOMS))
    scene = scene_of(building, "ring", robots)
    shut = [frozenset(each) for each in blocked_lanes(building, SHARE, seed)]
    starts = [_nearest(building, each.x, each.y) for each in scene.robots.values()]
    for lane in shut:
        rooms: list[str] = []
        for start in starts:
            found = _rooms(building, start, lane, shut, longer_s)
            rooms += [each for each in found if each not in rooms][:1]
        if len(rooms) == robots:
            yield BlockedRing(scene, seed, lane, tuple(rooms))


def _nearest(building: Building, x: float, y: float) -> str:
    return min(building.graph.places, key=lambda each: math.dist((each.x_m, each.y_m), (x, y))).name


def _rooms(
    building: Building, start: str, lane: Lane, shut: list[Lane], longer_s: float
) -> list[str]:
    """Those, the nearest first, to which the way leads by a lane and no other that is shut."""
    graph = building.graph
    ways = [way for way in graph.ways if frozenset((way.a, way.b)) not in shut]
    without = NavigationGraph(graph.places, ways)
    found = []
    for room in building.of_kind(PlaceKind.ROOM):
        way, takes_s = _way(graph, start, room)
        if [each for each in way if each in shut] != [lane]:
            continue
        # A robot finds it there, and goes back from there.
        first, second = lane
        there = first if second in set().union(*way[way.index(lane) + 1 :]) else second
        _, left_s = _way(graph, there, room)
        round_, round_s = _way(without, there, room)
        if round_ and round_s - left_s < longer_s:
            found.append((takes_s, room))
    return [room for _, room in sorted(found)]


def _way(graph: NavigationGraph, start: str, room: str) -> tuple[list[Lane], float]:
    path = graph.quickest_path(graph.index(start), graph.index(room), SPEED_M_S)
    names = [graph.places[each].name for each, _ in path]
    return [frozenset(pair) for pair in pairwise(names)], path[-1][1] if path else 0.0
