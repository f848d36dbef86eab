"""Whether anything has changed between two pictures of a camera that stands still.

Frame differencing against a reference picture, with the threshold from the pictures' own noise
(Rosin & Ioannidis 2003, "Evaluation of global image thresholding for change detection", section
2.3: noise modelling by the median of the differences).
"""

import math

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.robots.body import CameraImage
from mend.robots.vision.projection import is_measured

Picture = NDArray[np.float32]

_WINDOW = (3, 3)
_SPARSE = 4
"""Noise is measured in each fourth row and column."""
_SIGMAS = 7.0
_MAD_TO_SIGMA = 1.4826
_LEAST_GREY = 8.0
_LEAST_DEPTH_M = 0.008
"""Smaller differences are those of light and of depth at edges, not of something that moved."""
DARKEST, BRIGHTEST = 8.0, 247.0
"""Grey levels beyond which a pixel is under- or overexposed."""
_WELL_EXPOSED = np.arange(256, dtype=np.float32)
"""Every grey level; NaN for those that tell nothing."""
_WELL_EXPOSED[(_WELL_EXPOSED < DARKEST) | (_WELL_EXPOSED > BRIGHTEST)] = np.nan
_FEWEST_PX = 6
_STILL_SHARE = 0.5
"""What is dark, or an edge, has depth in some pictures and none in others."""
_LEAST_SHARE = 5e-5
"""A patch that covers less of the picture is noise, or too small for a part."""


def shows_change(before: CameraImage, now: CameraImage) -> bool:
    """Whether the later picture shows anything that the earlier one did not."""
    if before is now:
        return False
    if before.bgr.shape != now.bgr.shape or not np.allclose(before.pose, now.pose, atol=1e-6):
        return True
    if is_same(before, now):
        return False
    return _differ_in_color(before, now) or (
        before.depth_m is not None
        and now.depth_m is not None
        and _differ(_known(before.depth_m), _known(now.depth_m), _LEAST_DEPTH_M)
    )


def _differ_in_color(before: CameraImage, now: CameraImage) -> bool:
    if np.array_equal(before.bgr, now.bgr):
        return False
    earlier, later = _exposed(before), _exposed(now)
    return _differ(earlier, later, _LEAST_GREY, _exposure(earlier, later))


def still_measures(before: CameraImage, now: CameraImage, mask: NDArray[np.uint8]) -> bool:
    """Whether the later picture has depth where the earlier one had it, but for single pixels.

    That nothing has changed says nothing of what is not measured any more. `mask` (h, w) is not 0
    where it matters.
    """
    if before.depth_m is None:
        return True
    if now.depth_m is None:
        return False
    left, top, width, height = cv2.boundingRect(mask)
    patch = slice(top, top + height), slice(left, left + width)
    where = mask[patch] > 0
    had, has = (
        int(np.count_nonzero(is_measured(depth_m[patch][where])))
        for depth_m in (before.depth_m, now.depth_m)
    )
    return has >= _STILL_SHARE * had


def _known(depth_m: Picture) -> Picture:
    """Depth with NaN where there is none."""
    return np.where(is_measured(depth_m), depth_m, np.float32(np.nan))


def is_same(before: CameraImage, now: CameraImage) -> bool:
    """Whether two pictures are the same to the bit, noise and all."""
    if before.bgr is now.bgr and before.depth_m is now.depth_m:
        return True
    if not np.array_equal(before.bgr, now.bgr):
        return False
    if before.depth_m is None or now.depth_m is None:
        return before.depth_m is now.depth_m
    return np.array_equal(before.depth_m, now.depth_m, equal_nan=True)


def _exposed(image: CameraImage) -> Picture:
    """A picture's colours; NaN where it is over- or underexposed."""
    return np.asarray(cv2.LUT(image.bgr, _WELL_EXPOSED), np.float32)


