"""Depth as a structured-light camera measures it: noisy, and missing where it cannot be measured.

Nguyen, Izadi & Lovell, "Modeling Kinect Sensor Noise for Improved 3D Reconstruction and
Tracking" (3DIMPVT 2012), section 3: axial and lateral noise by distance and angle of incidence.
"""

import math
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.maps.compiled import compiled

Depth = NDArray[np.float32]

EXPOSURES = 8
"""A camera that stands still fuses at least so many exposures into one picture."""
_SURE_M = 0.0008
"""What a camera that chooses for itself how many exposures it fuses leaves of their noise."""

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
_HEAD_ON_PX = 0.8
"""The lateral noise of a surface that is seen head-on, the sharpest that there is."""


@dataclass(frozen=True, slots=True)
class PinholeOptics:
    """The optics that rays come from."""

    focal_px: float
    center_px: tuple[float, float]


@dataclass(frozen=True, slots=True, eq=False)
class _Measurable:
    """What can be measured of one rendered picture, before any noise is drawn.

    `sigma_m` (h, w): the noise of smooth surfaces, NaN where none is measured. `rows` and `columns`
    are those of edges; `lost` the rows and columns of what may be lost, and how likely each is.
    """

    depth_m: Depth
    bgr: NDArray[np.uint8]
    sigma_m: Depth
    rows: NDArray[np.intp]
    columns: NDArray[np.intp]
    lost: tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.float64]]


class _DrawnAhead:
    """Normal deviates from a generator of their own, drawn by another thread until asked for."""

    _thread = ThreadPoolExecutor(1, "depth-noise")

    def __init__(self, rng: np.random.Generator) -> None:
        self._rng = rng
        self._shape: tuple[int, ...] = ()
        self._drawn: Future[NDArray[np.float32]] | None = None

    def take(self, shape: tuple[int, ...]) -> NDArray[np.float32]:
        """As many as the shape has. What was drawn for another shape is not used."""
        ahead = None if self._drawn is None else self._drawn.result()
        taken = ahead if ahead is not None and shape == self._shape else self._draw(shape)
        self._shape, self._drawn = shape, self._thread.submit(self._draw, shape)
        return taken

    def _draw(self, shape: tuple[int, ...]) -> NDArray[np.float32]:
        return self._rng.standard_normal(shape, dtype=np.float32)


def exposures_from(depth_m: float) -> int:
    """So many exposures that surfaces so far away are measured surely enough to tell low parts."""
    of_one_m = float(_axial_sigma_m(depth_m, 0.0))
    return max(EXPOSURES, math.ceil((of_one_m / _SURE_M) ** 2))


class DepthNoise:
    """The depth noise of one camera, by seed; `scale` 0 is none, 1 as published."""

    def __init__(self, scale: float, rng: np.random.Generator, exposures: int = EXPOSURES) -> None:
        self._scale = scale
        self._rng = rng
        self._exposures = exposures
        self._known: _Measurable | None = None
        self._surfaces, self._edges = (_DrawnAhead(each) for each in rng.spawn(2))
        if scale > 0.0:
            _warm_up()

    def measure(self, depth_m: Depth, bgr: NDArray[np.uint8], optics: PinholeOptics) -> Depth:
        """What the camera gives for a rendered picture: NaN where no depth is measured.

        A picture that comes again is taken for the same one only if it is the same array.
        """
        if self._scale == 0.0:
            return depth_m
        known = self._known
        if known is None or known.depth_m is not depth_m or known.bgr is not bgr:
            known = self._known = self._measurable(depth_m, bgr, optics)
        measured = self._surfaces.take(depth_m.shape)
        measured *= known.sigma_m
        measured += depth_m
        noise = self._edges.take((len(known.rows), 3, self._exposures))
        _fuse_edges(depth_m, known.rows, known.columns, self._scale, noise, measured)
        rows, columns, chance = known.lost
        lost = self._rng.random(len(rows)) < chance
        measured[rows[lost], columns[lost]] = np.nan
        return measured

    def _measurable(
        self, depth_m: Depth, bgr: NDArray[np.uint8], optics: PinholeOptics
    ) -> _Measurable:
        edges, sigma_m = _edges(depth_m), np.empty_like(depth_m)
        lens = np.array([optics.focal_px, *optics.center_px])
        _find_sigma(depth_m, _slope(depth_m), lens, self._scale, self._exposures, sigma_m)
        # As they were compiled for: what NumPy gives lies strided.
        rows, columns = (np.ascontiguousarray(each) for each in np.nonzero(edges))
        lost = _lost(bgr, edges, _LOST_AT_EDGES * min(self._scale, 1.0))
        return _Measurable(depth_m, bgr, sigma_m, rows, columns, lost)


def _lost(
    bgr: NDArray[np.uint8], edges: NDArray[np.bool_], at_edges: float
) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.float64]]:
    """The rows and columns of what may be lost, on dark things and at edges, and how likely."""
    blue, green, red = cv2.split(bgr)
    brightest = np.asarray(cv2.max(cv2.max(blue, green), red))
    rows, columns = np.nonzero((brightest < _BRIGHT) | edges)
    dark = (_BRIGHT - brightest[rows, columns]) / (_BRIGHT - _BLACK)
    return rows, columns, np.maximum(dark, np.where(edges[rows, columns], at_edges, 0.0))


