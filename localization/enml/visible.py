"""What a map shows from anywhere: ray casts on the segments that can matter there."""

import numpy as np

from mend.localization.enml.classification import cast_bearings
from mend.localization.enml.problem import Floats
from mend.localization.pose import Poses

_TILE_M = 8.0
_MARGIN_M = 2
"""Sensors sit this far from their robots' middles at most, and ranges are rounded."""
_MOST_TILES = 500
"""The segments of so many tiles are kept at hand."""


class Visible:
    """Casts rays from many places; each time only on what is within reach of the place's tile."""

    def __init__(self, segments: Floats, max_range_m: float) -> None:
        self._segments = segments
        self._max_range_m = max_range_m
        self._tiles: dict[tuple[int, int, int], Floats] = {}

    @property
    def is_empty(self) -> bool:
        """Whether the map shows nothing at all."""
        return not len(self._segments)

    def cast(self, sensor: Poses, bearings: Floats, reach_m: float) -> Floats:
        """The range along ascending bearings from a sensor's pose."""
        segments = self.segments_around(sensor, reach_m)
        return cast_bearings(segments, sensor, bearings, self.reach_m(reach_m))[0]

    def reach_m(self, wanted_m: float) -> float:
        """As far as wanted, but no farther than any scan says something."""
        return min(self._max_range_m, wanted_m)

    def segments_around(self, place: Poses, reach_m: float) -> Floats:
        """The segments within reach of the tile that a place is in, and a little more."""
        column, row = int(place[0] // _TILE_M), int(place[1] // _TILE_M)
        margin_m = int(self.reach_m(reach_m)) + _MARGIN_M
        key = (column, row, margin_m)
        if key not in self._tiles:
            if len(self._tiles) >= _MOST_TILES:
                self._tiles.clear()
            corner = np.array([column, row]) * _TILE_M
            ends = self._segments.reshape(-1, 2, 2)
            near = (ends.max(axis=1) >= corner - margin_m).all(axis=1) & (
                ends.min(axis=1) <= corner + _TILE_M + margin_m
            ).all(axis=1)
            self._tiles[key] = np.ascontiguousarray(self._segments[near])
        return self._tiles[key]
