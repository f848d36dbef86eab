"""Measuring the top of a part: a rectangle of known height, finer than the pixel grid."""

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from robots.body import CameraImage
from robots.grasp import half_turn

TOP_TOLERANCE_M = 0.005
"""Pixels within this height of the top surface are taken for it."""

_SQUARE = 1.15
"""Up to this ratio of its sides a rectangle's longer axis says nothing about its yaw."""


@dataclass(frozen=True, slots=True)
class Rectangle:
    """A horizontal rectangle in the base frame: `yaw` of its x axis, extents along x and y."""

    center: tuple[float, float]
    yaw: float
    extents: tuple[float, float]


def measure_rectangle(
    image: CameraImage,
    us: NDArray[np.intp],
    vs: NDArray[np.intp],
    top_z: float,
    size: tuple[float, float, float],
) -> Rectangle:
    """Measure the rectangle at height `top_z` that the pixels show.

    Centre and direction are moments of area, to which every pixel of the rim contributes; the
    corners alone would be as coarse as the pixels. `size` tells which side is x.
    """
    us, vs = _fill(us, vs)
    points, weights = _on_plane(image, us, vs, top_z)
    middle = weights @ points / weights.sum()
    offsets = points - middle
    yaw = _yaw(offsets, weights, size)
    # The upper rim of the sides that face the camera is within the tolerance, and so is taken for
    # top: it draws the rectangle out by this much towards the camera.
    to_eye = image.pose[:3, 3] - np.append(_near_side(offsets, middle, image), top_z)
    rim = to_eye[:2] * (min(TOP_TOLERANCE_M, size[2]) / to_eye[2])
    pixel_m = float(np.linalg.norm(to_eye)) / image.focal_px
    local, local_rim = _turned(offsets - rim / 2, yaw), _turned(rim[None], yaw)[0]
    extents = np.ptp(local, axis=0) + pixel_m - np.abs(local_rim)
    cut = _on_border(image, us, vs)
    beyond = _beyond_border(local, np.abs(local_rim) - pixel_m, cut, np.array(size[:2]))
    center = middle - rim / 2 + _turned(beyond[None], -yaw)[0]
    return Rectangle(
        (float(center[0]), float(center[1])), yaw, (float(extents[0]), float(extents[1]))
    )


def _fill(us: NDArray[np.intp], vs: NDArray[np.intp]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Pixels without the holes between them: what stands on a top hides none of its rim."""
    left, top = us.min(), vs.min()
    canvas = np.zeros((int(np.ptp(vs)) + 1, int(np.ptp(us)) + 1), np.uint8)
    canvas[vs - top, us - left] = 1
    outlines, _ = cv2.findContours(canvas, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    cv2.drawContours(canvas, outlines, -1, 1, cv2.FILLED)
    filled_vs, filled_us = np.nonzero(canvas)
    return filled_us + left, filled_vs + top


def _on_border(image: CameraImage, us: NDArray[np.intp], vs: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Which pixels are the picture's last ones, so that what they show may go on beyond."""
    height, width = image.bgr.shape[:2]
    border: NDArray[np.bool_] = (us == 0) | (us == width - 1) | (vs == 0) | (vs == height - 1)
    return border


def _beyond_border(
    local: NDArray[np.float64],
    grown: NDArray[np.float64],
    cut: NDArray[np.bool_],
    size: NDArray[np.float64],
) -> NDArray[np.float64]:
    """How far the true centre is from that of what is seen, if the picture's border cuts it.

    `local` are the points around the centre in the rectangle's frame, `grown` by how much they
    reach over it, both ends together. What is beyond the border is known from the part's size,
    measured from its other end.
    """
    beyond = np.zeros(2)
    if not cut.any():
        return beyond
    for axis in range(2):
        low, high = local[:, axis].min(), local[:, axis].max()
        if size[axis] <= high - low - grown[axis]:
            continue
        end_is_cut = local[cut, axis].mean() > 0
        half = (size[axis] + grown[axis]) / 2
        beyond[axis] = low + half if end_is_cut else high - half
    return beyond


def _on_plane(
    image: CameraImage, us: NDArray[np.intp], vs: NDArray[np.intp], top_z: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Where pixels' rays meet the plane, and the area (up to a factor) that each covers there."""
    cx, cy = image.center_px
    ones = np.ones(len(us))
    rays = np.stack([(us - cx) / image.focal_px, (vs - cy) / image.focal_px, ones], axis=1)
    rays = rays @ image.pose[:3, :3].T
    depths = (top_z - image.pose[2, 3]) / rays[:, 2]
    points: NDArray[np.float64] = image.pose[:2, 3] + rays[:, :2] * depths[:, None]
    return points, depths**3


def _near_side(
    offsets: NDArray[np.float64], middle: NDArray[np.float64], image: CameraImage
) -> NDArray[np.float64]:
    """Where, on the average, the sides are that face the camera."""
    to_eye = image.pose[:2, 3] - middle
    along = to_eye / max(float(np.linalg.norm(to_eye)), 1e-9)
    # Half the extent of something evenly filled is its standard deviation times this.
    near: NDArray[np.float64] = middle + along * float((offsets @ along).std()) * math.sqrt(3)
    return near


def _yaw(
    offsets: NDArray[np.float64],
    weights: NDArray[np.float64],
    size: tuple[float, float, float],
) -> float:
    x_is_longer = size[0] >= size[1]
    if max(size[:2]) <= _SQUARE * min(size[:2]):
        # Millimetres keep the single precision of OpenCV's rectangle harmless.
        _, _, angle_deg = cv2.minAreaRect((offsets * 1e3).astype(np.float32))
        return (math.radians(angle_deg) + math.pi / 4) % (math.pi / 2) - math.pi / 4
    spread = (offsets * weights[:, None]).T @ offsets
    longer = 0.5 * math.atan2(2 * spread[0, 1], spread[0, 0] - spread[1, 1])
    return half_turn(longer if x_is_longer else longer - math.pi / 2)


def _turned(points: NDArray[np.float64], yaw: float) -> NDArray[np.float64]:
    """Points (n, 2) in a frame that is turned by `yaw`."""
    turn = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])
    turned: NDArray[np.float64] = points @ turn
    return turned
