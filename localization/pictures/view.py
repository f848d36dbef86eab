"""Which part of the map's frame a picture shows, and where a place of it is in the picture."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.maps.vector_map import VectorMap

Matrix = NDArray[np.float64]

_MARGIN_M = 1.0
LEGEND_PX = 28


@dataclass(frozen=True, slots=True)
class MapView:
    """A rectangle of the map's frame in metres, drawn with `scale` pixels per metre."""

    x_min: float
    y_max: float
    scale: float
    width_px: int
    height_px: int

    def pixels(self, places: Matrix) -> Matrix:
        """Places (..., 2) in metres as x, y in pixels; y grows downwards."""
        return np.stack(
            (
                (places[..., 0] - self.x_min) * self.scale,
                (self.y_max - places[..., 1]) * self.scale + LEGEND_PX,
            ),
            axis=-1,
        )


def view_of(places: Matrix, longest_px: int) -> MapView:
    """A view of all places (n, 2) in metres, with a margin; even sizes, as videos need them."""
    finite = places[np.isfinite(places).all(axis=1)]
    if not len(finite):
        finite = np.zeros((1, 2))
    low, high = finite.min(axis=0) - _MARGIN_M, finite.max(axis=0) + _MARGIN_M
    scale = longest_px / float((high - low).max())
    width, height = ((high - low) * scale).astype(int)
    return MapView(
        float(low[0]),
        float(high[1]),
        scale,
        max(int(width), 480) // 2 * 2,
        (int(height) + LEGEND_PX) // 2 * 2,
    )


def ends_of(vector_map: VectorMap) -> Matrix:
    """The ends (n, 2, 2) of a map's segments."""
    return vector_map.segments.reshape(-1, 2, 2)
