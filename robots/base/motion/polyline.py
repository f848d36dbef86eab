"""A way as a polyline: how far along it something is, and what lies ahead."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
"""(n, 2), metres."""


class Polyline:
    """Straight legs from point to point."""

    def __init__(self, points: Sequence[tuple[float, float]]) -> None:
        """Of at least one point; raises `ValueError` for none."""
        if len(points) == 0:
            raise ValueError("expected a way of at least one point")
        corners = np.asarray(points, np.float64).reshape(-1, 2)
        steps_m = np.hypot(*np.diff(corners, axis=0).T)
        keep = np.concatenate([[True], steps_m > 1e-9])
        self._corners = corners[keep]
        self._at_m = np.concatenate([[0.0], np.cumsum(steps_m[steps_m > 1e-9])])
        self._ahead, self._lengths_m = np.diff(self._corners, axis=0), np.diff(self._at_m)

    @property
    def length_m(self) -> float:
        return float(self._at_m[-1])

    @property
    def end(self) -> tuple[float, float]:
        x, y = self._corners[-1]
        return float(x), float(y)

    def points_at(self, along_m: Points) -> Points:
        """The points (n, 2) so far along it (n,)."""
        x, y = self._corners.T
        return np.column_stack(
            [np.interp(along_m, self._at_m, x), np.interp(along_m, self._at_m, y)]
        )

    def nearest_m(self, x: float, y: float, from_m: float, to_m: float) -> float:
        """How far along it the point is that is nearest, between `from_m` and `to_m` along it."""
        if len(self._corners) == 1:
            return 0.0
        begin, ahead, lengths_m = self._corners[:-1], self._ahead, self._lengths_m
        offset = np.array([x, y]) - begin
        along_m = np.einsum("ij,ij->i", offset, ahead) / lengths_m
        low = np.clip(from_m - self._at_m[:-1], 0.0, lengths_m)
        high = np.clip(to_m - self._at_m[:-1], 0.0, lengths_m)
        along_m = np.clip(along_m, low, high)
        feet = begin + ahead * (along_m / lengths_m)[:, None]
        away_m = np.hypot(*(feet - np.array([x, y])).T)
        between = (self._at_m[1:] >= from_m) & (self._at_m[:-1] <= to_m)
        nearest = np.argmin(np.where(between, away_m, np.inf))
        return float(self._at_m[nearest] + along_m[nearest])
