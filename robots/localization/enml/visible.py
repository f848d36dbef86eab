"""What a map shows from anywhere: ray casts on the segments that can matter there."""

import numpy as np

from robots.localization.enml.classification import cast_bearings
from robots.localization.enml.problem import Floats, Indices
from robots.localization.pose import Poses

_TILE_M = 8.0
_MOST_TILES = 500
"""The segments of so many tiles are kept at hand."""


class Visible:
    """Casts rays from many places; each time only on what is within reach of the place's tile."""

    def __init__(self, segments: Floats, max_range_m: float) -> None:
        self._segments = segments
        self._max_range_m = max_range_m
        self._tiles: dict[tuple[int, int, int], Floats] = {}

    def cast(
        self, sensor: Poses, bearings: Floats, reach_m: float
    ) -> tuple[Floats, Indices, Floats]:
        """Range and segment along ascending bearings from a sensor's pose; of which segments."""
        reach_m = min(self._max_range_m, reach_m)
        segments = self._around(sensor, reach_m)
        ranges_m, seen = cast_bearings(segments, sensor, bearings, reach_m)
        return ranges_m, seen, segments

    def _around(self, sensor: Poses, reach_m: float) -> Floats:
        column, row = np.floor(sensor[:2] / _TILE_M).astype(np.int64)
        key = (int(column), int(row), int(np.ceil(reach_m)))
        if key not in self._tiles:
            if len(self._tiles) >= _MOST_TILES:
                self._tiles.clear()
            corner = np.array([column, row]) * _TILE_M
            ends = self._segments.reshape(-1, 2, 2)
            near = (ends.max(axis=1) >= corner - key[2]).all(axis=1) & (
                ends.min(axis=1) <= corner + _TILE_M + key[2]
            ).all(axis=1)
            self._tiles[key] = np.ascontiguousarray(self._segments[near])
        return self._tiles[key]
