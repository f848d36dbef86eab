"""Whether a head picture can tell anything of the table at all, and if not, why."""

import math
from collections.abc import Callable

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.robots.body import CameraImage
from mend.robots.vision.height_map import ground_rays, measure_heights
from mend.robots.vision.level_surfaces import find_surfaces
from mend.robots.vision.projection import Points, is_measured
from mend.robots.vision.scene_change import BRIGHTEST, DARKEST
from mend.tasks.scene import Table

_SPARSE = 4
"""Depth is judged in each fourth row and column, colour in means of as many."""
_LEAST_SHARE = 0.5
"""A picture that measures less of the table's part of it tells nothing of the table."""
_NEAREST = 0.5
"""What ends a ray before this share of its way to the table is in front of the camera."""
_LOWEST_M = 0.1
_SIGMAS = 4.0
"""So far from its level a surface's pixels may be taken to be."""
_BLOCK_PX = 32
_SURE_SIGMAS = 6.0
_LEAST_GREY = 1.0
"""Grey levels by which channels may differ by rounding alone."""
_MAD_TO_SIGMA = 1.4826
_MM = 1e3
FROZEN = "my head camera is frozen: it gives again the picture that it gave before"
"""Why a picture that repeats an earlier one tells nothing of now, as a clause."""
_OLDEST_S = 1.0
"""An older picture tells nothing of now."""
_ALL_BUT = 0.01
"""A picture is black, or white, in which no more of the pixels are anything else."""


def why_outdated(image: CameraImage, now_s: float) -> str | None:
    """Why a picture that a camera has just given tells nothing of now; None for a fresh one."""
    age_s = now_s - image.time
    if age_s <= _OLDEST_S:
        return None
    return f"the newest picture of my head camera is {age_s:.0f} s old"


