# ruff: noqa: T201
"""Bases that go round what stands in their way, beside one that stops before it.

Draws corridors with round things in them, has a base drive through each by a laser of 361 beams
with 1 cm of noise, and prints how many it got through without touching anything, where a way of two
radii and 0.2 m exists and where none does; the same for a base that drives straight from point to
point and stops before whatever is in the way. Then how long one choice of a velocity takes: the
dynamic window alone, and all of it with the search around the base.

    python benchmarks/dynamic_window.py [--corridors 200] [--first 0] [--quick]
"""

import argparse
import math
import sys
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "doubles"))

from driven_floor import (
    FORWARD,
    PERIOD_S,
    SIDEWAYS,
    Corridor,
    Drive,
    Floor,
    drawn_corridor,
    has_way,
)

from mend.robots.base.body import STANDING, BasePose, RangeScan, Velocity
from mend.robots.base.motion.dynamic_window import DynamicWindow, Steering
from mend.robots.base.motion.surroundings import Seen, points_of
from mend.robots.base.motion.warming_up import warm_up

ROOM_M = 0.1
SPARE_M = 0.15
BESIDE_M = 0.05
TURNS_RAD = 0.05
RADII_M = (0.25, 0.3, 0.4)


class StraightDrive(Drive):
    """Turns to the next point, drives straight to it, and stops before what is in the way."""

    def __init__(self, corridor: Corridor, radius_m: float, noise: np.random.Generator) -> None:
        super().__init__(
            corridor.floor, FORWARD, radius_m, corridor.start, corridor.way, 0.5, noise
        )
        self._left = list(corridor.way)
        self._stands = False

    @property
    def barred(self) -> bool:
        return self._stands

    def _note_headway(self) -> None:
        """It only ever stands, or comes nearer."""

    def choose(self, scan: RangeScan) -> Velocity:
        if len(self._left) > 1 and math.dist((self.at.x, self.at.y), self._left[0]) < 0.05:
            self._left.pop(0)
        off_m = math.dist((self.at.x, self.at.y), self._left[0])
        there = off_m < 0.03
        bearing = math.atan2(self._left[0][1] - self.at.y, self._left[0][0] - self.at.x)
        turn = math.remainder((self.goal.yaw if there else bearing) - self.at.yaw, math.tau)
        self._stands = False
        if there or (abs(turn) > TURNS_RAD and self.now.speed_m_s < 0.1):
            return Velocity(0.0, 0.0, max(-1.6, min(1.6, 2.0 * turn)))
        stops_m = off_m
        points = points_of(scan, BasePose(0.0, 0.0, -turn))
        ahead = points[np.abs(points[:, 1]) < self.radius_m + BESIDE_M, 0]
        ahead = ahead[(ahead > 0.0) & (ahead < off_m + self.radius_m)]
        if len(ahead):
            stops_m = min(stops_m, float(ahead.min()) - self.radius_m - SPARE_M)
        self._stands = stops_m <= 0.01 and not there
        room_m = max(0.0, stops_m - self.now.speed_m_s * PERIOD_S)
        speed = min(0.8, math.sqrt(2.0 * 0.9 * FORWARD.acceleration_m_s2 * room_m))
        return Velocity(speed, 0.0, max(-1.6, min(1.6, 2.0 * turn)))


def corridors(first: int, count: int) -> None:
    """Print how each kind of base ends in them."""
    ends: dict[str, Counter[str]] = {}
    for seed in range(first, first + count):
        radius_m = RADII_M[seed % len(RADII_M)]
        corridor = drawn_corridor(seed, radius_m)
        there_is = "a way" if has_way(corridor, radius_m + ROOM_M) else "no way"
        drives: dict[str, Drive] = {
            name: Drive(
                corridor.floor,
                limits,
                radius_m,
                corridor.start,
                corridor.way,
                0.5,
                np.random.default_rng(seed),
            )
            for name, limits in (("window, forward", FORWARD), ("window, sideways", SIDEWAYS))
        }
        drives["straight"] = StraightDrive(corridor, radius_m, np.random.default_rng(seed))
        for name, drive in drives.items():
            done = drive.run()
            end = "touched" if done.nearest_m <= 0.0 else done.end
            ends.setdefault(f"{name:17} where there is {there_is}", Counter())[end] += 1
    for name, counts in sorted(ends.items()):
        told = ", ".join(f"{end} {number}" for end, number in counts.most_common())
        print(f"{name}: {told} of {counts.total()}")


def timed(name: str, choose: Callable[[], object], times: int) -> None:
    """Print how long it takes, in the process's own time."""
    took_ms = []
    for _ in range(times):
        began = time.process_time_ns()
        choose()
        took_ms.append((time.process_time_ns() - began) / 1e6)
    p50, p99 = np.percentile(took_ms, [50, 99])
    print(f"{name}: p50 {p50:.2f} ms, p99 {p99:.2f} ms")


def choices(times: int) -> None:
    """Print how long one choice takes in a corridor with a person in it."""
    walls = [(-1.0, 1.25, 9.0, 1.25), (-1.0, -1.25, 9.0, -1.25)]
    floor, at, now = Floor(walls, [(4.0, 0.0, 0.25)]), BasePose(2.0, 0.1, 0.1), STANDING
    for name, limits in (("forward", FORWARD), ("sideways", SIDEWAYS)):
        drive = Drive(floor, limits, 0.3, at, [(8.0, 0.0)])
        scan = drive.scan()
        seen = Seen.still(points_of(scan, BasePose(0.0, 0.0, 0.0)))
        window = DynamicWindow(limits, 0.3, PERIOD_S)
        steering = Steering((0.6, 0.1), 0.1)

        def choose_of_window(window=window, steering=steering, seen=seen) -> object:
            return window.choose(now, steering, seen)

        timed(f"dynamic window, {name}", choose_of_window, times)
        timed(f"whole choice, {name}", whole_choice(drive, scan), times)


def whole_choice(drive: Drive, scan: RangeScan) -> Callable[[], object]:
    """A new scan is taken in, a route is looked for, and a velocity is chosen."""
    time_s = 0.0

    def choose() -> object:
        nonlocal time_s
        drive.time_s = time_s = time_s + PERIOD_S
        return drive.choose(RangeScan(scan.ranges_m, scan.angles_rad, time_s))

    return choose


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--corridors", type=int, default=200)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--quick", action="store_true", help="ten corridors")
    arguments = parser.parse_args()
    warm_up()
    choices(300 if arguments.quick else 3000)
    corridors(arguments.first, 10 if arguments.quick else arguments.corridors)


if __name__ == "__main__":
    main()
