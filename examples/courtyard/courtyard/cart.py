"""A cart: the body of a robot that drives in a courtyard."""

import math
from collections.abc import Callable, Mapping

import numpy as np

from courtyard.floor import Circle, ranges_m
from mend.robots.base.body import BasePose, RangeScan
from mend.robots.body import Camera
from mend.tasks.frames import Frame

RADIUS_M = 0.3
PERIOD_S = 0.05
_SPEED_M_S = 0.8
_TURN_RAD_S = 1.6
_BEAMS = np.linspace(-math.pi, math.pi, 180, endpoint=False)


class Cart:
    """Implements `mend.robots.base.body.BaseBody`; it knows exactly where it is.

    `around` tells what stands around it in the scene's frame; `pass_cycle` lets time pass for all.
    """

    radius_m = RADIUS_M
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
        self._goal: BasePose | None = None
        self._speed = 1.0
        self._begun_m = 0.0

    def pose(self) -> BasePose:
        """In its base frame: that in which it stood at the start."""
        x, y = self._frame.to_robot(self.place.x, self.place.y)
        return BasePose(x, y, math.remainder(self.place.yaw - self._frame.yaw, math.tau))

    def scan(self) -> RangeScan:
        ranges = ranges_m((self.place.x, self.place.y), _BEAMS + self.place.yaw, self._around(self))
        return RangeScan(ranges, _BEAMS, self.time_s())

    def drive(self, to: BasePose, speed: float) -> None:
        x, y = self._frame.to_scene(to.x, to.y)
        self._goal = BasePose(x, y, to.yaw + self._frame.yaw)
        self._speed, self._begun_m = speed, max(self.place.distance_m(self._goal), 1e-9)

    def set_speed(self, speed: float) -> None:
        self._speed = speed

    def stop(self) -> None:
        self._goal = None

    @property
    def moving(self) -> bool:
        return self._goal is not None

    @property
    def progress(self) -> float:
        if self._goal is None:
            return 1.0
        return max(0.0, 1.0 - self.place.distance_m(self._goal) / self._begun_m)

    def move(self) -> None:
        """One control cycle: turn towards the goal, drive there, turn as it says."""
        if self._goal is None:
            return
        here, goal = self.place, self._goal
        left_m = here.distance_m(goal)
        there = left_m < 1e-6
        wanted = goal.yaw if there else math.atan2(goal.y - here.y, goal.x - here.x)
        off = math.remainder(wanted - here.yaw, math.tau)
        turn = _TURN_RAD_S * self._speed * PERIOD_S
        if abs(off) > 1e-6:
            self.place = BasePose(here.x, here.y, here.yaw + max(-turn, min(turn, off)))
        elif there:
            self._goal = None
        else:
            share = min(1.0, _SPEED_M_S * self._speed * PERIOD_S / left_m)
            x, y = here.x + share * (goal.x - here.x), here.y + share * (goal.y - here.y)
            self.place = BasePose(x, y, here.yaw)
