"""Between pixels and points: the pinhole camera of a `CameraImage`."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from mend.robots.body import CameraImage, Matrix4

Points = NDArray[np.float64]

NEAR_M = 0.02
"""Points nearer to the lens than this are drawn as if they were this far away."""


class Pinhole(Protocol):
    """What decides at which pixels points appear: of a `CameraImage`, or before there is one."""

    @property
    def pose(self) -> Matrix4: ...

    @property
    def focal_px(self) -> float: ...

    @property
    def center_px(self) -> tuple[float, float]: ...


def is_measured(depth_m: NDArray[np.float32] | NDArray[np.float64]) -> NDArray[np.bool_]:
    """Where there is a depth: drivers tell a missing one as NaN, as 0, or as infinite."""
    return np.isfinite(depth_m) & (depth_m > 0.0)


def unproject(image: CameraImage, us: NDArray[np.intp], vs: NDArray[np.intp]) -> Points:
    """The points (n, 3) in the base frame that pixels of an RGB-D picture show.

    Raises `ValueError` for a picture without depth.
    """
    if image.depth_m is None:
        raise ValueError("expected a picture with depth, got one without")
    depth = image.depth_m[vs, us].astype(np.float64)
    cx, cy = image.center_px
    right = (us - cx) * (depth / image.focal_px)
    down = (vs - cy) * (depth / image.focal_px)
    points = np.empty((len(depth), 3))
    # Not a matrix product: for so thin a matrix BLAS would wake all its threads for nothing.
    for axis in range(3):
        x, y, z, origin = image.pose[axis]
        points[:, axis] = x * right + y * down + z * depth + origin
    return points


def heights(image: CameraImage) -> NDArray[np.float64]:
    """How high (metres, base frame) lies what each pixel of an RGB-D picture shows.

    NaN where there is no depth. Raises `ValueError` for a picture without depth.
    """
    if image.depth_m is None:
        raise ValueError("expected a picture with depth, got one without")
    rows, columns = image.depth_m.shape
    cx, cy = image.center_px
    x, y, z, origin = image.pose[2]
    across = (np.arange(columns) - cx) * (x / image.focal_px)
    down = (np.arange(rows) - cy) * (y / image.focal_px) + z
    depth_m = np.where(is_measured(image.depth_m), image.depth_m, np.nan)
    found: NDArray[np.float64] = depth_m * (across[None, :] + down[:, None]) + origin
    return found


def in_optical_frame(camera: Pinhole, points: Points) -> Points:
    """Points (n, 3) of the base frame as x right, y down and z forward of the lens."""
    optical: Points = (points - camera.pose[:3, 3]) @ camera.pose[:3, :3]
    return optical


def project(camera: Pinhole, points: Points) -> Points:
    """The pixels (n, 2) at which points (n, 3) of the base frame appear."""
    optical = in_optical_frame(camera, points)
    depth = np.maximum(optical[:, 2], NEAR_M)
    pixels: Points = optical[:, :2] / depth[:, None] * camera.focal_px + np.array(camera.center_px)
    return pixels


def pixels_covered(
    image: CameraImage, center: tuple[float, float, float], size: tuple[float, float]
) -> float:
    """How many pixels a level rectangle of `size` metres around `center` covers."""
    return size[0] * size[1] / pixel_area_m2(image, center)


def pixel_area_m2(image: CameraImage, at: tuple[float, float, float]) -> float:
    """The area of a level surface that a pixel covers there."""
    from_eye = np.array(at) - image.pose[:3, 3]
    depth_m = float(from_eye @ image.pose[:3, 2])
    return depth_m**3 / (image.focal_px**2 * abs(float(from_eye[2])))
