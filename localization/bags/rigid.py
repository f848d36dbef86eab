"""Rigid transforms in space as rows x, y, z, qx, qy, qz, qw, and what of them is in the plane."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mend.localization.pose import Poses

Rigid = NDArray[np.float64]
"""One transform (7,) or many (..., 7); the quaternion need not be of length 1."""
IDENTITY: Rigid = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


def rigid_of_pose(pose: Any) -> tuple[float, ...]:
    """The values of a `geometry_msgs/Pose`."""
    place, turn = pose.position, pose.orientation
    return (place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w)


def rigid_of_transform(transform: Any) -> tuple[float, ...]:
    """The values of a `geometry_msgs/Transform`."""
    place, turn = transform.translation, transform.rotation
    return (place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w)


def is_rigid(values: tuple[float, ...]) -> bool:
    """Whether values are finite, with a quaternion that turns something."""
    return bool(np.isfinite(values).all() and any(values[3:]))


def chained(first: Rigid, second: Rigid) -> Rigid:
    """`second`, given in the frame that `first` leads to, in the frame that `first` is in."""
    x, y, z, w = (first[..., each] for each in range(3, 7))
    a, b, c, d = (second[..., each] for each in range(3, 7))
    turned = np.stack(
        (
            w * a + x * d + y * c - z * b,
            w * b - x * c + y * d + z * a,
            w * c + x * b - y * a + z * d,
            w * d - x * a - y * b - z * c,
        ),
        axis=-1,
    )
    moved = first[..., :3] + np.einsum("...ij,...j->...i", rotations(first), second[..., :3])
    whole: Rigid = np.concatenate((moved, turned), axis=-1)
    return whole


def inverted(transforms: Rigid) -> Rigid:
    """The ways back."""
    back: Rigid = transforms * np.array([1.0, 1.0, 1.0, -1.0, -1.0, -1.0, 1.0])
    back[..., :3] = -np.einsum("...ij,...j->...i", rotations(back), transforms[..., :3])
    return back


def rotations(transforms: Rigid) -> NDArray[np.float64]:
    """The rotation matrices (..., 3, 3)."""
    x, y, z, w = (transforms[..., each] for each in range(3, 7))
    square = w * w + x * x + y * y + z * z
    rows = (
        (w * w + x * x - y * y - z * z, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        (2.0 * (x * y + w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z),
    )
    whole = np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
    matrices: NDArray[np.float64] = whole / square[..., None, None]
    return matrices


def planar(transforms: Rigid) -> Poses:
    """x, y and heading (where the x axis points, seen from above)."""
    x, y, z, w = (transforms[..., each] for each in range(3, 7))
    heading = np.arctan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)
    return np.stack((transforms[..., 0], transforms[..., 1], heading), axis=-1)


def upwards(transforms: Rigid) -> NDArray[np.float64]:
    """The cosine between the z axis and straight up: 1 upright, -1 upside down."""
    up: NDArray[np.float64] = rotations(transforms)[..., 2, 2]
    return up
