"""An object that is seen elsewhere than the service has it: the space there may be another's."""

import math

import numpy as np

from mend.robots.arm.behaviors.work import Work
from mend.robots.execution.monitor import Reaction
from mend.robots.execution.watch import Interruption

_OFF_M = 0.03
"""So far beside the way that an arm has been given its gripper still is where it may be."""


class SeenElsewhere(Interruption):
    """The object is not where the service has it, so that it is to look before this goes on."""

    def __init__(self) -> None:
        super().__init__(Reaction.GO_TO_NEUTRAL, "the object is seen elsewhere than it was")


def require_where_it_was(work: Work) -> None:
    """Raises `SeenElsewhere` for an object that is neither where it was nor on its way from there.

    What it has told of once it does not tell again: whoever was told decides how to go on.
    """
    progress, target = work.progress, work.assignment.target
    seen, was_at = progress.seen.sighting, progress.object_at
    if seen is None or was_at is None:
        return
    ends = [was_at] if target is None else [was_at, (target.x, target.y)]
    if _distance_m((seen.x, seen.y), ends[0], ends[-1]) <= _OFF_M:
        return
    told, progress.told_at = progress.told_at, (seen.x, seen.y)
    if told is None or math.dist(told, progress.told_at) > _OFF_M:
        raise SeenElsewhere


def _distance_m(
    point: tuple[float, float], one: tuple[float, float], other: tuple[float, float]
) -> float:
    """How far a point is from the straight line between two others."""
    start, along = np.array(one), np.subtract(other, one)
    length_2 = float(along @ along)
    share = 0.0 if length_2 == 0.0 else float((np.array(point) - start) @ along) / length_2
    return float(np.linalg.norm(np.array(point) - start - min(max(share, 0.0), 1.0) * along))
