"""Robots that meet where they cannot pass each other: one of them makes way for the other.

Each robot that stands before another one which comes towards it is found a bay beside the other
one's way. Who has the shorter way to a bay takes it; who makes way already goes before who does
not, as priorities are inherited in Okumura et al. 2019, "Priority inheritance with backtracking for
iterative multi-agent path finding".
"""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mend.maps.building.building import Building, Floor
from mend.maps.building.cabin import CABIN_M, stop_of
from mend.maps.building.clearance import apart_m
from mend.maps.building.crossing import crossed_by
from mend.maps.building.floor_grid import FloorGrid, Mask, Matrix, Point, sampled

MEETS_M = 0.8
"""Who stands this much farther ahead than two robots that touch is what a robot stands before."""
APART_M = 0.2
"""So much room is left between two robots that pass each other: neither is exactly where it says.
"""
WALL_M = 0.08
"""So far from walls a robot makes way."""
AHEAD_M = 12.0
"""So much of the way of the other one is kept free."""
_OPEN_M = 0.8
"""A door is open for who stands so near to it."""
_EVERY = 2
"""So many cells of a way are one step of it."""
_LATER, _LATER_S = 1.3, 4.0
"""It all takes so much longer than it takes to drive."""
MOST_TIMES = 4
"""So often the same two resolve it in a row; after that people are asked."""
FORGET_S = 60.0
AGAIN_S = 2.0
"""So long two of whom neither could make way are not looked at again."""


@dataclass(frozen=True, slots=True)
class Standing:
    """A robot as it says where it is, in metres of its floor's frame.

    All of it is within `radius_m` of there; it drives at `speed_m_s`. `way`: from where it is to
    where it leaves the floor or ends, empty for who goes nowhere. `may_move`: whether it could make
    way now. `barred`: whether it drives, and what it sees leaves it no way on.
    """

    floor: str
    at: Point
    radius_m: float
    speed_m_s: float
    way: Sequence[Point] = ()
    may_move: bool = False
    barred: bool = False


@dataclass(frozen=True, slots=True)
class Yielding:
    """`robot` drives along `way` to a bay, and waits there for `other` until `until_s`."""

    robot: str
    other: str
    way: Sequence[Point]
    until_s: float


