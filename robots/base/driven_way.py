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
        self._way_m += self._since_m(at)
        self._at = at

    def stood(self, for_s: float) -> None:
        """It stood so long, as its way was barred."""
        self._barred_s += for_s

    def so_far(self, at: BasePose) -> Driven:
        """Since the beginning; the wheels say that it is there now, which is not noted."""
        return Driven(way_m=self._way_m + self._since_m(at), barred_s=self._barred_s)

    def _since_m(self, at: BasePose) -> float:
        was = self._at
        return 0.0 if was is None else math.hypot(at.x - was.x, at.y - was.y)
