"""The activation potential of leaves for one agent: the closer its object, the higher."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from mend.tasks.node_table import NO_CODE, NodeTable

Point = tuple[float, float, float]

MIN_DISTANCE_M = 0.05
"""Closer than this counts as this close, so that the potential stays bounded."""
SAME_FLOOR_M = 1.0
CLIMB = 20.0
"""To another floor a robot takes as long for a metre of height as for so many on a floor."""


def leaf_potentials(
    nodes: NodeTable,
    leaves: NDArray[np.int64],
    last_seen: Mapping[str, Point],
    agent: Point,
    suitabilities: NDArray[np.float64],
    places: Mapping[str, Point] | None = None,
) -> NDArray[np.float64]:
    """How much an agent is drawn to each leaf: suitability / max(d, d_min).

    `d` is the distance in metres from `agent` (its gripper, or a mobile robot) to where the object
    was last seen; all in one frame. An object that was not seen gives 0. A leaf without an object
    is as far as its place among `places`, where a floor's height counts `CLIMB` times, and one
    without either gives its suitability (the published systems use 1/d as well: DummyBehavior,
    TableObject). `suitabilities` are those of the leaves.
    """
    # What was not seen is infinitely far.
    seen = np.full(len(nodes.objects) + 1, np.inf)
    for name, point in last_seen.items():
        if (code := nodes.object_code(name)) != NO_CODE:
            seen[code] = max(math.dist(point, agent), MIN_DISTANCE_M)
    there = np.ones(len(nodes.places) + 1)
    for code, name in enumerate(nodes.places):
        if places is not None and (place := places.get(name)) is not None:
            there[code] = max(_way_m(agent, place), MIN_DISTANCE_M)
    objects = nodes.object_codes[leaves]
    distances = np.where(objects != NO_CODE, seen[objects], there[nodes.place_codes[leaves]])
    potentials: NDArray[np.float64] = suitabilities / distances
    return potentials


def _way_m(agent: Point, place: Point) -> float:
    """About how far a robot that drives has to a place."""
    climb_m = abs(place[2] - agent[2])
    if climb_m < SAME_FLOOR_M:
        return math.dist(place, agent)
    return math.dist(place[:2], agent[:2]) + CLIMB * climb_m
