"""Points of a scan by where they are, and which of them another scan saw, too.

Teschner et al. (2003), "Optimized spatial hashing for collision detection of deformable objects":
the cells of an endless grid share some buckets, so that the points near a place are found in nine.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from mend.localization.enml.problem import Floats, Indices
from mend.localization.points import ScanPoints
from mend.localization.pose import Poses
from mend.maps.compiled import compiled

_BUCKETS = 1024
_X_PRIME, _Y_PRIME = 73856093, 19349663


@dataclass(frozen=True, slots=True, eq=False)
class PointBuckets:
    """The points of a scan, in cells that are as wide as what is looked for may be away (metres).

    The rows of what is in bucket b are `rows[start[b]]` to `rows[start[b + 1]]`.
    """

    cell_m: float
    start: Indices
    rows: Indices
    scan_points: ScanPoints

    @classmethod
    def of(cls, scan_points: ScanPoints, cell_m: float) -> Self:
        """Sorts the points of one scan into cells so wide."""
        return cls(cell_m, *sorted_into_buckets(scan_points.points, cell_m), scan_points)

    def same_surface(
        self, other: ScanPoints, rows: Indices, motion: Poses, cos_max_angle: float
    ) -> tuple[Indices, Indices]:
        """The rows here and in another scan that are the same surface, in the order of the other's.

        Of each of those rows of the other the nearest point here, within a cell's width, if it
        faces nearly the same way. `motion` leads from here to the other.
        """
        mine = self.scan_points
        return same_surface(
            self.start,
            self.rows,
            self.cell_m,
            mine.points,
            mine.normals,
            other.points,
            other.normals,
            rows,
            motion,
            cos_max_angle,
        )


@compiled
def _bucket(column: int, row: int) -> int:
    return int(((column * _X_PRIME) ^ (row * _Y_PRIME)) & (_BUCKETS - 1))


@compiled
def sorted_into_buckets(points: Floats, cell_m: float) -> tuple[Indices, Indices]:
    """Where each bucket starts, and the rows of the points bucket by bucket."""
    count = points.shape[0]
    of_point = np.empty(count, dtype=np.int64)
    start = np.zeros(_BUCKETS + 1, dtype=np.int64)
    for i in range(count):
        bucket = _bucket(int(np.floor(points[i, 0] / cell_m)), int(np.floor(points[i, 1] / cell_m)))
        of_point[i] = bucket
        start[bucket + 1] += 1
    for bucket in range(_BUCKETS):
        start[bucket + 1] += start[bucket]
    rows = np.empty(count, dtype=np.int64)
    filled = start[:-1].copy()
    for i in range(count):
        bucket = of_point[i]
        rows[filled[bucket]] = i
        filled[bucket] += 1
    return start, rows


@compiled
def same_surface(
    start: Indices,
    rows: Indices,
    cell_m: float,
    points: Floats,
    normals: Floats,
    other_points: Floats,
    other_normals: Floats,
    looked_for: Indices,
    motion: Floats,
    cos_max_angle: float,
) -> tuple[Indices, Indices]:
    """The rows of a scan, and of those looked for of another, that lie together and face alike."""
    count = looked_for.shape[0]
    mine, others = np.empty(count, dtype=np.int64), np.empty(count, dtype=np.int64)
    found = 0
    c, s = np.cos(motion[2]), np.sin(motion[2])
    for other in looked_for:
        x = motion[0] + c * other_points[other, 0] - s * other_points[other, 1]
        y = motion[1] + s * other_points[other, 0] + c * other_points[other, 1]
        column, row = int(np.floor(x / cell_m)), int(np.floor(y / cell_m))
        least, nearest = cell_m * cell_m, -1
        for down in range(row - 1, row + 2):
            for along in range(column - 1, column + 2):
                bucket = _bucket(along, down)
                for index in range(start[bucket], start[bucket + 1]):
                    i = rows[index]
                    dx, dy = points[i, 0] - x, points[i, 1] - y
                    away = dx * dx + dy * dy
                    if away < least:
                        least, nearest = away, i
        if nearest < 0:
            continue
        nx = c * other_normals[other, 0] - s * other_normals[other, 1]
        ny = s * other_normals[other, 0] + c * other_normals[other, 1]
        if nx * normals[nearest, 0] + ny * normals[nearest, 1] > cos_max_angle:
            mine[found], others[found] = nearest, other
            found += 1
    return mine[:found], others[:found]