def _exposure(before: Picture, now: Picture) -> float:
    """How many times brighter the later of two pictures is."""
    ratios = now[::_SPARSE, ::_SPARSE] / before[::_SPARSE, ::_SPARSE]
    known = ratios[np.isfinite(ratios)]
    return float(np.median(known)) if known.size else 1.0


def _differ(before: Picture, now: Picture, least: float, exposure: float = 1.0) -> bool:
    """Whether a patch differs by more than noise and by more than `least`.

    `exposure` is what the earlier picture is multiplied by.
    """
    # What is missing in either says nothing. In place: fresh memory takes longer than the sums.
    difference = cv2.patchNaNs(cv2.addWeighted(now, 1.0, before, -exposure, 0.0), 0.0)
    cv2.blur(difference, _WINDOW, dst=difference)
    sigma = _MAD_TO_SIGMA * float(np.median(np.abs(difference[::_SPARSE, ::_SPARSE])))
    limit = max(_SIGMAS * sigma, least)
    fewest_px = max(_FEWEST_PX, _LEAST_SHARE * before.shape[0] * before.shape[1])
    beyond_noise = (difference > limit) | (difference < -limit)
    if np.count_nonzero(beyond_noise) < fewest_px:
        return False
    at = np.unravel_index(np.flatnonzero(beyond_noise), beyond_noise.shape)
    lowest, smooth, highest = _around(before, now, exposure, at)
    # At an edge any value between those of its two sides may come.
    smooth_now = smooth + difference[at]
    beyond = np.maximum(smooth_now - highest, lowest - smooth_now) > limit
    changed = np.zeros(before.shape[:2], np.uint8)
    changed[at[0][beyond], at[1][beyond]] = 1
    return has_patch(changed, math.ceil(fewest_px))


def _around(
    before: Picture, now: Picture, exposure: float, at: tuple[NDArray[np.intp], ...]
) -> tuple[Picture, Picture, Picture]:
    """Of the smooth earlier picture at some pixels (n): its least around each, itself, its most.

    Where it shows nothing it has what the later one shows.
    """
    rows, columns, *channels = at
    height, width = before.shape[:2]
    near = np.arange(-2, 3)
    down, across = rows[:, None] + near, columns[:, None] + near
    index = (
        _reflected(down, height)[:, :, None],
        _reflected(across, width)[:, None, :],
        *(each[:, None, None] for each in channels),
    )
    earlier = before[index] * np.float32(exposure)
    filled = np.nan_to_num(np.where(np.isnan(earlier), now[index], earlier), nan=0.0)
    # Means of three by three, at three by three pixels (n, 3, 3).
    tall = filled[:, :3] + filled[:, 1:4] + filled[:, 2:]
    smooth = (tall[:, :, :3] + tall[:, :, 1:4] + tall[:, :, 2:]) / np.float32(9.0)
    inside = ((down >= 0) & (down < height))[:, 1:4, None]
    inside = inside & ((across >= 0) & (across < width))[:, None, 1:4]
    least = np.where(inside, smooth, np.float32(np.inf)).min(axis=(1, 2))
    most = np.where(inside, smooth, np.float32(-np.inf)).max(axis=(1, 2))
    return least, smooth[:, 1, 1], most


def _reflected(index: NDArray[np.intp], size: int) -> NDArray[np.intp]:
    """Rows or columns, those outside mirrored at the first and the last one."""
    mirrored: NDArray[np.intp] = (size - 1) - np.abs((size - 1) - np.abs(index))
    return mirrored


def has_patch(changed: NDArray[np.uint8], pixels: int) -> bool:
    """Whether so many connected pixels are not 0."""
    if np.count_nonzero(changed) < pixels:
        return False
    # Each pixel of a patch is so near to all of it: most pictures need no components.
    around = (2 * pixels - 1, 2 * pixels - 1)
    if np.max(cv2.boxFilter(changed, cv2.CV_32F, around, normalize=False)) < pixels - 0.5:
        return False
    _, _, stats, _ = cv2.connectedComponentsWithStats(changed)
    return bool(stats[1:, cv2.CC_STAT_AREA].max(initial=0) >= pixels)
