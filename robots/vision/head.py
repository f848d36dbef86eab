"""The head camera: where an object is, from one RGB-D picture."""

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from robots.body import CameraImage
from robots.catalogue import Part
from robots.grasp import half_turn
from robots.link.messages import Sighting
from robots.vision.blob import Blob, find_blob
from robots.vision.color_model import Segmentation
from robots.vision.projection import Points, unproject

_LAYER_M = 0.004
"""Thickness of the layers in which the top surface is looked for."""
_TOP_SHARE = 0.35
"""The top surface is the highest layer with this share of the fullest layer's points."""
_TOP_TOLERANCE_M = 0.005
_FEWEST_POINTS = 12
_TOPPLED_M = 0.012
_COMPLETE_SHARE = 0.8
"""A part is seen whole if each extent of its top is at least this share of what it should be."""


@dataclass(frozen=True, slots=True, eq=False)
class HeadSighting:
    """An object in the head picture, in the base frame.

    (x, y, z) is the bottom centre, `yaw` of the part's own x axis (in [-pi/2, pi/2): parts look
    the same after half a turn), `top_z` the height of its top surface. `complete` is False when
    part of the top is hidden or outside the picture: then the centre is that of what is seen.
    """

    x: float
    y: float
    z: float
    yaw: float
    top_z: float
    complete: bool
    blob: Blob
    time: float

    def upright(self, table_z: float) -> bool:
        """Whether it can stand as it was built: a toppled part's top is too low for that."""
        return self.z >= table_z - _TOPPLED_M

    def to_message(self, part: Part) -> Sighting:
        """As the robot protocol tells it: with the yaw of the long axis."""
        turn = math.pi / 2 if part.size[1] > part.size[0] else 0.0
        yaw = half_turn(self.yaw + turn)
        return Sighting(x=self.x, y=self.y, z=self.z, yaw=yaw, time=self.time)


def locate(image: CameraImage, segmentation: Segmentation, part: Part) -> HeadSighting | None:
    """Find a part in a head picture; None if it is not seen.

    Raises `ColorModelError` for a part whose colours the model does not know.
    """
    mask = segmentation.mask(part.name)
    blob = find_blob(mask)
    if blob is None or image.depth_m is None:
        return None
    # Closing fills gaps with pixels of other things; only those of the right colour are measured.
    vs, us = np.nonzero(cv2.bitwise_and(blob.mask, mask))
    points = unproject(image, us, vs)
    top = _top_surface(points, image.pose[:3, 3])
    if top is None:
        return None
    top_z, surface = top
    center, yaw, extents = _measure_rectangle(surface, top_z, part, image)
    complete = bool(
        extents[0] >= _COMPLETE_SHARE * part.size[0]
        and extents[1] >= _COMPLETE_SHARE * part.size[1]
    )
    return HeadSighting(
        x=center[0],
        y=center[1],
        z=top_z - part.size[2],
        yaw=yaw,
        top_z=top_z,
        complete=complete,
        blob=blob,
        time=image.time,
    )


def _top_surface(
    points: Points, eye: NDArray[np.float64]
) -> tuple[float, NDArray[np.float64]] | None:
    """The height of the top surface and the (n, 2) points at which `eye` sees it.

    A horizontal surface gathers its points in one layer, a side spreads them over many; a knob
    on a plate is too small to be taken for the top.
    """
    if len(points) < _FEWEST_POINTS:
        return None
    heights = points[:, 2]
    layers = np.floor(heights / _LAYER_M).astype(np.intp)
    counts = np.bincount(layers - layers.min())
    # A surface on the border of two layers counts as one.
    paired = counts + np.append(counts[1:], 0)
    highest = int(np.flatnonzero(paired >= _TOP_SHARE * paired.max())[-1])
    middle = (highest + 1 + layers.min()) * _LAYER_M
    near = np.abs(heights - middle) <= _LAYER_M * 1.5
    if np.count_nonzero(near) < _FEWEST_POINTS:
        return None
    top_z = float(np.median(heights[near]))
    chosen = points[np.abs(heights - top_z) <= _TOP_TOLERANCE_M]
    share = (top_z - eye[2]) / (chosen[:, 2] - eye[2])
    return top_z, eye[:2] + (chosen[:, :2] - eye[:2]) * share[:, None]


def _measure_rectangle(
    surface: NDArray[np.float64], top_z: float, part: Part, image: CameraImage
) -> tuple[tuple[float, float], float, tuple[float, float]]:
    """Centre, yaw of the part's x axis and extents along its x and y of a seen rectangle."""
    origin = surface.mean(axis=0)
    # Millimetres keep the single precision of OpenCV's rectangle harmless.
    _, (first, second), angle_deg = cv2.minAreaRect(((surface - origin) * 1e3).astype(np.float32))
    x_is_longer = part.size[0] >= part.size[1]
    turn = 0.0 if (first >= second) == x_is_longer else math.pi / 2
    yaw = half_turn(math.radians(angle_deg) + turn)
    if math.isclose(part.size[0], part.size[1], rel_tol=0.1):
        yaw = (yaw + math.pi / 4) % (math.pi / 2) - math.pi / 4
    axes = np.array([[math.cos(yaw), math.sin(yaw)], [-math.sin(yaw), math.cos(yaw)]])
    local = (surface - origin) @ axes.T
    to_eye = image.pose[:3, 3] - np.append(origin, top_z)
    pixel_m = float(np.linalg.norm(to_eye)) / image.focal_px
    low_x, high_x = _edges(local[:, 0], local[:, 1], pixel_m)
    low_y, high_y = _edges(local[:, 1], local[:, 0], pixel_m)
    # The upper rim of the sides that face the camera is within the tolerance, and so is taken for
    # top: it makes the rectangle longer by this much towards the camera.
    rim = to_eye[:2] * (_TOP_TOLERANCE_M / to_eye[2])
    middle = np.array([low_x + high_x, low_y + high_y]) / 2 @ axes + origin - rim / 2
    extents = np.array([high_x - low_x, high_y - low_y]) + pixel_m - np.abs(axes @ rim)
    return (float(middle[0]), float(middle[1])), yaw, (float(extents[0]), float(extents[1]))


def _edges(
    along: NDArray[np.float64], across: NDArray[np.float64], row_m: float
) -> tuple[float, float]:
    """Where a surface begins and ends: the medians over its rows, finer than one pixel."""
    rows = np.floor((across - across.min()) / row_m).astype(np.intp)
    count = int(rows.max()) + 1
    low, high = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(low, rows, along)
    np.maximum.at(high, rows, along)
    full = np.bincount(rows, minlength=count) >= max(2, np.median(np.bincount(rows)) / 2)
    return float(_trimmed_mean(low[full])), float(_trimmed_mean(high[full]))


def _trimmed_mean(values: NDArray[np.float64]) -> np.float64:
    """The mean without the outer eighths: averages the pixel grid out, ignores stray pixels."""
    ordered = np.sort(values)
    cut = len(ordered) // 8
    mean: np.float64 = ordered[cut : len(ordered) - cut].mean()
    return mean
