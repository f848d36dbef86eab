"""Planar poses as arrays (x, y, theta): metres and radians, the last axis of float64 arrays."""

import numpy as np
from numpy.typing import NDArray

Poses = NDArray[np.float64]
"""One pose (3,) or many (..., 3)."""
Angles = NDArray[np.float64]


def wrap(angles: Angles) -> Angles:
    """Angles in [-pi, pi)."""
    wrapped: Angles = (np.asarray(angles, dtype=np.float64) + np.pi) % (2.0 * np.pi) - np.pi
    return wrapped


def wrap_angle(angle: float) -> float:
    """One angle in [-pi, pi)."""
    return float((angle + np.pi) % (2.0 * np.pi) - np.pi)


def compose(base: Poses, motion: Poses) -> Poses:
    """Where `motion`, in the frame of `base`, leads: poses in the frame that `base` is in."""
    base, motion = np.asarray(base), np.asarray(motion)
    cosine, sine = np.cos(base[..., 2]), np.sin(base[..., 2])
    x, y = motion[..., 0], motion[..., 1]
    return np.stack(
        (
            base[..., 0] + cosine * x - sine * y,
            base[..., 1] + sine * x + cosine * y,
            wrap(base[..., 2] + motion[..., 2]),
        ),
        axis=-1,
    )


def relative(base: Poses, pose: Poses) -> Poses:
    """The pose as seen from `base`: what `compose(base, ...)` needs to give `pose`."""
    base, pose = np.asarray(base), np.asarray(pose)
    cosine, sine = np.cos(base[..., 2]), np.sin(base[..., 2])
    dx, dy = pose[..., 0] - base[..., 0], pose[..., 1] - base[..., 1]
    return np.stack(
        (
            cosine * dx + sine * dy,
            cosine * dy - sine * dx,
            wrap(pose[..., 2] - base[..., 2]),
        ),
        axis=-1,
    )


def transform(pose: Poses, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points (m, 2) in the frame of one pose, moved to the frame that the pose is in."""
    return turn(float(pose[2]), points) + pose[:2]


def turn(angle: float, vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Vectors (m, 2) turned counter-clockwise by an angle."""
    cosine, sine = np.cos(angle), np.sin(angle)
    rotation = np.array([[cosine, sine], [-sine, cosine]])
    turned: NDArray[np.float64] = vectors @ rotation
    return turned
