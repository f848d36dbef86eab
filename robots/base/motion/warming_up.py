"""Compiling what a base's motion calls, before it drives."""

from functools import cache

import numpy as np

from mend.robots.base.body import STANDING, BasePose, DriveLimits, RangeScan
from mend.robots.base.motion.surroundings import Seen, hidden_behind
from mend.robots.base.motion.way_follower import WayFollower


@cache
def warm_up() -> None:
    """Look round and choose a velocity in a made-up place.

    Compiling would stop a base that drives for seconds.
    """
    limits = DriveLimits(1.0, 1.0, 1.0, 1.0, sideways=True)
    start = BasePose(0.0, 0.0, 0.0)
    angles = np.linspace(-1.0, 1.0, 3)
    hidden_behind(RangeScan(np.ones(3), angles, 0.0), start, np.array([[2.0, 0.0]]))
    follower = WayFollower(limits, 0.3, 0.1, [(0.0, 0.0), (2.0, 0.0)], BasePose(2.0, 0.0, 0.0))
    follower.choose(start, STANDING, Seen.still(np.array([[1.0, 0.0], [1.0, 1.0]])), 1.0, 0.0)
