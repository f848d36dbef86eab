"""How far it is from place to place, and how long it takes at speed 1."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float64]


class TravelError(Exception):
    """A matrix that is no travel matrix; raised by `Travel`."""


@dataclass(frozen=True, slots=True, eq=False)
class Travel:
    """Distances (metres) and times (seconds) between all places; from row to column.

    Infinite where there is no way. Raises `TravelError` for what is not square, negative or NaN.
    """

    distance_m: Matrix
    time_s: Matrix

    def __post_init__(self) -> None:
        for name, matrix in (("distance", self.distance_m), ("time", self.time_s)):
            if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1]:
                raise TravelError(f"the {name} matrix is {matrix.shape}, but must be square")
            if np.isnan(matrix).any() or (matrix < 0).any():
                raise TravelError(f"a {name} is negative or no number")
            if np.diagonal(matrix).any():
                raise TravelError(f"the {name} from a place to itself must be 0")
        if self.distance_m.shape != self.time_s.shape:
            raise TravelError("distances and times are not between the same places")

    @property
    def count(self) -> int:
        """How many places there are."""
        return int(self.time_s.shape[0])

    @classmethod
    def euclidean(cls, points: Sequence[tuple[float, float]], speed_m_s: float = 1.0) -> Self:
        """Straight lines between points (metres)."""
        xy = np.asarray(points, dtype=np.float64).reshape(-1, 2)
        apart = xy[:, None, :] - xy[None, :, :]
        distance = np.hypot(apart[..., 0], apart[..., 1])
        return cls(distance, distance / speed_m_s)
