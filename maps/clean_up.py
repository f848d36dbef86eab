"""Clean-up of vector maps: duplicates and overlaps become one segment, slivers go."""

from dataclasses import dataclass
from math import radians, sin

import numpy as np
from numpy.typing import NDArray

from mend.maps.vector_map import VectorMap

Matrix = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class CleanUpSettings:
    """What counts as the same line, and what as too short to matter."""

    apart_m: float = 0.02
    """Segments whose ends are this close to another's line may be one with it."""
    gap_m: float = 0.02
    """They are if they overlap, or if no more than this is between them."""
    angle_rad: float = radians(5.0)
    shortest_m: float = 0.05
    """What is left shorter than this goes: no laser tells it from noise."""


def clean_up(vector_map: VectorMap, settings: CleanUpSettings | None = None) -> VectorMap:
    """The map with every wall once; the longest segment of each says where its line is."""
    its = settings or CleanUpSettings()
    order = np.argsort(-vector_map.lengths, kind="stable")
    segments = vector_map.segments[order]
    lengths = vector_map.lengths[order]
    left = lengths > 0.0
    kept: list[Matrix] = []
    for number in range(len(segments)):
        if left[number]:
            left[number] = False
            kept.append(_grown(segments, lengths, left, number, its))
    rows = np.array(kept).reshape(-1, 4)
    long_enough = np.hypot(rows[:, 2] - rows[:, 0], rows[:, 3] - rows[:, 1]) >= its.shortest_m
    return vector_map.with_segments(rows[long_enough])


def _grown(
    segments: Matrix,
    lengths: Matrix,
    left: NDArray[np.bool_],
    number: int,
    its: CleanUpSettings,
) -> Matrix:
    """A segment with all that lie on its line and touch it; those are taken from `left`."""
    start = segments[number, :2]
    along = (segments[number, 2:] - start) / lengths[number]
    others = np.flatnonzero(left)
    ends = segments[others].reshape(-1, 2, 2) - start
    off = ends @ np.array([-along[1], along[0]])
    reach = np.sort(ends @ along, axis=1)
    slant = np.abs(off[:, 0] - off[:, 1])
    on_line = (np.abs(off) <= its.apart_m).all(axis=1)
    # A stub across the line is near it from end to end, yet no part of it.
    on_line &= slant <= np.maximum(sin(its.angle_rad) * lengths[others], 1e-6)
    others, reach = others[on_line], reach[on_line]
    first, last = 0.0, float(lengths[number])
    while True:
        touching = (reach[:, 0] <= last + its.gap_m) & (reach[:, 1] >= first - its.gap_m)
        if not touching.any():
            break
        first = min(first, float(reach[touching, 0].min()))
        last = max(last, float(reach[touching, 1].max()))
        left[others[touching]] = False
        others, reach = others[~touching], reach[~touching]
    return np.concatenate((start + first * along, start + last * along))
