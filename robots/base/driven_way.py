"""How far a base has driven, by its wheels, and how long it stood before what barred its way."""

import math

from mend.robots.base.body import BasePose
from mend.robots.link.messages import Driven


class DrivenWay:
    """Adds up both; what is noted are the poses to which odometry leads, one after the other."""

    def __init__(self) -> None:
        self._at: BasePose | None = None
        self._way_m = self._barred_s = 0.0

    def note(self, at: BasePose) -> None:
        """The wheels say that it is there now: straight from where they were noted last."""
        if self._at is not None:
            self._way_m += math.hypot(at.x - self._at.x, at.y - self._at.y)
        self._at = at

    def stood(self, for_s: float) -> None:
        """It stood so long, as its way was barred."""
        self._barred_s += for_s

    @property
    def so_far(self) -> Driven:
        """Since the beginning."""
        return Driven(way_m=self._way_m, barred_s=self._barred_s)
