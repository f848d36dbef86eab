"""How high over the table lies what each pixel of a head picture shows."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.robots.body import CameraImage
from mend.robots.vision.projection import heights
from mend.tasks.scene import Table

Heights = NDArray[np.float32]

_NEAR_TABLE_M = 0.02
_FEWEST_PX = 200
IN_FRONT_M = 10.0
"""The height given to what is known to be in front of everything: the robot's own arm."""


@dataclass(frozen=True, slots=True, eq=False)
class HeightMap:
    """Heights in the base frame, calibrated by the table that the picture shows.

    `height_m` (h, w) is NaN where there is no depth and far above everything where the robot's
    own arm is. `drop_m` (h, w) is how much height a pixel of a vertical side that faces the camera
    spans. `noise_m` is the standard deviation that the table's heights have. `table_px` is
    where the table itself is seen.
    """

    image: CameraImage
    height_m: Heights
    drop_m: Heights
    noise_m: float
    table_px: NDArray[np.bool_]
    table_z: float


def ground_rays(image: CameraImage, every: int = 1) -> NDArray[np.float64]:
    """Each pixel's ray (3, h, w) in the base frame, of length 1 along the optical axis.

    Of `every` so many rows and columns one. Not to be written to: they are kept for the next
    picture of a camera that stands still.
    """
    return _rays(_optics_of(image), every)


@dataclass(frozen=True, slots=True)
class _Optics:
    """What rays depend on: a camera's pose, as bytes, and its lens."""

    pose: bytes
    size: tuple[int, ...]
    center_px: tuple[float, float]
    focal_px: float


def _optics_of(image: CameraImage) -> _Optics:
    pose = np.asarray(image.pose, np.float64).tobytes()
    return _Optics(pose, image.bgr.shape[:2], image.center_px, image.focal_px)


@lru_cache(maxsize=4)
def _rays(optics: _Optics, every: int) -> NDArray[np.float64]:
    rows, columns = optics.size
    across = (np.arange(0, columns, every) - optics.center_px[0]) / optics.focal_px
    down = (np.arange(0, rows, every) - optics.center_px[1]) / optics.focal_px
    turn = np.frombuffer(optics.pose).reshape(4, 4)[:3, :3]
    rays: NDArray[np.float64] = (
        turn[:, 0, None, None] * across[None, None, :]
        + turn[:, 1, None, None] * down[None, :, None]
        + turn[:, 2, None, None]
    )
    rays.flags.writeable = False
    return rays


def measure_heights(
    image: CameraImage,
    table: Table,
    own_arm: Callable[[NDArray[np.float64]], NDArray[np.bool_]] | None = None,
) -> HeightMap | None:
    """Heights over the table's plane as the picture itself shows it; None without depth.

    `own_arm` says of points (n, 3) which are the robot's own.
    """
    if image.depth_m is None:
        return None
    height = heights(image)
    rays = ground_rays(image)
    with np.errstate(invalid="ignore"):
        near = np.abs(height - table.height) < _NEAR_TABLE_M
    x, y = (image.pose[axis, 3] + rays[axis] * image.depth_m for axis in range(2))
    near &= np.abs(x - table.center[0]) < table.size[0] / 2
    near &= np.abs(y - table.center[1]) < table.size[1] / 2
    noise_m = 0.001
    if np.count_nonzero(near) >= _FEWEST_PX:
        correction, noise_m = _fit_plane(x[near], y[near], height[near] - table.height)
        height = height - (correction[0] + correction[1] * x + correction[2] * y)
    if own_arm is not None:
        _hide_arm(height, x, y, table.height, own_arm)
    return HeightMap(
        image,
        height.astype(np.float32),
        _drop_m(_optics_of(image), table.height),
        noise_m,
        np.asarray(near & (np.abs(height - table.height) < 3 * noise_m + 1e-4)),
        table.height,
    )


@lru_cache(maxsize=4)
def _drop_m(optics: _Optics, table_z: float) -> Heights:
    rays = _rays(optics, 1)
    eye_z = np.frombuffer(optics.pose).reshape(4, 4)[2, 3]
    depth_m = (table_z - eye_z) / rays[2]
    level = np.maximum(np.hypot(rays[0], rays[1]), 0.1)
    drop_m = np.asarray(depth_m / optics.focal_px / level, np.float32)
    drop_m.flags.writeable = False
    return drop_m


def _fit_plane(
    x: NDArray[np.float64], y: NDArray[np.float64], off_m: NDArray[np.float64]
) -> tuple[NDArray[np.float64], float]:
    """Coefficients of 1, x, y for how far the table is off, and the noise around that.

    Twice: the second time without what stands out, such as low things on the table.
    """
    step = max(1, len(x) // 20_000)
    terms = np.stack([np.ones(len(x[::step])), x[::step], y[::step]], axis=1)
    off_m = off_m[::step]
    kept = np.abs(off_m - np.median(off_m)) < 0.010
    for _ in range(2):
        found = np.asarray(np.linalg.lstsq(terms[kept], off_m[kept], rcond=None)[0], np.float64)
        rest = off_m - terms @ found
        noise_m = 1.4826 * float(np.median(np.abs(rest[kept])))
        kept = np.abs(rest) < max(3 * noise_m, 1e-4)
    return found, max(noise_m, 1e-5)


def _hide_arm(
    height: NDArray[np.float64],
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    table_z: float,
    own_arm: Callable[[NDArray[np.float64]], NDArray[np.bool_]],
) -> None:
    with np.errstate(invalid="ignore"):
        vs, us = np.nonzero(height > table_z + 0.01)
    points = np.stack([x[vs, us], y[vs, us], height[vs, us]], axis=1)
    is_arm = np.zeros(height.shape, np.uint8)
    is_arm[vs, us] = own_arm(points)
    # The arm's edges have no depth, or one that is not the arm's.
    covered = np.asarray(cv2.dilate(is_arm, np.ones((5, 5), np.uint8))) > 0
    height[covered] = IN_FRONT_M
