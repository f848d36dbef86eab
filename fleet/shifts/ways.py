"""What is on the way from place to place of a building, and how much longer it is round that."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import dist, inf

import numpy as np

from mend.maps.building.building import Building, LaneCrossing, PlaceKind
from mend.maps.building.crossing import crossed_by
from mend.maps.building.right_across import right_across
from mend.maps.navigation import NavigationGraph

SPEED_M_S = 1.0
_SHORTEST_M = 2.0
"""Who stands at an end of a lane that is barred in its middle is clear of that."""


@dataclass(frozen=True, slots=True)
class Hindrance:
    """A lane that may be barred on the way; one round it takes `longer_s`, inf without any."""

    between: tuple[str, str]
    is_door: bool
    longer_s: float


class DeliveryWays:
    """The quickest ways between places, `FLOOR/PLACE`, as robots take them."""

    def __init__(self, building: Building) -> None:
        self._building = building
        self._graph = building.graph
        self._seconds = self._graph.shortest(SPEED_M_S)[1]
        self._longer_s: dict[frozenset[str], float] = {}
        self._stops = frozenset(building.of_kind(PlaceKind.ELEVATOR))
        self._lanes = {
            frozenset(f"{each.floor}/{end}" for end in each.lane.between): each
            for each in building.crossings
        }

    def elevators(self, origin: str, destination: str) -> list[str]:
        """The elevators on the way, in their order."""
        return [
            elevator
            for a, b in self._steps(self._graph, origin, destination)
            for elevator, each in self._building.document.elevators.items()
            if {a, b} <= {f"{floor}/{at}" for floor, at in each.stops.items()}
        ]

    def seconds(self, origin: str, destination: str) -> float:
        """How long it takes to drive there; inf where no way leads."""
        ends = self._graph.index(origin), self._graph.index(destination)
        return float(self._seconds[ends])

    def hindrances(self, origin: str, destination: str) -> Iterator[Hindrance]:
        """The lanes on the way that somebody could bar so that no robot gets past."""
        for between in self._steps(self._graph, origin, destination):
            crossing = self._lanes.get(frozenset(between))
            if crossing is not None and self._can_be_barred(crossing, between):
                yield Hindrance(between, bool(crossing.doors), self._round_s(between))

    def _round_s(self, between: tuple[str, str]) -> float:
        """How much longer it takes from end to end of a lane by another way."""
        key = frozenset(between)
        if key not in self._longer_s:
            round_s = _seconds(self._without(between), *between)
            self._longer_s[key] = round_s - self.seconds(*between)
        return self._longer_s[key]

    def _can_be_barred(self, crossing: LaneCrossing, between: tuple[str, str]) -> bool:
        """Not before an elevator: who is in that could not get out."""
        if not self._stops.isdisjoint(between):
            return False
        if crossing.doors:
            return True
        floor = self._building.floors[crossing.floor]
        a, b = (floor.places[each] for each in crossing.lane.between)
        at_walls = right_across(floor, crossing.lane)[1]
        return at_walls and dist((a.x, a.y), (b.x, b.y)) >= _SHORTEST_M

    def _without(self, between: tuple[str, str]) -> NavigationGraph:
        """The ways but those that are barred with a lane."""
        barred = self._barred_with(self._lanes[frozenset(between)]) | {frozenset(between)}
        ways = [each for each in self._graph.ways if frozenset((each.a, each.b)) not in barred]
        return NavigationGraph(self._graph.places, ways)

    def _barred_with(self, barred: LaneCrossing) -> set[frozenset[str]]:
        """The lanes through a door of a lane; of one without doors, those across which lies what
        stands across it from wall to wall."""
        floor = self._building.floors[barred.floor]
        across = right_across(floor, barred.lane)[0]

        def is_barred(lane: LaneCrossing) -> bool:
            if barred.doors:
                return not set(barred.doors).isdisjoint(lane.doors)
            a, b = (floor.places[each] for each in lane.lane.between)
            return len(crossed_by(np.array([a.x, a.y, b.x, b.y]), across)) > 0

        return {
            ends
            for ends, each in self._lanes.items()
            if each.floor == barred.floor and is_barred(each)
        }

    def _steps(
        self, graph: NavigationGraph, origin: str, destination: str
    ) -> Iterator[tuple[str, str]]:
        names = [graph.places[each].name for each, _ in _path(graph, origin, destination)]
        return pairwise(names)


def _path(graph: NavigationGraph, origin: str, destination: str) -> Sequence[tuple[int, float]]:
    return graph.quickest_path(graph.index(origin), graph.index(destination), SPEED_M_S)


def _seconds(graph: NavigationGraph, origin: str, destination: str) -> float:
    path = _path(graph, origin, destination)
    return path[-1][1] if path else inf
