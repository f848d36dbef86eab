"""Vector maps as Nav2 has maps: a `map.yaml` beside its picture, every cell free or occupied."""

from math import cos, sin
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.maps.vector_map import VectorMap

_MARGIN_M = 1.0
_OCCUPIED, _FREE = 0, 254


def write_occupancy(
    vector_map: VectorMap,
    folder: Path,
    *,
    resolution_m: float = 0.05,
    noise_m: float = 0.0,
    yaw: float = 0.0,
    seed: int = 1,
) -> Path:
    """Write a map's picture and its `map.yaml`, and return that one's path.

    `noise_m` is how far off (standard deviation) the hits are that mark a wall's cells; `yaw` turns
    the picture in the map's frame (radians).
    """
    hits = _along(vector_map, resolution_m / 4.0)
    hits = hits + np.random.default_rng(seed).normal(0.0, noise_m, hits.shape)
    turned = hits @ np.array([[cos(yaw), -sin(yaw)], [sin(yaw), cos(yaw)]])
    low = turned.min(axis=0) - _MARGIN_M
    width, height = (
        np.ceil((turned.max(axis=0) + _MARGIN_M - low) / resolution_m).astype(int).tolist()
    )
    cells = ((turned - low) / resolution_m).astype(np.int64)
    picture = np.full((height, width), _FREE, dtype=np.uint8)
    picture[height - 1 - cells[:, 1], cells[:, 0]] = _OCCUPIED
    folder.mkdir(parents=True, exist_ok=True)
    cv2.imwrite(str(folder / "map.pgm"), picture)
    x, y = np.array([[cos(yaw), -sin(yaw)], [sin(yaw), cos(yaw)]]) @ low
    path = folder / "map.yaml"
    path.write_text(
        f"image: map.pgm\nmode: trinary\nresolution: {resolution_m}\n"
        f"origin: [{x:.6f}, {y:.6f}, {yaw:.6f}]\n"
        "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n",
        encoding="utf-8",
    )
    return path


def _along(vector_map: VectorMap, every_m: float) -> NDArray[np.float64]:
    """Points along a map's segments."""
    rows = []
    for segment, length in zip(vector_map.segments, vector_map.lengths, strict=True):
        share = np.linspace(0.0, 1.0, int(length / every_m) + 2)[:, None]
        rows.append(segment[:2] * (1.0 - share) + segment[2:] * share)
    return np.vstack(rows)
