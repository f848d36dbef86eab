"""The activation potential of leaves for one agent: the closer its object, the higher."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from mend.tasks.node_table import NO_CODE, NodeTable

Point = tuple[float, float, float]

MIN_DISTANCE_M = 0.05
"""Closer than this counts as this close, so that the potential stays bounded."""


def leaf_potentials(
    nodes: NodeTable,
    leaves: NDArray[np.int64],
    last_seen: Mapping[str, Point],
    agent: Point,
    suitabilities: NDArray[np.float64],
) -> NDArray[np.float64]:
    """How much an agent is drawn to each leaf: suitability / max(d, d_min).

    `d` is the distance in metres from `agent` (its gripper, or a mobile robot) to where the object
    was last seen; both in one frame. An object that was not seen gives 0, a leaf without an object
    its suitability (the published systems use 1/d as well: DummyBehavior, TableObject).
    `suitabilities` are those of the leaves.
    """
    # What was not seen is infinitely far; the last distance is that of leaves without an object.
    distances = np.full(len(nodes.objects) + 1, np.inf)
    distances[NO_CODE] = 1.0
    for name, seen in last_seen.items():
        if (code := nodes.object_code(name)) != NO_CODE:
            distances[code] = max(math.dist(seen, agent), MIN_DISTANCE_M)
    potentials: NDArray[np.float64] = suitabilities / distances[nodes.object_codes[leaves]]
    return potentials