def _slope(depth_m: Depth) -> Depth:
    """How depth changes per pixel, to the right and down (h, w, 2)."""
    right, down = (
        cv2.Sobel(depth_m, cv2.CV_32F, *axes, ksize=3, scale=0.125) for axes in ((1, 0), (0, 1))
    )
    return np.asarray(cv2.merge([right, down]), np.float32)


def _edges(depth_m: Depth) -> NDArray[np.bool_]:
    kernel = np.ones((3, 3), np.uint8)
    near, far = cv2.erode(depth_m, kernel), cv2.dilate(depth_m, kernel)
    bend: NDArray[np.bool_] = np.abs(np.asarray(near) + np.asarray(far) - 2 * depth_m) > _STEP_M
    return bend


def _measuring(function: Callable[..., Any]) -> Any:
    """Compile what every pixel is measured by: others may work meanwhile."""
    return compiled(function, nogil=True)


@_measuring
def _axial_sigma_m(depth_m, angle_rad):  # type: ignore[no-untyped-def]
    """Nguyen et al., equation 4: grows with the distance and towards grazing angles."""
    grazing = (angle_rad / (math.pi / 2 - angle_rad)) ** 2
    return 0.0012 + 0.0019 * (depth_m - 0.4) ** 2 + 0.0001 / math.sqrt(depth_m) * grazing


@_measuring
def _lateral_sigma_px(angle_rad):  # type: ignore[no-untyped-def]
    """Nguyen et al., equation 2."""
    return _HEAD_ON_PX + 0.035 * angle_rad / (math.pi / 2 - angle_rad)


@_measuring
def _incidence_rad(depth_m, right, down, across_px, below_px, focal_px):  # type: ignore[no-untyped-def]
    """The angle between a pixel's ray and the normal of the surface that it hits."""
    ahead = depth_m + across_px * right + below_px * down
    normal = math.sqrt((focal_px * right) ** 2 + (focal_px * down) ** 2 + ahead**2)
    ray = math.sqrt(across_px**2 + below_px**2 + focal_px**2) / focal_px
    return math.acos(min(max(depth_m / (normal * ray), 0.0), 0.9999))


@_measuring
def _find_sigma(depth_m, slope, lens, scale, exposures, sigma_m):  # type: ignore[no-untyped-def]
    """The noise of the mean of all exposures; NaN where it is too steep, near or far.

    On a smooth surface a lateral error reads the depth of a point beside.
    """
    focal_px, center_u, center_v = lens
    rows, columns = depth_m.shape
    for row in range(rows):
        for column in range(columns):
            depth, (right, down) = depth_m[row, column], slope[row, column]
            angle = _incidence_rad(depth, right, down, column - center_u, row - center_v, focal_px)
            if angle > _STEEPEST_RAD or depth < _NEAREST_M or depth > _FARTHEST_M:
                sigma_m[row, column] = np.nan
                continue
            beside_m = math.sqrt(right**2 + down**2) * _lateral_sigma_px(angle)
            squared = (_axial_sigma_m(depth, angle) ** 2 + beside_m**2) / exposures
            sigma_m[row, column] = scale * math.sqrt(squared)


@_measuring
def _fuse_edges(depth_m, rows, columns, scale, noise, measured):  # type: ignore[no-untyped-def]
    """The mean of those exposures that agree with their median: no depth between surfaces.

    At an edge the surface's own angle is unknown.
    """
    height, width = depth_m.shape
    exposures = noise.shape[2]
    read = np.empty(exposures)
    for index in range(len(rows)):
        for each in range(exposures):
            shift_v = int(np.rint(scale * _HEAD_ON_PX * noise[index, 0, each]))
            shift_u = int(np.rint(scale * _HEAD_ON_PX * noise[index, 1, each]))
            row = min(max(rows[index] + shift_v, 0), height - 1)
            hit_m = depth_m[row, min(max(columns[index] + shift_u, 0), width - 1)]
            read[each] = hit_m + scale * _axial_sigma_m(hit_m, 0.0) * noise[index, 2, each]
        at = depth_m[rows[index], columns[index]]
        if at < _NEAREST_M or at > _FARTHEST_M:
            measured[rows[index], columns[index]] = np.nan
        else:
            measured[rows[index], columns[index]] = _agreed_m(read)


@_measuring
def _agreed_m(read_m):  # type: ignore[no-untyped-def]
    for index in range(1, len(read_m)):
        each, before = read_m[index], index - 1
        while before >= 0 and read_m[before] > each:
            read_m[before + 1] = read_m[before]
            before -= 1
        read_m[before + 1] = each
    middle = len(read_m) // 2
    median = read_m[middle] if len(read_m) % 2 else (read_m[middle - 1] + read_m[middle]) / 2
    total, agreeing = 0.0, 0
    for each in read_m:
        if abs(each - median) <= _AGREE_M:
            total += each
            agreeing += 1
    return total / max(agreeing, 1)


def _warm_up() -> None:
    """Compiling amid a run would stop a robot for seconds."""
    depth_m, slope = np.ones((2, 2), np.float32), np.zeros((2, 2, 2), np.float32)
    noise, spot = np.zeros((1, 3, EXPOSURES), np.float32), np.zeros(1, np.intp)
    _find_sigma(depth_m, slope, np.ones(3), 1.0, EXPOSURES, depth_m.copy())
    _fuse_edges(depth_m, spot, spot, 1.0, noise, depth_m.copy())
