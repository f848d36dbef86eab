"""Vector maps: the walls of a floor as line segments, in metres in the map's frame."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mend.errors import WrongInputError

Matrix = NDArray[np.float64]


FARTHEST_M = 10_000.0
"""No building is as large; farther out what is reckoned with squares would lose its accuracy."""


@dataclass(frozen=True)
class VectorMap:
    """Line segments as rows x0, y0, x1, y1 in metres, read-only. Raises `WrongInputError`."""

    segments: Matrix
    name: str = ""

    def __post_init__(self) -> None:
        segments = np.array(self.segments, dtype=np.float64, order="C")
        if segments.size == 0:
            segments = segments.reshape(0, 4)
        if segments.ndim != 2 or segments.shape[1] != 4:
            raise WrongInputError(
                f"a vector map needs rows of 4 numbers (x0, y0, x1, y1), not shape {segments.shape}"
            )
        wrong = np.flatnonzero(~np.isfinite(segments).all(axis=1))
        if len(wrong):
            raise WrongInputError(
                f"segment {wrong[0] + 1} of the vector map has a coordinate that is not finite"
            )
        far = np.flatnonzero((np.abs(segments) > FARTHEST_M).any(axis=1))
        if len(far):
            raise WrongInputError(
                f"segment {far[0] + 1} of the vector map is more than {FARTHEST_M / 1000:g} km "
                "from its origin: coordinates are metres; are these millimetres?"
            )
        segments.setflags(write=False)
        object.__setattr__(self, "segments", segments)

    @classmethod
    def of(cls, rows: Sequence[ArrayLike], name: str = "") -> Self:
        """A vector map of rows x0, y0, x1, y1. Raises `WrongInputError`."""
        return cls(np.array(rows, dtype=np.float64), name)

    def __len__(self) -> int:
        return len(self.segments)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, VectorMap):
            return NotImplemented
        return np.array_equal(self.segments, other.segments)

    __hash__ = None  # type: ignore[assignment]

    @cached_property
    def lengths(self) -> Matrix:
        """The length of each segment in metres."""
        lengths: Matrix = np.hypot(*(self.segments[:, 2:] - self.segments[:, :2]).T)
        return lengths

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """x_min, y_min, x_max, y_max in metres; all zero for an empty map."""
        if not len(self):
            return (0.0, 0.0, 0.0, 0.0)
        ends = self.segments.reshape(-1, 2)
        low, high = ends.min(axis=0), ends.max(axis=0)
        return (float(low[0]), float(low[1]), float(high[0]), float(high[1]))

    def with_segments(self, segments: Matrix) -> "VectorMap":
        """The same map's name over other segments."""
        return VectorMap(segments, self.name)
