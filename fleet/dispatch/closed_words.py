"""Which ways count as closed, for who is told that robots get there only while doors are open."""

from collections.abc import Iterator, Mapping
from math import inf

from mend.fleet.scheduling.constraint import WHILE_OPEN
from mend.maps.building.building import Building

_MOST = 5
"""So many are told."""


def with_closed(
    told: str, building: Building, closed_until_s: Mapping[frozenset[str], float]
) -> str:
    """The reason with what was found closed, where doors are a part of it."""
    if WHILE_OPEN not in told or not closed_until_s:
        return told
    closed = list(dict.fromkeys(_words(building, closed_until_s)))
    more = [] if len(closed) <= _MOST else [f"{len(closed) - _MOST} more"]
    return f"{told}; found closed: {', '.join([*closed[:_MOST], *more])}"


def _words(building: Building, closed_until_s: Mapping[frozenset[str], float]) -> Iterator[str]:
    """Each way with until when that counts (s); an elevator once."""
    for way, until_s in closed_until_s.items():
        a, b = sorted(way)
        elevator = next((n for n, on in _stops(building).items() if {a, b} <= on), None)
        counts = "" if until_s == inf else f" until {until_s:g} s"
        yield (elevator or f"the way between {a} and {b}") + counts


def _stops(building: Building) -> Mapping[str, set[str]]:
    return {
        name: {f"{floor}/{at}" for floor, at in each.stops.items()}
        for name, each in building.document.elevators.items()
    }
