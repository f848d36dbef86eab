"""Repair of STL meshes whose stored normals are wrong, which a renderer would draw black."""

import numpy as np
from numpy.typing import NDArray

_HEADER_BYTES = 80
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_MIN_CROSS = 1e-12


def repair_stl(data: bytes) -> bytes:
    """A binary STL with its normals computed from the corners and without empty triangles.

    Raises `ValueError` when `data` is shorter than its own count of triangles says.
    """
    triangles = read_stl(data)
    corners = triangles["corners"].astype(np.float64)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    solid = lengths > _MIN_CROSS
    repaired = triangles[solid].copy()
    repaired["normal"] = normals[solid] / lengths[solid, None]
    count = len(repaired).to_bytes(4, "little")
    return b"".join((bytes(_HEADER_BYTES), count, repaired.tobytes()))


def read_stl(data: bytes) -> NDArray[np.void]:
    """The triangles of a binary STL: records of `normal`, `corners` and `attribute`."""
    count = int.from_bytes(data[_HEADER_BYTES : _HEADER_BYTES + 4], "little")
    return np.frombuffer(data, _TRIANGLE, count, _HEADER_BYTES + 4)
