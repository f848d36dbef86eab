"""Whether a head picture can tell anything of the table at all, and if not, why."""

from collections.abc import Callable

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.robots.body import CameraImage
from mend.robots.vision.height_map import ground_rays
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


def why_frozen(image: CameraImage, overtaken: CameraImage | None) -> str | None:
    """Why a picture tells nothing of now that shows a scene which has changed since; or None."""
    if overtaken is None or not np.array_equal(image.bgr, overtaken.bgr):
        return None
    return "my head camera still gives the picture that it gave before I moved something"


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
