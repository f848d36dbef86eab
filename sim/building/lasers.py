"""The lasers of a building's robots: each scans when somebody wants to know what it shows."""

import math
from collections.abc import Callable

import numpy as np

from mend.maps.building.building import Building
from mend.robots.base.body import RangeScan
from mend.sim.building import laser
from mend.sim.building.building_robot import BuildingRobot
from mend.sim.building.crowd import Crowd
from mend.sim.building.laser_noise import measured_m
from mend.sim.building.space import Space


class Lasers:
    """The newest scan of each robot; no scan is made that nobody looks at."""

    def __init__(
        self,
        building: Building,
        space: Space,
        crowd: Crowd,
        rng: np.random.Generator,
        time_s: Callable[[], float],
    ) -> None:
        self._building, self._space, self._crowd = building, space, crowd
        self._rng, self._time_s = rng, time_s
        self._newest: dict[BuildingRobot, RangeScan] = {}

    def newest(self, robot: BuildingRobot) -> RangeScan:
        """What a robot's laser shows, at most one period ago."""
        kept, now_s = self._newest.get(robot), self._time_s()
        if kept is not None and now_s - kept.time < laser.PERIOD_S - 1e-9:
            return kept
        at = robot.at
        ranges = laser.ranges_m(
            self._space.seen_by_lasers(at.floor),
            self._crowd.circles(at.floor, robot),
            at.x,
            at.y,
            at.yaw,
        )
        scan = RangeScan(measured_m(ranges, self._rng), laser.ANGLES_RAD, now_s)
        self._newest[robot] = scan
        if robot.belief is not None and at.floor in self._building.floors:
            robot.belief.see(scan)
        return scan

    def pass_time(self) -> None:
        """One cycle: robots that find out where they are take the scans that they need for it."""
        now_s = self._time_s()
        for robot in self._crowd.robots:
            if self._needs_s(robot) <= now_s:
                self.newest(robot)

    def needed_s(self) -> float:
        """When the next robot needs a scan although nobody moves."""
        return min((self._needs_s(each) for each in self._crowd.robots), default=math.inf)

    def forget(self) -> None:
        """There are no scans any more, after a restart."""
        self._newest.clear()

    def _needs_s(self, robot: BuildingRobot) -> float:
        if robot.belief is None or robot.at.floor not in self._building.floors:
            return math.inf
        return robot.belief.needs_scan_s()
