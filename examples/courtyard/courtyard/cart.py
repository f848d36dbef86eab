"""A cart: the body of a robot that drives in a courtyard."""

import math
from collections.abc import Callable, Mapping

import numpy as np

from courtyard.floor import Circle, ranges_m
from mend.robots.base.body import STANDING, BasePose, DriveLimits, RangeScan, Velocity
from mend.robots.body import Camera
from mend.tasks.frames import Frame

RADIUS_M = 0.3
PERIOD_S = 0.05
LIMITS = DriveLimits(
    speed_m_s=0.8,
    acceleration_m_s2=1.5,
    turn_rad_s=1.6,
    turn_acceleration_rad_s2=3.2,
    sideways=False,
)
_BEAMS = np.linspace(-math.pi, math.pi, 360, endpoint=False)


class Cart:
    """Implements `mend.robots.base.body.BaseBody`; it knows exactly where it is.

    `around` tells what stands around it in the scene's frame; `pass_cycle` lets time pass for all.
    """

    radius_m = RADIUS_M
    limits = LIMITS
    scan_period_s = 0.1
    control_period_s = PERIOD_S
    cameras: Mapping[str, Camera] = {}

    def __init__(
        self,
        frame: Frame,
        time_s: Callable[[], float],
        around: Callable[["Cart"], list[Circle]],
        pass_cycle: Callable[[], None],
    ) -> None:
        self._frame = frame
        self.time_s = time_s
        self.advance_cycle = pass_cycle
        self._around = around
        self.place = BasePose(frame.x, frame.y, frame.yaw)
        """In the scene's frame."""
        self._now = self._told = STANDING

    def pose(self) -> BasePose:
        """In its base frame: that in which it stood at the start."""
        x, y = self._frame.to_robot(self.place.x, self.place.y)
        return BasePose(x, y, math.remainder(self.place.yaw - self._frame.yaw, math.tau))

    def scan(self) -> RangeScan:
        ranges = ranges_m((self.place.x, self.place.y), _BEAMS + self.place.yaw, self._around(self))
        return RangeScan(ranges, _BEAMS, self.time_s())

    def odometry(self) -> BasePose:
        """As true as all that it knows."""
        return self.pose()

    def velocity(self) -> Velocity:
        return self._now

    def move(self, velocity: Velocity) -> None:
        self._told = velocity

    def stop(self) -> None:
        self._told = STANDING

    @property
    def moving(self) -> bool:
        return self._now != STANDING or self._told != STANDING

    def jump(self, to: BasePose) -> None:
        """Stand somewhere else at once (a rebuilt world)."""
        self.place, self._now, self._told = to, STANDING, STANDING

    def advance(self) -> None:
        """One control cycle: come as near to the velocity that it was told as it can, and go on."""
        now, told = self._now, self._told
        forward = _towards(now.forward_m_s, told.forward_m_s, LIMITS.acceleration_m_s2)
        turn = _towards(now.turn_rad_s, told.turn_rad_s, LIMITS.turn_acceleration_rad_s2)
        self._now = Velocity(forward, 0.0, turn)
        here, heading = self.place, self.place.yaw + turn * PERIOD_S / 2
        x = here.x + forward * PERIOD_S * math.cos(heading)
        y = here.y + forward * PERIOD_S * math.sin(heading)
        self.place = BasePose(x, y, here.yaw + turn * PERIOD_S)


def _towards(now: float, told: float, acceleration: float) -> float:
    most = acceleration * PERIOD_S
    return now + max(-most, min(most, told - now))
