"""Which places of a navigation graph can be reached from each other."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from mend.maps.navigation import NavigationGraph


def connected(graph: NavigationGraph) -> NDArray[np.intp]:
    """A number for each place, the same for those that lead to each other and back."""
    count, edges = len(graph.places), []
    for way in graph.ways:
        a, b = graph.index(way.a), graph.index(way.b)
        edges += [(a, b)] if way.one_way else [(a, b), (b, a)]
    rows, columns = zip(*edges, strict=True) if edges else ((), ())
    matrix = csr_matrix((np.ones(len(edges)), (rows, columns)), shape=(count, count))
    return np.asarray(connected_components(matrix, connection="strong")[1], np.intp)
