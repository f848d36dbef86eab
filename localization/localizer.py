"""What every localizer offers: one update per scan, one estimate per update."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from mend.localization.points import ScanPoints
from mend.localization.pose import Poses
from mend.localization.scan import Scan


class PointClass(IntEnum):
    """What a point of the newest scan was seen on."""

    INVALID = 0
    LTF = 1
    """A long-term feature: the map explains it."""
    STF = 2
    """A short-term feature: not on the map, but seen from several poses of the episode."""
    DF = 3
    """A dynamic feature: neither."""


@dataclass(frozen=True, slots=True, eq=False)
class Estimate:
    """Where the robot is after an update, in the map's frame.

    `covariance` is (3, 3) over x, y (metres) and theta (radians). `classes` holds a `PointClass`
    for each of `points`. `lost` runs from 0 (the map explains what is seen) to 1 (it does not);
    `is_lost` is the localizer's verdict. `duration_s` is 0 where no clock measured it.
    """

    pose: Poses
    covariance: NDArray[np.float64]
    points: ScanPoints
    classes: NDArray[np.int8]
    lost: float
    is_lost: bool
    duration_s: float = 0.0


class Localizer(Protocol):
    """Follows one robot on one vector map; deterministic, with no hidden thread."""

    def reset(self, pose: Poses, covariance: NDArray[np.float64] | None = None) -> None:
        """Start anew at a pose, with its (3, 3) covariance or one that is small."""
        ...

    def update(self, odometry: Poses, scan: Scan) -> Estimate:
        """Take the motion since the last update (robot's frame) and what is seen after it.

        Raises `InvalidScanError`, and is then as it was before.
        """
        ...


class SearchingLocalizer(Localizer, Protocol):
    """A localizer that, lost, says where on its map the robot may be, and takes what it is told."""

    def search_next(self) -> None:
        """Let the next update of a robot that is lost, or in doubt, search the map to the end."""
        ...

    def open_places(self) -> Sequence[Poses]:
        """Where the robot may be by what it has seen since it was lost, the likeliest first."""
        ...

    def get_lost(self) -> None:
        """Where the robot is believed to be is believed no more, until a search finds a place."""
        ...

    def take(self, place: Poses) -> None:
        """The robot is at one of the open places: believed from now on, as far as it fits."""
        ...


class Timed:
    """A localizer whose estimates say how long they took, by a clock in seconds."""

    def __init__(self, localizer: Localizer, clock: Callable[[], float]) -> None:
        self._localizer = localizer
        self._clock = clock

    def reset(self, pose: Poses, covariance: NDArray[np.float64] | None = None) -> None:
        self._localizer.reset(pose, covariance)

    def update(self, odometry: Poses, scan: Scan) -> Estimate:
        began_s = self._clock()
        estimate = self._localizer.update(odometry, scan)
        return replace(estimate, duration_s=self._clock() - began_s)
