"""A software camera: draws shaded triangle meshes into colour, depth and object-id images.

Pictures follow `mend.robots.body.CameraImage`: the pixel at column u and row v is sampled at
exactly (u, v), so the image spans [-0.5, width - 0.5] and the default optical centre is
((width - 1) / 2, (height - 1) / 2).
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mend.maps.compiled import compiled
from mend.robots.body import Matrix4

Triangles = NDArray[np.float64]
"""Corners of triangles, shape (n, 3, 3), counter-clockwise seen from outside."""


@dataclass(frozen=True, slots=True)
class Mesh:
    """A rigid, closed surface of one colour; `color` is RGB in [0, 1]."""

    triangles: Triangles
    color: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Light:
    """Light from far away: `direction` points towards it, in the base frame.

    A face shows its colour times `ambient` + `diffuse` * cos(angle to the light).
    """

    direction: tuple[float, float, float] = (0.3, -0.2, 1.0)
    ambient: float = 0.55
    diffuse: float = 0.45


@dataclass(frozen=True, slots=True)
class RenderedImage:
    """`bgr` (h, w, 3) uint8, `depth_m` (h, w) float32 along the optical axis, `ids` (h, w) int32.

    `ids` are indices of meshes; where nothing is, the id is -1 and the depth `far_m`.
    """

    bgr: NDArray[np.uint8]
    depth_m: NDArray[np.float32]
    ids: NDArray[np.int32]


def box_triangles(size: Sequence[float], center: Sequence[float] = (0.0, 0.0, 0.0)) -> Triangles:
    """The 12 triangles of an upright box with full extents `size`."""
    signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
    corners = signs * np.asarray(size, dtype=float) / 2 + np.asarray(center, dtype=float)
    faces = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    return np.array(
        [corners[list(corner)] for a, b, c, d in faces for corner in ((a, b, c), (a, c, d))]
    )


class Rasterizer:
    """Draws a fixed set of meshes, each under its own rigid transform."""

    def __init__(self, meshes: Sequence[Mesh]) -> None:
        """Raises `ValueError` when a mesh's triangles do not have the shape (n, 3, 3)."""
        for index, mesh in enumerate(meshes):
            if mesh.triangles.ndim != 3 or mesh.triangles.shape[1:] != (3, 3):
                raise ValueError(
                    f"mesh {index} has triangles of shape {mesh.triangles.shape}, "
                    "expected (n, 3, 3)"
                )
        self._count = len(meshes)
        self._offsets = np.cumsum([0, *(len(mesh.triangles) for mesh in meshes)], dtype=np.int64)
        self._corners = np.ascontiguousarray(
            np.concatenate([np.zeros((0, 3, 3)), *(mesh.triangles for mesh in meshes)])
        )
        self._normals = _unit_normals(self._corners)
        self._spheres = np.array([_bounding_sphere(mesh.triangles) for mesh in meshes]).reshape(
            -1, 4
        )
        self._colors = np.array([mesh.color for mesh in meshes], dtype=float).reshape(-1, 3)
        self._all_visible = np.ones(self._count, dtype=np.bool_)

    def render(
        self,
        transforms: NDArray[np.float64],
        camera_pose: Matrix4,
        size: tuple[int, int],
        focal_px: float,
        center_px: tuple[float, float] | None = None,
        *,
        light: Light = Light(),
        visible: NDArray[np.bool_] | None = None,
        colors: NDArray[np.float64] | None = None,
        background: NDArray[np.uint8] | tuple[int, int, int] = (255, 255, 255),
        near_m: float = 0.02,
        far_m: float = 10.0,
    ) -> RenderedImage:
        """Draw all meshes as a camera with optical frame `camera_pose` sees them.

        `transforms` (n, 4, 4) are the meshes' poses in the base frame, `size` (width, height) in
        pixels, `background` BGR. `visible` (n,) hides meshes and `colors` (n, 3) repaints them.
        """
        if transforms.shape != (self._count, 4, 4):
            raise ValueError(
                f"transforms have shape {transforms.shape}, expected {(self._count, 4, 4)}"
            )
        width, height = size
        center_u, center_v = center_px or ((width - 1) / 2, (height - 1) / 2)
        bgr = np.empty((height, width, 3), dtype=np.uint8)
        bgr[:] = background
        nearness = np.full((height, width), 1.0 / far_m)
        ids = np.full((height, width), -1, dtype=np.int32)
        towards_light = np.array(light.direction) / math.hypot(*light.direction)
        _draw_meshes(
            self._corners,
            self._normals,
            self._offsets,
            self._spheres,
            np.ascontiguousarray(transforms, dtype=np.float64),
            self._all_visible if visible is None else visible,
            self._colors if colors is None else np.ascontiguousarray(colors, dtype=np.float64),
            np.ascontiguousarray(camera_pose, dtype=np.float64),
            float(focal_px),
            float(center_u),
            float(center_v),
            float(near_m),
            towards_light,
            float(light.ambient),
            float(light.diffuse),
            bgr,
            nearness,
            ids,
        )
        return RenderedImage(bgr, (1.0 / nearness).astype(np.float32), ids)


