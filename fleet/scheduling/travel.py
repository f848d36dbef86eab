"""How far it is from place to place, and how long it takes at speed 1; also where doors close.

Where doors open and close, travel has epochs: spans of time, each with the distances and times
along what is passable throughout. A trip is made within one epoch, so it never meets a closed
door; who leaves while there is no way waits where it is.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from mend.fleet.scheduling.tolerance import DOOR_S

Matrix = NDArray[np.float64]


class TravelError(Exception):
    """A matrix that is no travel matrix; raised by `Travel`."""


class Trip(NamedTuple):
    """When a robot is there, and how far it has driven then; both infinite where it never is."""

    arrival_s: float
    distance_m: float


@dataclass(frozen=True, slots=True, eq=False)
class Epoch:
    """What is passable at every moment from `from_s` until `until_s`. Epochs may overlap."""

    from_s: float
    until_s: float
    distance_m: Matrix
    time_s: Matrix


@dataclass(frozen=True, slots=True, eq=False)
class Travel:
    """Distances (metres) and times (seconds) between all places; from row to column.

    Infinite where there is no way. With `epochs`, which `through` sets, the matrices are what is
    best in any of them, and `trip` says what holds at a time. Raises `TravelError` for what is not
    square, negative or NaN.
    """

    distance_m: Matrix
    time_s: Matrix
    epochs: tuple[Epoch, ...] = ()

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

    @classmethod
    def through(cls, epochs: Sequence[Epoch]) -> Self:
        """Travel while doors open and close. Raises `TravelError` where there is no epoch."""
        if not epochs:
            raise TravelError("travel needs at least one epoch")
        return cls(
            np.minimum.reduce([epoch.distance_m for epoch in epochs]),
            np.minimum.reduce([epoch.time_s for epoch in epochs]),
            tuple(epochs),
        )

    def trip(self, origin: int, destination: int, leaves_s: float, speed: float = 1.0) -> Trip:
        """The earliest arrival of who may leave at `leaves_s`, over all that it could wait for.

        Of those that arrive at the same time the shortest.
        """
        if origin == destination:
            return Trip(leaves_s, 0.0)
        if not self.epochs:
            lasts_s = float(self.time_s[origin, destination]) / speed
            return Trip(leaves_s + lasts_s, float(self.distance_m[origin, destination]))
        best = Trip(inf, inf)
        for epoch in self.epochs:
            lasts_s = float(epoch.time_s[origin, destination]) / speed
            arrival_s = max(leaves_s, epoch.from_s) + lasts_s
            if arrival_s < inf and arrival_s <= epoch.until_s + DOOR_S:
                best = min(best, Trip(arrival_s, float(epoch.distance_m[origin, destination])))
        return best

    def shortest_lasting_s(
        self, origin: int, destination: int, leaves_s: float, speed: float = 1.0
    ) -> float:
        """How long a trip takes at least, waiting not counted, if it begins then or later."""
        if origin == destination or not self.epochs:
            return float(self.time_s[origin, destination]) / speed
        shortest_s = inf
        for epoch in self.epochs:
            lasts_s = float(epoch.time_s[origin, destination]) / speed
            if leaves_s + lasts_s <= epoch.until_s + DOOR_S:
                shortest_s = min(shortest_s, lasts_s)
        return shortest_s


def shortest_ways(matrix: Matrix) -> Matrix:
    """From place to place, also by way of others; in the unit of the matrix."""
    shortest = matrix.copy()
    for place in range(shortest.shape[0]):
        by_way = shortest[:, place, None] + shortest[None, place, :]
        np.minimum(shortest, by_way, out=shortest)
    return shortest
