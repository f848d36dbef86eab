"""The activation potential of a leaf for one agent: the closer its object, the higher."""

import math
from collections.abc import Mapping

Point = tuple[float, float, float]

MIN_DISTANCE_M = 0.05
"""Closer than this counts as this close, so that the potential stays bounded."""


def leaf_potential(
    object_name: str | None,
    last_seen: Mapping[str, Point],
    agent: Point,
    suitability: float,
) -> float:
    """How much an agent is drawn to a leaf: suitability / max(d, d_min).

    `d` is the distance in metres from `agent` (its gripper, or a mobile robot) to where the object
    was last seen; both in one frame. An object that was not seen gives 0, a leaf without an object
    its suitability (the published systems use 1/d as well: DummyBehavior, TableObject).
    """
    if object_name is None:
        return suitability
    seen = last_seen.get(object_name)
    if seen is None:
        return 0.0
    return suitability / max(math.dist(seen, agent), MIN_DISTANCE_M)
