"""Floors with walls and round things, drawn by a seed, and a base that drives over them."""

import math
import random
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from shapely.geometry import LineString

from mend.robots.base.body import STANDING, BasePose, DriveLimits, RangeScan, Velocity
from mend.robots.base.motion.headway import Headway
from mend.robots.base.motion.surroundings import Surroundings
from mend.robots.base.motion.way_follower import WayFollower

Circle = tuple[float, float, float]
Segment = tuple[float, float, float, float]

PERIOD_S = 0.05
BEAMS = np.linspace(-math.pi, math.pi, 361)
REACH_M = 10.0
NOISE_M = 0.01
PATIENCE_S, HEADWAY_S, LONGEST_S = 5.0, 20.0, 300.0
NEAR_M, TURNED_RAD, SLOW_M_S = 0.05, 0.09, 0.05

FORWARD = DriveLimits(0.8, 1.5, 1.6, 3.2, sideways=False)
SIDEWAYS = DriveLimits(1.0, 1.0, 1.5, 2.0, sideways=True)


@dataclass
class Floor:
    """Walls (x0, y0, x1, y1) and round things (x, y, radius), metres."""

    walls: list[Segment] = field(default_factory=list)
    things: list[Circle] = field(default_factory=list)

    def ranges_m(self, at: BasePose) -> NDArray[np.float64]:
        """What a laser measures, without noise."""
        cos, sin = np.cos(BEAMS + at.yaw), np.sin(BEAMS + at.yaw)
        nearest = np.full(len(BEAMS), np.inf)
        with np.errstate(divide="ignore", invalid="ignore"):
            for x0, y0, x1, y1 in self.walls:
                ex, ey = x1 - x0, y1 - y0
                across = cos * ey - sin * ex
                away = ((x0 - at.x) * ey - (y0 - at.y) * ex) / across
                share = ((x0 - at.x) * sin - (y0 - at.y) * cos) / across
                hit = (away > 0.0) & (share >= 0.0) & (share <= 1.0)
                nearest = np.where(hit & (away < nearest), away, nearest)
        for x, y, radius in self.things:
            dx, dy = x - at.x, y - at.y
            middle = dx * cos + dy * sin
            behind = radius**2 - (dx * dx + dy * dy - middle**2)
            away = middle - np.sqrt(np.maximum(behind, 0.0))
            hit = (behind > 0.0) & (away > 0.0)
            nearest = np.where(hit & (away < nearest), away, nearest)
        return np.where(nearest > REACH_M, np.inf, nearest)

    def free_m(self, xy: NDArray[np.float64]) -> NDArray[np.float64]:
        """How far each of some points (n, 2) is from everything."""
        least = np.full(len(xy), np.inf)
        for x0, y0, x1, y1 in self.walls:
            along = np.array([x1 - x0, y1 - y0])
            offset = xy - np.array([x0, y0])
            share = np.clip(offset @ along / (along @ along), 0.0, 1.0)
            least = np.minimum(least, np.hypot(*(offset - share[:, None] * along).T))
        for x, y, radius in self.things:
            least = np.minimum(least, np.hypot(xy[:, 0] - x, xy[:, 1] - y) - radius)
        return least


@dataclass(frozen=True)
class Driven:
    """How a drive ended (arrived, barred, stalled, endless), and how near it came to things."""

    end: str
    took_s: float
    nearest_m: float
    at: BasePose


def reached(now: Velocity, told: Velocity, limits: DriveLimits) -> Velocity:
    """What a base has after a cycle in which it was told a velocity."""
    forward, left = told.forward_m_s - now.forward_m_s, told.left_m_s - now.left_m_s
    most = limits.acceleration_m_s2 * PERIOD_S
    share = min(1.0, most / max(math.hypot(forward, left), 1e-12))
    most = limits.turn_acceleration_rad_s2 * PERIOD_S
    turn = max(-most, min(most, told.turn_rad_s - now.turn_rad_s))
    return Velocity(
        now.forward_m_s + share * forward, now.left_m_s + share * left, now.turn_rad_s + turn
    )


def moved(at: BasePose, velocity: Velocity) -> BasePose:
    """Where a base is after a cycle."""
    turned = velocity.turn_rad_s * PERIOD_S
    heading, chord_s = at.yaw + turned / 2.0, PERIOD_S * float(np.sinc(turned / 2.0 / np.pi))
    cos, sin = math.cos(heading), math.sin(heading)
    return BasePose(
        at.x + chord_s * (cos * velocity.forward_m_s - sin * velocity.left_m_s),
        at.y + chord_s * (sin * velocity.forward_m_s + cos * velocity.left_m_s),
        at.yaw + turned,
    )