class RightOfWay:
    """Decides who makes way on one building's floors; times are of one clock."""

    def __init__(self, building: Building) -> None:
        self._building = building
        self._under_way: dict[str, Yielding] = {}
        self._times: dict[frozenset[str], tuple[int, float]] = {}
        self._again_s: dict[frozenset[str], float] = {}

    def making_way(self, now_s: float) -> Mapping[str, Yielding]:
        """Who makes way now."""
        self._under_way = {e: m for e, m in self._under_way.items() if now_s < m.until_s}
        return self._under_way

    def decide(self, standings: Mapping[str, Standing], now_s: float) -> Yielding | None:
        """Who is to make way, if anybody newly is."""
        resolved = {frozenset((e.robot, e.other)) for e in self.making_way(now_s).values()}
        for robot in (name for name, each in standings.items() if each.barred):
            other = self._met(robot, standings)
            if other is None:
                continue
            pair = frozenset((robot, other))
            if pair in resolved or self._resolved_often(pair, now_s):
                continue
            if now_s < self._again_s.get(pair, -math.inf):
                continue
            decided = self._between(robot, other, standings, now_s)
            if decided is not None:
                self._note(decided, now_s)
                return decided
            self._again_s[pair] = now_s + AGAIN_S
        return None

    def take_back(self, decided: Yielding, now_s: float) -> None:
        """What was decided comes to nothing; whether it can by then is looked at again later."""
        pair = frozenset((decided.robot, decided.other))
        self._under_way.pop(decided.robot, None)
        self._times.pop(pair, None)
        self._again_s[pair] = now_s + AGAIN_S

    # --- Within -------------------------------------------------------------------------------

    def _met(self, robot: str, standings: Mapping[str, Standing]) -> str | None:
        """Whom a robot stands before that would come where it stands; None for nobody."""
        mine = standings[robot]
        found = list[tuple[float, str]]()
        for name, other in standings.items():
            if name == robot or other.floor != mine.floor:
                continue
            away_m = math.dist(mine.at, other.at)
            near = away_m <= _touch_m(mine, other) + MEETS_M and self._bars(other, mine)
            if near and (self._bars(mine, other) or not other.way):
                found.append((away_m, name))
        return min(found, default=(0.0, None))[1]

    def _bars(self, one: Standing, other: Standing) -> bool:
        """Whether one stands on what is next of the way of the other."""
        if not other.way:
            return False
        touch_m = _touch_m(one, other)
        ahead = _first(sampled(other.way), touch_m + 2.0 * MEETS_M)
        away_m = np.hypot(*(ahead - one.at).T)
        nearest = int(np.argmin(away_m))
        # Who stands behind or beside is left behind.
        return nearest > 0 and bool(away_m[nearest] < touch_m + APART_M)

    def _between(
        self, robot: str, other: str, standings: Mapping[str, Standing], now_s: float
    ) -> Yielding | None:
        """Which of the two makes way, and how; None where neither can."""
        found = list[tuple[bool, float, str, Yielding]]()
        both = [(robot, other), (other, robot)] if standings[other].way else [(other, robot)]
        for one, for_whom in both:
            bay = self._bay(one, for_whom, standings) if standings[one].may_move else None
            if bay is not None:
                until_s = now_s + self._takes_s(bay, standings[one], standings[for_whom])
                makes = Yielding(one, for_whom, bay, until_s)
                found.append((one in self._under_way, _length_m(sampled(bay)), one, makes))
        return min(found, key=lambda each: each[:3])[3] if found else None

    def _bay(
        self, robot: str, other: str, standings: Mapping[str, Standing]
    ) -> Sequence[Point] | None:
        """The way to the nearest place off the other one's way; None where none leads there."""
        mine, theirs = standings[robot], standings[other]
        floor, grid = self._building.floors[mine.floor], FloorGrid(mine.at)
        here = [e for n, e in standings.items() if n != robot and e.floor == mine.floor]
        walls_m = grid.away_from_segments(self._walls(floor, (mine, theirs)))
        free = walls_m >= min(mine.radius_m + WALL_M, grid.at(walls_m, mine.at))
        rests = walls_m >= mine.radius_m + WALL_M
        for each in here:
            away_m, between_m = grid.away_from_point(each.at), _touch_m(mine, each)
            free &= away_m >= min(between_m + APART_M / 2.0, math.dist(mine.at, each.at) - 0.02)
            rests &= away_m >= between_m + APART_M
        rests &= grid.away_from(self._kept_free(theirs)) >= _touch_m(mine, theirs) + APART_M
        rests &= self._off_passages(mine.floor, grid, _touch_m(mine, theirs))
        reach = grid.reach(mine.at, free)
        metres = np.where(rests, reach.metres, math.inf)
        row, column = np.unravel_index(int(np.argmin(metres)), metres.shape)
        if not math.isfinite(metres[row, column]):
            return None
        way = grid.way(reach, (int(row), int(column)))
        return way[::-_EVERY][::-1] or None

    def _kept_free(self, other: Standing) -> Matrix:
        """The points of the way that is made for somebody."""
        return _first(sampled(other.way or [other.at]), AHEAD_M)

    def _walls(self, floor: Floor, robots: Collection[Standing]) -> Matrix:
        """Walls, and doors of which nothing says that they are open, as (n, 4)."""
        doors = np.array([(*a, *b) for a, b in (each.posts for each in floor.doors.values())])
        doors = doors.reshape(-1, 4)
        shut = np.ones(len(doors), np.bool_)
        for each in robots:
            shut &= apart_m(np.array([each.at]), doors)[0] > _OPEN_M
            for a, b in zip(each.way, each.way[1:], strict=False):
                shut[crossed_by(np.array([*a, *b]), doors)] = False
        return np.concatenate([floor.wall_segments, doors[shut]])

    def _off_passages(self, floor_name: str, grid: FloorGrid, touch_m: float) -> Mask:
        """Which cells bar neither a door nor a cabin."""
        floor = self._building.floors[floor_name]
        posts = np.array([(*a, *b) for a, b in (each.posts for each in floor.doors.values())])
        off = grid.away_from_segments(posts.reshape(-1, 4)) >= touch_m
        for elevator, each in self._building.document.elevators.items():
            if floor_name in each.stops:
                stop = stop_of(self._building, elevator, floor_name)
                off &= grid.away_from_point(stop) >= CABIN_M + touch_m
        return np.asarray(off)

    def _takes_s(self, bay: Sequence[Point], mine: Standing, other: Standing) -> float:
        """How long it takes until the other one is past where somebody makes way for it."""
        made = sampled(bay)
        ahead = self._kept_free(other)
        near_m = np.hypot(*(ahead[:, None] - made[None]).T).T.min(axis=1)
        passed = np.flatnonzero(near_m < _touch_m(mine, other) + APART_M)
        past = ahead[: 1 + (int(passed[-1]) if len(passed) else 0)]
        drives_s = _length_m(made) / mine.speed_m_s + _length_m(past) / other.speed_m_s
        return _LATER_S + _LATER * drives_s

    def _resolved_often(self, pair: frozenset[str], now_s: float) -> bool:
        times, last_s = self._times.get(pair, (0, -math.inf))
        return times >= MOST_TIMES and now_s < last_s + FORGET_S

    def _note(self, decided: Yielding, now_s: float) -> None:
        pair = frozenset((decided.robot, decided.other))
        times, last_s = self._times.get(pair, (0, -math.inf))
        self._times[pair] = (times + 1 if now_s < last_s + FORGET_S else 1), decided.until_s
        self._under_way[decided.robot] = decided


def _touch_m(one: Standing, other: Standing) -> float:
    """How far apart the middles of two are that touch."""
    return one.radius_m + other.radius_m


def _first(points: Matrix, metres: float) -> Matrix:
    """As many of points one after the other as are within so much of their way."""
    far_m = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    return points[far_m <= metres + 1e-9]


def _length_m(points: Matrix) -> float:
    return float(np.hypot(*np.diff(points, axis=0).T).sum())