def why_blind(
    image: CameraImage,
    table: Table,
    own_arm: Callable[[Points], NDArray[np.bool_]] | None = None,
) -> str | None:
    """Why a head picture shows no table, as a clause; None for one that does.

    `own_arm` says of points (n, 3) which are the robot's own: what that hides is no blindness, nor
    is what other robots hide.
    """
    scale = 1.0 / _SPARSE
    smooth = cv2.resize(image.bgr, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    blue, green, red = cv2.split(smooth)
    if np.mean(cv2.max(cv2.max(blue, green), red) > DARKEST) < _ALL_BUT:
        return "the picture of my head camera is black"
    if np.mean(cv2.min(cv2.min(blue, green), red) < BRIGHTEST) < _ALL_BUT:
        return "the picture of my head camera is white"
    depth_m = None if image.depth_m is None else image.depth_m[::_SPARSE, ::_SPARSE]
    if depth_m is None or not is_measured(depth_m).any():
        return "my head camera measures no depth"
    share = _share_measured(image, depth_m, table, own_arm)
    if share < _LEAST_SHARE:
        return f"my head camera sees no more than {100 * share:.0f} % of the table"
    return None


def why_rough(image: CameraImage, table: Table, lowest_m: float) -> str | None:
    """Why depth tells no part, none lower than `lowest_m`, from the table, as a clause; or None.

    Two levels are told apart where both keep within so many of their noise's sigmas.
    """
    noise_m = depth_noise_m(image, table)
    if 2 * _SIGMAS * noise_m <= lowest_m:
        return None
    return (
        f"the depth that my head camera measures is off by {_MM * noise_m:.0f} mm, too much to "
        f"tell a part of {_MM * lowest_m:.0f} mm from the table"
    )


def depth_noise_m(image: CameraImage, table: Table) -> float:
    """The standard deviation of the heights that are measured towards the table; 0 without depth.

    By the median of second differences along rows, in which surfaces and all but edges cancel out
    (after Immerkaer 1996, "Fast noise variance estimation").
    """
    if image.depth_m is None:
        return 0.0
    left, middle, right = (image.depth_m[::_SPARSE, start::_SPARSE] for start in range(3))
    columns = right.shape[1]
    left, middle = left[:, :columns], middle[:, :columns]
    down = ground_rays(image, every=_SPARSE)[2, :, :columns]
    _, towards = _way_to_table(image, table, _SPARSE)
    told = towards.reshape(len(left), -1)[:, :columns]
    told = told & is_measured(left) & is_measured(middle) & is_measured(right)
    second_m = np.abs((left + right - 2.0 * middle)[told] * down[told])
    return _MAD_TO_SIGMA * float(np.median(second_m)) / math.sqrt(6.0) if len(second_m) else 0.0


def why_colorless(
    image: CameraImage,
    table: Table,
    grey: int,
    own_arm: Callable[[Points], NDArray[np.bool_]] | None = None,
) -> str | None:
    """Why a picture tells no coloured parts, as a clause; None for one that has some colour.

    Nor where no more stands on the table than the parts that are `grey`, so many.
    """
    if has_color(image):
        return None
    heights = measure_heights(image, table, own_arm)
    if heights is None or len(find_surfaces(heights).all) <= grey:
        return None
    return "the picture of my head camera has no colour"


def has_color(image: CameraImage) -> bool:
    """Whether any block of a picture is coloured, by more than its noise can make it."""
    noisy = _chroma(image.bgr[::_SPARSE])
    sigma = _MAD_TO_SIGMA * float(np.median(np.abs(np.diff(noisy, axis=1)))) / math.sqrt(2.0)
    scale = 1 / _BLOCK_PX
    blocks = cv2.resize(image.bgr, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    limit = max(_SURE_SIGMAS * sigma / _BLOCK_PX, _LEAST_GREY)
    return bool(np.abs(_chroma(np.asarray(blocks, np.uint8))).max(initial=0) > limit)


def _chroma(bgr: NDArray[np.uint8]) -> NDArray[np.int16]:
    """By how many grey levels blue and green differ from red."""
    channels = bgr.astype(np.int16)
    return channels[..., :2] - channels[..., 2:]


def table_px(image: CameraImage, table: Table) -> NDArray[np.bool_]:
    """The pixels (h, w) behind which the table is, whatever is in front of it."""
    _, towards = _way_to_table(image, table, 1)
    return towards.reshape(image.bgr.shape[:2])


def _way_to_table(
    image: CameraImage, table: Table, every: int
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """How far along each ray the table's plane is, and whether the table is there."""
    rays = ground_rays(image, every=every).reshape(3, -1).T
    eye = image.pose[:3, 3]
    with np.errstate(divide="ignore", invalid="ignore"):
        away_m = (table.height - eye[2]) / rays[:, 2]
    ground = eye[:2] + away_m[:, None] * rays[:, :2]
    off = np.abs(ground - np.array(table.center)) <= np.array(table.size) / 2
    return away_m, (away_m > 0.0) & off.all(axis=1)


def _share_measured(
    image: CameraImage,
    depth_m: NDArray[np.float32],
    table: Table,
    own_arm: Callable[[Points], NDArray[np.bool_]] | None,
) -> float:
    """The share of the rays to the table that end on it, or on what stands on it."""
    rays = ground_rays(image, every=_SPARSE).reshape(3, -1).T
    eye = image.pose[:3, 3]
    away_m, towards = _way_to_table(image, table, _SPARSE)
    depth = depth_m.reshape(-1)[towards].astype(np.float64)
    points = eye + depth[:, None] * rays[towards]
    with np.errstate(invalid="ignore"):
        up_m = points[:, 2] - table.height
        told = is_measured(depth) & (up_m > -_LOWEST_M) & (depth > _NEAREST * away_m[towards])
        other = ~told & is_measured(depth)
    arm = np.zeros(len(depth), np.bool_)
    if own_arm is not None and other.any():
        arm[other] = own_arm(points[other])
    asked = ~arm
    if image.others is not None:
        asked &= ~image.others[::_SPARSE, ::_SPARSE].reshape(-1)[towards]
    return float(told[asked].mean()) if asked.any() else 1.0