def _unit_normals(corners: Triangles) -> NDArray[np.float64]:
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.ascontiguousarray(normals / np.maximum(lengths, 1e-300))


def _bounding_sphere(triangles: Triangles) -> tuple[float, float, float, float]:
    if not len(triangles):
        return 0.0, 0.0, 0.0, 0.0
    points = triangles.reshape(-1, 3)
    center = (points.min(axis=0) + points.max(axis=0)) / 2
    radius = float(np.linalg.norm(points - center, axis=1).max())
    return float(center[0]), float(center[1]), float(center[2]), radius


def _drawing(function: Callable[..., Any]) -> Any:
    """Compile what draws: others may work meanwhile."""
    return compiled(function, fastmath=True, nogil=True)


@_drawing
def _draw_meshes(  # type: ignore[no-untyped-def]
    corners,
    normals,
    offsets,
    spheres,
    transforms,
    visible,
    colors,
    camera,
    focal,
    center_u,
    center_v,
    near,
    light,
    ambient,
    diffuse,
    bgr,
    nearness,
    ids,
):
    height, width = nearness.shape
    left, right = center_u + 0.5, width - 0.5 - center_u
    top, bottom = center_v + 0.5, height - 0.5 - center_v
    rotation = np.empty((3, 3))
    shift = np.empty(3)
    polygon = np.empty((4, 3))
    triangle = np.empty((3, 3))
    for mesh in range(transforms.shape[0]):
        if not visible[mesh]:
            continue
        pose = transforms[mesh]
        for row in range(3):
            shift[row] = 0.0
            for k in range(3):
                shift[row] += camera[k, row] * (pose[k, 3] - camera[k, 3])
            for column in range(3):
                rotation[row, column] = (
                    camera[0, row] * pose[0, column]
                    + camera[1, row] * pose[1, column]
                    + camera[2, row] * pose[2, column]
                )
        x, y, z, radius = spheres[mesh]
        sx = rotation[0, 0] * x + rotation[0, 1] * y + rotation[0, 2] * z + shift[0]
        sy = rotation[1, 0] * x + rotation[1, 1] * y + rotation[1, 2] * z + shift[1]
        sz = rotation[2, 0] * x + rotation[2, 1] * y + rotation[2, 2] * z + shift[2]
        if (
            sz + radius < near
            or focal * sx + left * sz < -radius * math.hypot(focal, left)
            or -focal * sx + right * sz < -radius * math.hypot(focal, right)
            or focal * sy + top * sz < -radius * math.hypot(focal, top)
            or -focal * sy + bottom * sz < -radius * math.hypot(focal, bottom)
        ):
            continue
        light_x = pose[0, 0] * light[0] + pose[1, 0] * light[1] + pose[2, 0] * light[2]
        light_y = pose[0, 1] * light[0] + pose[1, 1] * light[1] + pose[2, 1] * light[2]
        light_z = pose[0, 2] * light[0] + pose[1, 2] * light[1] + pose[2, 2] * light[2]
        for face in range(offsets[mesh], offsets[mesh + 1]):
            nx, ny, nz = normals[face]
            facing = 0.0
            for row in range(3):
                for corner in range(3):
                    triangle[corner, row] = (
                        rotation[row, 0] * corners[face, corner, 0]
                        + rotation[row, 1] * corners[face, corner, 1]
                        + rotation[row, 2] * corners[face, corner, 2]
                        + shift[row]
                    )
                facing += triangle[0, row] * (
                    rotation[row, 0] * nx + rotation[row, 1] * ny + rotation[row, 2] * nz
                )
            if facing >= 0.0:
                continue
            count = _clip_near(triangle, near, polygon)
            if count < 3:
                continue
            cosine = max(0.0, nx * light_x + ny * light_y + nz * light_z)
            shade = 255.0 * (ambient + diffuse * cosine)
            red = min(255.0, colors[mesh, 0] * shade)
            green = min(255.0, colors[mesh, 1] * shade)
            blue = min(255.0, colors[mesh, 2] * shade)
            for last in range(2, count):
                _fill(
                    polygon,
                    last,
                    focal,
                    center_u,
                    center_v,
                    blue,
                    green,
                    red,
                    mesh,
                    bgr,
                    nearness,
                    ids,
                )


