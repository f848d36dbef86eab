"""What one optimization over an episode's poses is about: its constraints, as flat arrays.

Poses are (x, y, heading) in the map's frame; points and normals are in the frame of their robot.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class LtfConstraints:
    """Points that lie on lines of the map: normal . point + offset = 0 in the map's frame.

    The constraints of pose i are `start[i]` to `start[i + 1]`. `widths_m` is, per pose, the
    distance at which the robust loss halves a point's pull.
    """

    start: Indices
    points: Floats
    normals: Floats
    offsets: Floats
    widths_m: Floats


@dataclass(frozen=True, slots=True)
class StfConstraints:
    """Points that two poses both saw, each with its normal.

    The constraints of the k-th pair of poses `pairs[k]` are `start[k]` to `start[k + 1]`.
    """

    pairs: Indices
    start: Indices
    points_a: Floats
    normals_a: Floats
    points_b: Floats
    normals_b: Floats
    width_m: float

    @classmethod
    def none(cls) -> "StfConstraints":
        """No pair of poses has anything in common."""
        nothing = np.zeros((0, 2))
        no_pairs = np.zeros((0, 2), dtype=np.int64)
        start = np.zeros(1, dtype=np.int64)
        return cls(no_pairs, start, nothing, nothing, nothing, nothing, 1.0)


@dataclass(frozen=True, slots=True)
class PoseGraph:
    """All constraints on n poses.

    `odometry[i]` is the measured motion from pose i to pose i + 1 in the frame of pose i, and
    `odometry_whitening[i]` turns its error into unit variances; beyond `odometry_width`
    of them the robust loss lets go. The prior is on the first pose; its
    error is whitened in the map's frame. `ltf_weight` and `stf_weight` are information per square
    metre: the inverse variance, times what is discounted for rays that are correlated.
    """

    prior: Floats
    prior_whitening: Floats
    odometry: Floats
    odometry_whitening: Floats
    odometry_width: float
    ltf: LtfConstraints
    stf: StfConstraints
    ltf_weight: float
    stf_weight: float
