"""What the pixels around a level surface say about where it ends.

Pixels behind something nearer say nothing.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.robots.body import CameraImage
from mend.robots.vision.level_rectangle import Rectangle
from mend.robots.vision.level_surfaces import Pixels, Surface, Surfaces
from mend.robots.vision.projection import pixel_area_m2, project

Bits = NDArray[np.bool_]
_Patch = tuple[slice, slice]

_AROUND_PX = 5
_DEEP = np.ones((25, 25), np.uint8)
_SPLINTER = 0.3
"""What is as high as a surface and smaller than this share of it may be a splinter of its rim."""
_SAME_HUE = 0.25
"""A surface in another shade has all channels changed by the same factor, so far."""
_BESIDE = np.ones((7, 7), np.uint8)
"""So many pixels around where a plate may be still tell of its rim."""


@dataclass(frozen=True, slots=True, eq=False)
class Evidence:
    """What the pixels around a surface say, on the plane at its height.

    `points` (n, 2); `inside` 1 where the pixel shows the surface, else 0; `telling` where it says
    whether it does; `measured` where it has a depth, so that more than its colour says where it is.
    `rim` (2,): sides that face the camera draw the surface out by this much, as far as they are
    within its height's tolerance. `pixel_m` is what a pixel spans across there, `pixel_m2` the area
    that it covers.
    """

    points: NDArray[np.float64]
    inside: NDArray[np.float64]
    telling: Bits
    measured: Bits
    rim: NDArray[np.float64]
    pixel_m: float
    pixel_m2: float


def gather(surface: Surface, surfaces: Surfaces) -> Evidence:
    """The evidence for one surface."""
    patch = _patch(surface.us, surface.vs)
    labels = surfaces.labels[patch]
    near = set(np.unique(labels).tolist())
    own = [
        each.label
        for each in surfaces.all
        if each.label in near and _is_splinter(each, surface, surfaces)
    ]
    inside = labels == surface.label
    other = (labels > 0) & ~inside & ~np.isin(labels, own)
    return _weigh(surfaces, patch, inside, other, surface.top_z, surface.color)


def may_tell_of(other: Surface, surface: Surface) -> bool:
    """Whether anything of another surface lies where the evidence for a surface is gathered."""
    rows, columns = _patch(surface.us, surface.vs)
    beside = (rows.start <= other.vs) & (other.vs < rows.stop)
    return bool((beside & (columns.start <= other.us) & (other.us < columns.stop)).any())


def gather_under(
    knob: Surface, top_z: float, outlines: Sequence[Rectangle], surfaces: Surfaces
) -> Evidence:
    """The evidence for a plate of a knob's colour under it, its top at `top_z`.

    `outlines` are where the plate may be: what is farther away says nothing. A rim that is too
    narrow to be a surface counts too, pixel by pixel.
    """
    image, tolerance = surfaces.heights.image, surfaces.tolerance_m
    corners = [np.column_stack([each.corners(), np.full(4, top_z)]) for each in outlines]
    drawn = [np.rint(project(image, each)).astype(np.int32) for each in corners]
    rows, columns = surfaces.labels.shape
    us, vs = np.concatenate(drawn).T
    patch = _patch(np.clip(us, 0, columns - 1), np.clip(vs, 0, rows - 1))
    near = np.zeros(surfaces.labels[patch].shape, np.uint8)
    for each in drawn:
        cv2.fillConvexPoly(near, each - (patch[1].start, patch[0].start), 1)
    near = np.asarray(cv2.dilate(near, _BESIDE), np.uint8)
    height, labels = surfaces.heights.height_m[patch], surfaces.labels[patch]
    alike = np.abs(image.bgr[patch] - knob.color).max(axis=2) <= surfaces.alike
    with np.errstate(invalid="ignore"):
        level = np.abs(height - top_z) <= tolerance
    of_plate = [
        each.label
        for each in surfaces.all
        if abs(each.top_z - top_z) <= tolerance
        and np.abs(each.color - knob.color).max() <= surfaces.alike
    ]
    inside = np.isin(labels, of_plate) | ((labels == 0) & level & alike)
    other = (labels > 0) & ~inside
    beside = near > 0
    return _weigh(surfaces, patch, inside & beside, other, top_z, knob.color, beside)


def _patch(us: Pixels, vs: Pixels) -> _Patch:
    """The rows and columns that hold some pixels and what is around them."""
    rows = slice(max(int(vs.min()) - _AROUND_PX, 0), int(vs.max()) + _AROUND_PX + 1)
    return rows, slice(max(int(us.min()) - _AROUND_PX, 0), int(us.max()) + _AROUND_PX + 1)


def _weigh(
    surfaces: Surfaces,
    patch: _Patch,
    inside: Bits,
    other: Bits,
    top_z: float,
    color: NDArray[np.float64],
    near: Bits | None = None,
) -> Evidence:
    """Which pixels of a patch say that the surface `inside` is there, or that it is not."""
    seen = surfaces.heights
    image, height = seen.image, seen.height_m[patch]
    with np.errstate(invalid="ignore"):
        low = height < top_z - surfaces.tolerance_m
        in_front = height > top_z + surfaces.tolerance_m
    # Without depth only the table's own colour says that nothing is in front.
    off = np.abs(image.bgr[patch].astype(np.float64) - surfaces.table_color).max(axis=2)
    distinct = np.abs(color - surfaces.table_color).max() > 2 * surfaces.alike
    table = np.isnan(height) & (off < surfaces.alike) & distinct & ~inside
    telling = (inside | low | other | table) & ~in_front
    # Deep inside nothing changes, however the rectangle is moved to fit.
    telling &= np.asarray(cv2.erode(inside.astype(np.uint8), _DEEP)) == 0
    if near is not None:
        telling &= near
    rows, columns = patch[0].start, patch[1].start
    vs, us = np.mgrid[rows : rows + height.shape[0], columns : columns + height.shape[1]]
    points = _on_plane(image, us.ravel(), vs.ravel(), top_z)
    middle = points[inside.ravel()].mean(axis=0) if inside.any() else points.mean(axis=0)
    to_eye = image.pose[:3, 3] - np.append(middle, top_z)
    tolerance = min(surfaces.tolerance_m, top_z - seen.table_z)
    return Evidence(
        points,
        inside.ravel().astype(np.float64),
        telling.ravel(),
        ~np.isnan(height).ravel(),
        to_eye[:2] * (tolerance / to_eye[2]),
        float(np.linalg.norm(to_eye)) / image.focal_px,
        pixel_area_m2(image, (float(middle[0]), float(middle[1]), top_z)),
    )


def _is_splinter(other: Surface, surface: Surface, surfaces: Surfaces) -> bool:
    """Whether what is as high as a surface may be a piece of its rim, or of its side just below.

    Such a piece is small, or smaller and of the same hue in another shade.
    """
    if other is surface or abs(other.top_z - surface.top_z) > surfaces.tolerance_m:
        return False
    shades = (other.color + 1.0) / (surface.color + 1.0)
    same_hue = np.ptp(shades) < _SAME_HUE * shades.mean()
    return bool(other.core_px < (1.0 if same_hue else _SPLINTER) * surface.core_px)


def _on_plane(
    image: CameraImage, us: NDArray[np.intp], vs: NDArray[np.intp], z: float
) -> NDArray[np.float64]:
    """Where pixels' rays meet the level plane at `z`, (n, 2)."""
    across = (us - image.center_px[0]) / image.focal_px
    down = (vs - image.center_px[1]) / image.focal_px
    turn = image.pose[:3, :3]
    rays = [turn[axis, 0] * across + turn[axis, 1] * down + turn[axis, 2] for axis in range(3)]
    depth = (z - image.pose[2, 3]) / rays[2]
    return np.stack([image.pose[axis, 3] + rays[axis] * depth for axis in range(2)], axis=1)
