"""Which places of a navigation graph can be reached from each other."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from mend.maps.navigation import NavigationGraph, Way, WayKind

Labels = NDArray[np.intp]


def connected(graph: NavigationGraph) -> Labels:
    """A number for each place, the same for those that lead to each other and back."""
    return _labelled(graph, graph.ways)


def usable(graph: NavigationGraph) -> NDArray[np.bool_]:
    """Which places lead to most others and back, by nothing but lanes on a floor of their own.

    Robots do not drive through cabins, and ride to other floors only; where elevators stop they
    come by riding, too.
    """
    labels = connected(graph)
    in_most = np.asarray(labels == np.bincount(labels).argmax())
    rides = [way for way in graph.ways if way.kind is WayKind.ELEVATOR]
    stops = {end for way in rides for end in (way.a, way.b)}
    on_floors = _labelled(graph, [way for way in graph.ways if not {way.a, way.b} & stops])
    is_place = np.array([place.name not in stops for place in graph.places], np.bool_) & in_most
    floors = np.array([place.floor for place in graph.places], np.intp)
    for floor in np.unique(floors[is_place]):
        here = is_place & (floors == floor)
        in_most &= ~(here & (on_floors != np.bincount(on_floors[here]).argmax()))
    return in_most


def _labelled(graph: NavigationGraph, ways: Iterable[Way]) -> Labels:
    count, edges = len(graph.places), list[tuple[int, int]]()
    for way in ways:
        a, b = graph.index(way.a), graph.index(way.b)
        edges += [(a, b)] if way.one_way else [(a, b), (b, a)]
    rows, columns = zip(*edges, strict=True) if edges else ((), ())
    matrix = csr_matrix((np.ones(len(edges)), (rows, columns)), shape=(count, count))
    return np.asarray(connected_components(matrix, connection="strong")[1], np.intp)
