"""The body: what whatever moves a robot may ask of its hardware, be it an arm, a base or both.

A body is simulated or real. It is synchronous: nothing moves or is measured except in
`advance_cycle`, which advances one control cycle. Lengths are metres, angles radians, times seconds
of the world's clock; poses are 4x4 matrices in the robot's base frame (x forward, y left, z up).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Matrix4 = NDArray[np.float64]
"""A homogeneous transform, shape (4, 4)."""


@dataclass(frozen=True, slots=True)
class CameraImage:
    """One picture with what is needed to measure in it.

    `bgr`: (height, width, 3) uint8. `depth_m`: (height, width) float32 along the optical axis, NaN
    or 0 where none was measured, or None for a camera without depth. `pose`: the optical frame
    (z forward, x right, y down) in the base frame. A pixel (u, v) is at ((u - cx) / f * d,
    (v - cy) / f * d, d) in the optical frame. `others`: (height, width), where other robots are
    that say where they are, so that no depth is given there; None where there are none.
    """

    bgr: NDArray[np.uint8]
    depth_m: NDArray[np.float32] | None
    pose: Matrix4
    focal_px: float
    center_px: tuple[float, float]
    time: float
    others: NDArray[np.bool_] | None = None


class Camera(Protocol):
    """A camera on a robot."""

    @property
    def period_s(self) -> float:
        """How often it takes a picture, in seconds of the world's clock."""
        ...

    def pose(self) -> Matrix4:
        """Where it is now: its optical frame in the base frame."""
        ...

    def capture(self) -> CameraImage:
        """Take a picture now."""
        ...


class Body(Protocol):
    """One robot's hardware, as far as its clock and its cameras go."""

    @property
    def control_period_s(self) -> float:
        """The duration of one control cycle."""
        ...

    @property
    def cameras(self) -> Mapping[str, Camera]:
        """The cameras by name."""
        ...

    def time_s(self) -> float:
        """The world's clock."""
        ...

    def advance_cycle(self) -> None:
        """Let one control cycle pass."""
        ...


class MovingBody(Body, Protocol):
    """What of a robot's hardware moves."""

    def stop(self) -> None:
        """Stop as soon as it can and hold still; what was under way is over."""
        ...

    @property
    def moving(self) -> bool:
        """Whether anything moves, or is about to."""
        ...
