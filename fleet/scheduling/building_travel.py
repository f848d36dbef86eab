"""From a navigation graph to travel between its places: one epoch per span between two changes."""

from collections.abc import Sequence
from math import inf

import numpy as np

from mend.fleet.scheduling.travel import Epoch, Matrix, Travel, TravelError
from mend.maps.navigation import NavigationGraph

MAX_CHANGES = 48
"""At how many different times doors may open or close: epochs grow with its square."""


def travel_in(
    graph: NavigationGraph,
    speed_m_s: float = 1.0,
    places: Sequence[str] | None = None,
    *,
    starts_s: float = 0.0,
) -> Travel:
    """Travel between some places of a graph, by number in this order; between all if None.

    `starts_s` comes on top of each trip, however long: to speed up, brake and turn.
    Raises `TravelError` where doors change more often than `MAX_CHANGES` times.
    """
    names = [place.name for place in graph.places] if places is None else places
    chosen = np.array([graph.index(name) for name in names], dtype=np.intp)
    grid = np.ix_(chosen, chosen)
    changes_s = [time_s for time_s in graph.changes_s() if 0 < time_s < inf]
    if len(changes_s) > MAX_CHANGES:
        raise TravelError(
            f"doors open or close at {len(changes_s)} different times; {MAX_CHANGES} are possible"
        )
    matrices: dict[frozenset[int], tuple[Matrix, Matrix]] = {}
    epochs = []
    for from_s, until_s, passable in _widest_spans(graph, [0.0, *changes_s, inf]):
        if passable not in matrices:
            distance_m, time_s = graph.shortest(speed_m_s, from_s=from_s, until_s=until_s)
            time_s += starts_s * (1.0 - np.eye(len(time_s)))
            matrices[passable] = (distance_m[grid], time_s[grid])
        epochs.append(Epoch(from_s, until_s, *matrices[passable]))
    if len(epochs) == 1:
        return Travel(epochs[0].distance_m, epochs[0].time_s)
    return Travel.through(epochs)


def _widest_spans(
    graph: NavigationGraph, bounds_s: list[float]
) -> list[tuple[float, float, frozenset[int]]]:
    """Spans between bounds with what is passable throughout; none inside another one like it."""
    widest: list[tuple[float, float, frozenset[int]]] = []
    for first, from_s in enumerate(bounds_s[:-1]):
        for until_s in reversed(bounds_s[first + 1 :]):
            passable = frozenset(
                number for number, way in enumerate(graph.ways) if way.passable(from_s, until_s)
            )
            inside = any(
                begin <= from_s and until_s <= end and ways == passable
                for begin, end, ways in widest
            )
            if not inside:
                widest.append((from_s, until_s, passable))
    return widest