class Drive:
    """One base that follows one way over a floor that may change meanwhile."""

    def __init__(
        self,
        floor: Floor,
        limits: DriveLimits,
        radius_m: float,
        start: BasePose,
        way: list[tuple[float, float]],
        goal_yaw: float = 0.0,
        noise: np.random.Generator | None = None,
        speed: float = 1.0,
    ) -> None:
        self.floor, self.limits, self.radius_m = floor, limits, radius_m
        self.at, self.now, self.time_s = start, STANDING, 0.0
        self.goal = BasePose(*way[-1], goal_yaw)
        self.nearest_m = math.inf
        self.told: list[Velocity] = []
        self._noise, self._speed = noise, speed
        self._follower = WayFollower(
            limits, radius_m, PERIOD_S, [(start.x, start.y), *way], self.goal
        )
        self._surroundings, self._headway = Surroundings(), Headway(limits.turn_rad_s)
        self._barred_s = 0.0

    def scan(self) -> RangeScan:
        ranges_m = self.floor.ranges_m(self.at)
        if self._noise is not None:
            ranges_m = ranges_m + self._noise.normal(0.0, NOISE_M, len(ranges_m))
        return RangeScan(ranges_m, BEAMS, self.time_s)

    def choose(self, scan: RangeScan) -> Velocity:
        seen = self._surroundings.take(scan, self.at, self.time_s)
        return self._follower.choose(self.at, self.now, seen, self._speed, scan.time)

    def step(self) -> str | None:
        """One cycle; how it ended, if it did."""
        self.told.append(self.choose(self.scan()))
        self.now = reached(self.now, self.told[-1], self.limits)
        self.at = moved(self.at, self.now)
        self.time_s += PERIOD_S
        free_m = float(self.floor.free_m(np.array([[self.at.x, self.at.y]]))[0])
        self.nearest_m = min(self.nearest_m, free_m - self.radius_m)
        return self._ended()

    def run(self) -> Driven:
        end = None
        while end is None:
            end = self.step()
        return Driven(end, self.time_s, self.nearest_m, self.at)

    @property
    def barred(self) -> bool:
        """Whether it stands, or is about to, as there is no way on."""
        return self._follower.barred

    def _ended(self) -> str | None:
        there = self.at.distance_m(self.goal) <= NEAR_M
        if there and self.at.turned_by_rad(self.goal) <= TURNED_RAD and self._slow:
            return "arrived"
        self._barred_s = self._barred_s + PERIOD_S if self.barred and self._slow else 0.0
        self._note_headway()
        if self._barred_s >= PATIENCE_S:
            return "barred"
        if self._headway.stalled_s >= HEADWAY_S:
            return "stalled"
        return "endless" if self.time_s > LONGEST_S else None

    def _note_headway(self) -> None:
        follower = self._follower
        if not follower.barred:
            turn_rad = self.at.turned_by_rad(self.goal) if follower.turns_at_end else None
            self._headway.note(follower.left_m, turn_rad, PERIOD_S)

    @property
    def _slow(self) -> bool:
        return self.now.speed_m_s < SLOW_M_S


# --- Drawn floors -----------------------------------------------------------------------------


@dataclass(frozen=True)
class Corridor:
    """A closed corridor with round things in it, and the way along its middle."""

    floor: Floor
    start: BasePose
    way: list[tuple[float, float]]


def drawn_corridor(seed: int, radius_m: float) -> Corridor:
    """One to four legs, 1.2 to 3 m wide, and up to an obstacle for every 0.8 m of it."""
    rng = random.Random(seed)
    heading, corners = 0.0, [(0.0, 0.0)]
    for _ in range(rng.randint(1, 4)):
        length_m = rng.uniform(4.0, 8.0)
        x, y = corners[-1]
        corners.append((x + length_m * math.cos(heading), y + length_m * math.sin(heading)))
        heading += rng.choice([-1.0, 1.0]) * rng.uniform(0.3, math.pi / 2)
    width_m = rng.uniform(1.2, 3.0)
    middle = LineString(corners)
    hull = middle.buffer(width_m / 2, cap_style="square", join_style="mitre")
    rim = [*hull.exterior.coords]
    walls = [(*a, *b) for a, b in pairwise(rim)]
    things: list[Circle] = []
    for _ in range(rng.randint(0, int(middle.length / 0.8))):
        point = middle.interpolate(rng.uniform(0.0, middle.length))
        across_m, bearing = rng.uniform(0.0, width_m / 2), rng.uniform(0.0, math.tau)
        radius = rng.uniform(0.05, 0.4)
        x = point.x + across_m * math.cos(bearing)
        y = point.y + across_m * math.sin(bearing)
        if min(math.hypot(x, y), math.dist((x, y), corners[-1])) > radius + radius_m + 0.15:
            things.append((x, y, radius))
    start = BasePose(0.0, 0.0, rng.uniform(-math.pi, math.pi))
    return Corridor(Floor(walls, things), start, corners[1:])


def has_way(corridor: Corridor, needs_m: float, cell_m: float = 0.025) -> bool:
    """Whether the middle of a base gets to the end with `needs_m` of room on every side."""
    walls = np.array(corridor.floor.walls)
    low = walls.reshape(-1, 2).min(axis=0)
    columns, rows = (np.ptp(walls.reshape(-1, 2), axis=0) / cell_m).astype(int) + 1
    grid = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).reshape(-1, 2)
    free = corridor.floor.free_m(low + grid * cell_m).reshape(rows, columns) >= needs_m
    cells = [
        tuple(np.round((np.array(each) - low) / cell_m).astype(int)[::-1])
        for each in [(corridor.start.x, corridor.start.y), corridor.way[-1]]
    ]
    waiting, seen = [cells[0]], {cells[0]}
    while waiting:
        row, column = waiting.pop()
        if (row, column) == cells[1]:
            return True
        for to in [(row + 1, column), (row - 1, column), (row, column + 1), (row, column - 1)]:
            if 0 <= to[0] < rows and 0 <= to[1] < columns and free[to] and to not in seen:
                seen.add(to)
                waiting.append(to)
    return False
