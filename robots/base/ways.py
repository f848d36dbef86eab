"""The ways that a base knows: which points to pass to a pose."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from mend.robots.base.body import BasePose


class Ways(Protocol):
    """What knows of ways, in the base's frame on the link: a map, or none."""

    def path(self, here: BasePose, to: BasePose) -> Sequence[tuple[float, float]]:
        """The points to pass from `here`, straight from one to the next; the last is the goal's.

        Raises `CommandError` where there is no way.
        """
        ...

    def door_at(self, here: BasePose, ahead: tuple[float, float]) -> str | None:
        """The door between a pose and a point ahead; None where there is none."""
        ...

    def walls_near(self, here: BasePose) -> NDArray[np.float64]:
        """Points (n, 2) on walls around a pose, also on those that something hides from it."""
        ...


class StraightWays:
    """The way of who knows of no walls: straight to the goal."""

    def path(self, here: BasePose, to: BasePose) -> Sequence[tuple[float, float]]:  # noqa: ARG002
        """Nothing but the goal."""
        return [(to.x, to.y)]

    def door_at(self, here: BasePose, ahead: tuple[float, float]) -> str | None:  # noqa: ARG002
        """None: it knows of no doors."""
        return None

    def walls_near(self, here: BasePose) -> NDArray[np.float64]:  # noqa: ARG002
        """None: it knows of no walls."""
        return np.zeros((0, 2))
