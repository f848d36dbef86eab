"""Which ways are closed, for who is told that robots get there only while doors are open."""

from collections.abc import Iterator, Mapping
from math import inf

from mend.fleet.scheduling.constraint import WHILE_OPEN
from mend.maps.building.building import Building

_MOST = 5
"""So many are told."""


def with_closed(
    told: str, building: Building, closed_until_s: Mapping[frozenset[str], float]
) -> str:
    """The reason with what was found closed, and which doors have hours, where they are a part."""
    if WHILE_OPEN not in told:
        return told
    closed = _some(_words(building, closed_until_s))
    told += f"; found closed: {closed}" if closed else ""
    return told + (f"; {hours}" if (hours := told_hours(building)) else "")


def told_hours(building: Building) -> str:
    """Which doors of a building have hours, and when they are open; nothing where none has."""
    hours = _some(_hours(building))
    return f"doors with hours: {hours}" if hours else ""


def _some(words: Iterator[str]) -> str:
    each = list(dict.fromkeys(words))
    more = [] if len(each) <= _MOST else [f"{len(each) - _MOST} more"]
    return ", ".join([*each[:_MOST], *more])


def _hours(building: Building) -> Iterator[str]:
    """Each door that is open only at times, with when (s)."""
    for name, floor in building.document.floors.items():
        for door, each in floor.doors.items():
            if each.open_s:
                spans = " and ".join(f"{begin:g} to {end:g} s" for begin, end in each.open_s)
                yield f"{door} on {name} (open {spans})"


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