@_drawing
def _clip_near(triangle, near, polygon):  # type: ignore[no-untyped-def]
    """Cut off what is nearer than the near plane; the number of corners left."""
    count = 0
    for i in range(3):
        j = (i + 1) % 3
        inside = triangle[i, 2] >= near
        if inside:
            for axis in range(3):
                polygon[count, axis] = triangle[i, axis]
            count += 1
        if inside != (triangle[j, 2] >= near):
            part = (near - triangle[i, 2]) / (triangle[j, 2] - triangle[i, 2])
            for axis in range(3):
                polygon[count, axis] = triangle[i, axis] + part * (
                    triangle[j, axis] - triangle[i, axis]
                )
            count += 1
    return count


@_drawing
def _fill(  # type: ignore[no-untyped-def]
    polygon, last, focal, center_u, center_v, blue, green, red, mesh, bgr, nearness, ids
):
    """Fill the triangle of polygon corners 0, last - 1 and last.

    The inverse depth is linear in the image, so that it alone is interpolated and compared.
    """
    height, width = nearness.shape
    n0, n1, n2 = 1.0 / polygon[0, 2], 1.0 / polygon[last - 1, 2], 1.0 / polygon[last, 2]
    u0 = polygon[0, 0] * n0 * focal + center_u
    v0 = polygon[0, 1] * n0 * focal + center_v
    u1 = polygon[last - 1, 0] * n1 * focal + center_u
    v1 = polygon[last - 1, 1] * n1 * focal + center_v
    u2 = polygon[last, 0] * n2 * focal + center_u
    v2 = polygon[last, 1] * n2 * focal + center_v
    area = (u1 - u0) * (v2 - v0) - (u2 - u0) * (v1 - v0)
    if abs(area) < 1e-12:
        return
    first_column = math.ceil(max(0.0, min(u0, u1, u2)))
    last_column = math.floor(min(width - 1.0, max(u0, u1, u2)))
    first_row = math.ceil(max(0.0, min(v0, v1, v2)))
    last_row = math.floor(min(height - 1.0, max(v0, v1, v2)))
    w1_du, w1_dv = (v2 - v0) / area, -(u2 - u0) / area
    w2_du, w2_dv = -(v1 - v0) / area, (u1 - u0) / area
    n_du = w1_du * (n1 - n0) + w2_du * (n2 - n0)
    for v in range(first_row, last_row + 1):
        w1 = (first_column - u0) * w1_du + (v - v0) * w1_dv
        w2 = (first_column - u0) * w2_du + (v - v0) * w2_dv
        n = n0 + w1 * (n1 - n0) + w2 * (n2 - n0)
        for u in range(first_column, last_column + 1):
            # Slightly generous, so that no crack opens between triangles that share an edge.
            if w1 >= -1e-9 and w2 >= -1e-9 and w1 + w2 <= 1.0 + 1e-9 and n > nearness[v, u]:
                nearness[v, u] = n
                bgr[v, u, 0] = np.uint8(blue)
                bgr[v, u, 1] = np.uint8(green)
                bgr[v, u, 2] = np.uint8(red)
                ids[v, u] = mesh
            w1 += w1_du
            w2 += w2_du
            n += n_du
