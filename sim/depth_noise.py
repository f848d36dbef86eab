"""Depth as a structured-light camera measures it: noisy, and missing where it cannot be measured.

Nguyen, Izadi & Lovell, "Modeling Kinect Sensor Noise for Improved 3D Reconstruction and
Tracking" (3DIMPVT 2012), section 3: axial and lateral noise by distance and angle of incidence.
"""

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

Depth = NDArray[np.float32]

EXPOSURES = 8
"""A camera that stands still fuses so many exposures into one picture."""

_NEAREST_M, _FARTHEST_M = 0.3, 4.5
_STEEPEST_RAD = math.radians(80.0)
_STEP_M = 0.008
"""Where depth bends by more from pixel to pixel is an edge."""
_LOST_AT_EDGES = 0.5
_BLACK, _BRIGHT = 8.0, 24.0
"""Grey levels of the brightest channel: below the first no depth comes back, above the second
all of it."""
_AGREE_M = 0.010
"""Exposures that are farther from their median have hit another surface."""


@dataclass(frozen=True, slots=True)
class PinholeOptics:
    """The optics that rays come from."""

    focal_px: float
    center_px: tuple[float, float]


class DepthNoise:
    """The depth noise of one camera, by seed; `scale` 0 is none, 1 as published."""

    def __init__(self, scale: float, rng: np.random.Generator, exposures: int = EXPOSURES) -> None:
        self._scale = scale
        self._rng = rng
        self._exposures = exposures

    def measure(self, depth_m: Depth, bgr: NDArray[np.uint8], optics: PinholeOptics) -> Depth:
        """What the camera gives for a rendered picture: NaN where no depth is measured."""
        if self._scale == 0.0:
            return depth_m
        slope = _slope(depth_m)
        angle = _incidence(depth_m, slope, optics)
        axial_m = self._scale * _axial_sigma_m(depth_m, angle)
        lateral_px = self._scale * _lateral_sigma_px(angle)
        measured = self._fuse_smooth(depth_m, np.hypot(*slope), axial_m, lateral_px)
        edges = _edges(depth_m)
        rows, columns = np.nonzero(edges)
        measured[rows, columns] = self._fuse_edges(depth_m, rows, columns)
        measured[self._lost(depth_m, bgr, angle, edges)] = np.nan
        return measured

    def _fuse_smooth(
        self, depth_m: Depth, slope: Depth, axial_m: Depth, lateral_px: Depth
    ) -> Depth:
        """The mean of all exposures, drawn at once.

        On a smooth surface a lateral error reads the depth of a point beside.
        """
        variance = axial_m**2 + (slope * lateral_px) ** 2
        sigma = np.sqrt(variance / np.float32(self._exposures))
        noise = self._rng.standard_normal(depth_m.shape, dtype=np.float32)
        return np.asarray(depth_m + sigma * noise, np.float32)

    def _fuse_edges(
        self, depth_m: Depth, rows: NDArray[np.intp], columns: NDArray[np.intp]
    ) -> Depth:
        """The mean of those exposures that agree with their median: no depth between surfaces."""
        shape = (self._exposures, len(rows))
        # At an edge the surface's own angle is unknown; head-on is the sharpest that there is.
        sigma_px = self._scale * 0.8
        shift_v, shift_u = (
            np.rint(sigma_px * self._rng.standard_normal(shape, dtype=np.float32)).astype(np.intp)
            for _ in range(2)
        )
        height, width = depth_m.shape
        hit = (np.clip(rows + shift_v, 0, height - 1), np.clip(columns + shift_u, 0, width - 1))
        read = depth_m[hit] + _axial_sigma_m(depth_m[hit], np.zeros(1, np.float32)) * (
            self._scale * self._rng.standard_normal(shape, dtype=np.float32)
        )
        agreeing = np.abs(read - np.median(read, axis=0)) <= _AGREE_M
        total = np.where(agreeing, read, 0.0).sum(axis=0)
        fused: Depth = (total / np.maximum(agreeing.sum(axis=0), 1)).astype(np.float32)
        return fused

    def _lost(
        self, depth_m: Depth, bgr: NDArray[np.uint8], angle: Depth, edges: NDArray[np.bool_]
    ) -> NDArray[np.bool_]:
        chance = np.where(edges, np.float32(_LOST_AT_EDGES * min(self._scale, 1.0)), np.float32(0))
        blue, green, red = cv2.split(bgr)
        brightest = np.asarray(cv2.max(cv2.max(blue, green), red), np.float32)
        dark = np.clip((_BRIGHT - brightest) / (_BRIGHT - _BLACK), 0.0, 1.0)
        lost = self._rng.random(depth_m.shape, dtype=np.float32) < np.maximum(chance, dark)
        steep = (angle > _STEEPEST_RAD) & ~edges
        out_of_range = (depth_m < _NEAREST_M) | (depth_m > _FARTHEST_M)
        found: NDArray[np.bool_] = lost | steep | out_of_range
        return found


def _axial_sigma_m(depth_m: Depth, angle: Depth) -> Depth:
    """Nguyen et al., equation 4: grows with the distance and towards grazing angles."""
    grazing = angle**2 / np.square(np.float32(math.pi / 2) - angle)
    sigma: Depth = (
        np.float32(0.0012)
        + np.float32(0.0019) * np.square(depth_m - np.float32(0.4))
        + np.float32(0.0001) / np.sqrt(depth_m) * grazing
    )
    return sigma


def _lateral_sigma_px(angle: Depth) -> Depth:
    """Nguyen et al., equation 2."""
    sigma: Depth = np.float32(0.8) + np.float32(0.035) * angle / (np.float32(math.pi / 2) - angle)
    return sigma


def _slope(depth_m: Depth) -> tuple[Depth, Depth]:
    """How depth changes per pixel, to the right and down."""
    right, down = (
        np.asarray(cv2.Sobel(depth_m, cv2.CV_32F, *axes, ksize=3, scale=0.125), np.float32)
        for axes in ((1, 0), (0, 1))
    )
    return right, down


def _incidence(depth_m: Depth, slope: tuple[Depth, Depth], optics: PinholeOptics) -> Depth:
    """The angle between each pixel's ray and the normal of the surface that it hits."""
    rows, columns = depth_m.shape
    across = (np.arange(columns, dtype=np.float32) - np.float32(optics.center_px[0]))[None, :]
    down = (np.arange(rows, dtype=np.float32) - np.float32(optics.center_px[1]))[:, None]
    focal = np.float32(optics.focal_px)
    ray = np.sqrt(across**2 + down**2 + focal**2) / focal
    ahead = depth_m + across * slope[0] + down * slope[1]
    normal = np.sqrt((focal * slope[0]) ** 2 + (focal * slope[1]) ** 2 + ahead**2)
    angle: Depth = np.arccos(np.clip(depth_m / (normal * ray), 0.0, np.float32(0.9999)))
    return angle


def _edges(depth_m: Depth) -> NDArray[np.bool_]:
    kernel = np.ones((3, 3), np.uint8)
    near, far = cv2.erode(depth_m, kernel), cv2.dilate(depth_m, kernel)
    bend: NDArray[np.bool_] = np.abs(np.asarray(near) + np.asarray(far) - 2 * depth_m) > _STEP_M
    return bend
