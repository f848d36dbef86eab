"""People who walk past: round, and gone after a while.

They do not look where the robot is. Now and then one walks right over it, and its laser then sees
nothing else.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.localization.pose import Poses

Matrix = NDArray[np.float64]

_RADIUS_M = 0.2
_SIDES = 6
_SPEED_M_PER_S = (0.3, 1.4)
_ASIDE_M = (0.6, 2.5)
"""How far beside the robot's way they walk."""
_SEEN_S = 12.0
"""How long a person stays near the robot on average."""


@dataclass(frozen=True, slots=True)
class People:
    """Straight walks: place and velocity at a moment, for a span of time around it."""

    moments_s: Matrix
    places: Matrix
    velocities: Matrix

    def segments(self, time_s: float) -> Matrix:
        """The outlines (n, 4) of those who are there at a time."""
        since = time_s - self.moments_s
        there = np.abs(since) < _SEEN_S / 2.0
        centers = self.places[there] + since[there, None] * self.velocities[there]
        around = np.linspace(0.0, 2.0 * np.pi, _SIDES + 1)
        ring = _RADIUS_M * np.column_stack((np.cos(around), np.sin(around)))
        corners = centers[:, None, :] + ring[None, :, :]
        outline = np.concatenate((corners[:, :-1], corners[:, 1:]), axis=2)
        return np.ascontiguousarray(outline.reshape(-1, 4))


def people(way: Poses, times_s: Matrix, how_many: float, generator: np.random.Generator) -> People:
    """`how_many` are near the robot at any time, on average; each meets it somewhere on its way."""
    total = round(how_many * (float(times_s[-1]) + _SEEN_S) / _SEEN_S)
    met = generator.integers(len(way), size=total)
    heading = way[met, 2]
    side = generator.choice([-1.0, 1.0], total) * generator.uniform(*_ASIDE_M, total)
    places = way[met, :2] + side[:, None] * np.column_stack((-np.sin(heading), np.cos(heading)))
    direction = heading + generator.choice([0.0, np.pi], total)
    speed = generator.uniform(*_SPEED_M_PER_S, total)
    velocities = speed[:, None] * np.column_stack((np.cos(direction), np.sin(direction)))
    return People(times_s[met], places, velocities)
