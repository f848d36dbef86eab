"""How long a base that goes sideways takes along a way if nothing is in it.

It goes as fast as its limits allow, rounds the bends, slower where there is no room to round them
wide, and turns as it is to stand: what the way follower and the dynamic window do, in closed form.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from mend.robots.base.base import SLOW_M_S, SLOW_RAD_S
from mend.robots.base.body import DriveLimits
from mend.robots.base.motion.way_follower import FACES_GOAL_M

Point = tuple[float, float]

# Measured on drives that `benchmarks/drive_times.py --steps` printed, with --first 1 and 101.
ROUNDS_FROM_M = 1.4
"""It leaves a leg so far before a bend, and is on the next one so far after it."""
ROUNDS_BY_M = 0.58
"""No farther from the bend than this: with the former, a right angle."""
CUTS_M = 1.6
"""A leg that is shorter, between two bends, it cuts through the middle."""
TURNS_BRAKING_RAD_S = 0.9
"""Who brakes brakes its turn as well, in every other cycle or so: it turns no faster then."""
SWINGS_S = 0.25
"""Who sets out at a right angle to where it faces swings off its way while it turns."""
_STRAIGHT_RAD = 1e-3


@dataclass(frozen=True, slots=True)
class _Piece:
    """A part of the way on which it goes no faster than so."""

    length_m: float
    fastest_m_s: float


def drive_s(
    way: Sequence[Point],
    starts_rad: float,
    ends_rad: float,
    limits: DriveLimits,
    period_s: float,
) -> float:
    """How long a drive takes along a way (metres), from standing to standing.

    `starts_rad` and `ends_rad`: how it faces, in the frame of the way; `period_s`: of its control.
    """
    corners = _corners(way)
    if len(corners) < 2:
        return _turn_s(abs(math.remainder(ends_rad - starts_rad, math.tau)), 0.0, limits)
    pieces = _pieces(corners, limits)
    off_rad = abs(math.remainder(_heading(*corners[:2]) - starts_rad, math.tau))
    swings_s = SWINGS_S * math.sin(min(off_rad, math.pi / 2.0))
    off_rad = abs(math.remainder(ends_rad - _heading(*corners[-2:]), math.tau))
    length_m = sum(each.length_m for each in pieces)
    along_s = _along_s(pieces, limits) + _lag_s(limits.speed_m_s / SLOW_M_S, period_s)
    turns_s = _left_to_turn_s(off_rad, length_m, limits)
    if turns_s > 0.0:
        turns_s += _lag_s(TURNS_BRAKING_RAD_S / SLOW_RAD_S, period_s)
    return swings_s + along_s + turns_s


def length_m(way: Sequence[Point]) -> float:
    """How long a way is from point to point."""
    return sum(math.dist(a, b) for a, b in pairwise(way))


def _corners(way: Sequence[Point]) -> list[Point]:
    """The points at which a way bends, with its ends; of a short leg between two bends the middle.

    It steers for what is so far ahead that it never follows such a leg.
    """
    points = _without_straight(way)
    legs = [
        (math.dist(a, b), number)
        for number, (a, b) in enumerate(pairwise(points[1:-1]), 1)
        if math.dist(a, b) < CUTS_M
    ]
    if not legs:
        return points
    _, number = min(legs)
    (x0, y0), (x1, y1) = points[number : number + 2]
    return _corners([*points[:number], ((x0 + x1) / 2.0, (y0 + y1) / 2.0), *points[number + 2 :]])


def _without_straight(way: Sequence[Point]) -> list[Point]:
    points: list[Point] = []
    for each in way:
        if points and math.dist(points[-1], each) < 1e-6:
            continue
        if len(points) > 1 and _bend(points[-2], points[-1], each) < _STRAIGHT_RAD:
            points.pop()
        points.append(each)
    return points


def _pieces(corners: Sequence[Point], limits: DriveLimits) -> list[_Piece]:
    """The straight parts of the way, and the arcs on which it rounds the bends."""
    legs_m = [math.dist(a, b) for a, b in pairwise(corners)]
    triples = zip(corners, corners[1:], corners[2:], strict=False)
    bends_rad = [0.0, *(_bend(*each) for each in triples), 0.0]
    pieces, used_m = [], 0.0
    for number in range(1, len(corners) - 1):
        bend_rad = bends_rad[number]
        # Two bends share the leg between them, the sharper one has more of it.
        before_m = legs_m[number - 1] * bend_rad / (bends_rad[number - 1] + bend_rad)
        after_m = legs_m[number] * bend_rad / (bend_rad + bends_rad[number + 1])
        room_m = min(before_m, after_m)
        from_m = min(ROUNDS_FROM_M, ROUNDS_BY_M / math.tan(bend_rad / 4.0), room_m)
        radius_m = from_m / math.tan(bend_rad / 2.0)
        # Its velocity turns with it: on an arc the turn alone is what limits it.
        fastest_m_s = min(limits.speed_m_s, max(limits.turn_rad_s * radius_m, 0.05))
        straight_m = max(0.0, legs_m[number - 1] - used_m - from_m)
        pieces.append(_Piece(straight_m, limits.speed_m_s))
        pieces.append(_Piece(radius_m * bend_rad, fastest_m_s))
        used_m = from_m
    pieces.append(_Piece(max(0.0, legs_m[-1] - used_m), limits.speed_m_s))
    return pieces


def _along_s(pieces: Sequence[_Piece], limits: DriveLimits) -> float:
    """From standing to standing along all pieces, as fast as the acceleration allows."""
    change = 2.0 * limits.acceleration_m_s2
    most = [0.0, *(min(a.fastest_m_s, b.fastest_m_s) for a, b in pairwise(pieces)), 0.0]
    for number, piece in enumerate(pieces):
        reached = math.sqrt(most[number] ** 2 + change * piece.length_m)
        most[number + 1] = min(most[number + 1], reached)
    for number in reversed(range(len(pieces))):
        allowed = math.sqrt(most[number + 1] ** 2 + change * pieces[number].length_m)
        most[number] = min(most[number], allowed)
    ends = pairwise(most)
    return sum(_piece_s(piece, *each, limits) for piece, each in zip(pieces, ends, strict=True))


def _piece_s(piece: _Piece, begin: float, end: float, limits: DriveLimits) -> float:
    acceleration = limits.acceleration_m_s2
    squares = begin**2 + end**2
    peak = min(piece.fastest_m_s, math.sqrt(squares / 2.0 + acceleration * piece.length_m))
    if peak <= 0.0:
        return 0.0
    changing_m = (2.0 * peak**2 - squares) / (2.0 * acceleration)
    changing_s = (2.0 * peak - begin - end) / acceleration
    return changing_s + max(0.0, piece.length_m - changing_m) / peak


def _left_to_turn_s(off_rad: float, length_m: float, limits: DriveLimits) -> float:
    """How long it still turns where the way ends: it has begun to a little before."""
    speed, acceleration = limits.speed_m_s, limits.acceleration_m_s2
    before_m, braking_m = min(FACES_GOAL_M, length_m), speed**2 / (2.0 * acceleration)
    before_s = math.sqrt(2.0 * min(before_m, braking_m) / acceleration)
    before_s += max(0.0, before_m - braking_m) / speed
    turning = min(TURNS_BRAKING_RAD_S, limits.turn_acceleration_rad_s2 * before_s)
    turned_rad = turning * before_s - turning**2 / (2.0 * limits.turn_acceleration_rad_s2)
    return _turn_s(off_rad - turned_rad, turning, limits) if off_rad > turned_rad else 0.0


def _turn_s(left_rad: float, turning_rad_s: float, limits: DriveLimits) -> float:
    """How long it takes to come to rest so far on, by who turns already."""
    change = limits.turn_acceleration_rad_s2
    peak = math.sqrt(change * left_rad + turning_rad_s**2 / 2.0)
    peak = min(max(peak, turning_rad_s), limits.turn_rad_s)
    if peak <= 0.0:
        return 0.0
    changing_rad = (2.0 * peak**2 - turning_rad_s**2) / (2.0 * change)
    return (2.0 * peak - turning_rad_s) / change + max(0.0, left_rad - changing_rad) / peak


def _lag_s(slows_by: float, period_s: float) -> float:
    """How much later it stands as it slows down by so much in steps.

    It goes so fast that it could still stop if it began a cycle later: to the end it nears it as an
    exponential does.
    """
    return period_s * math.log(slows_by)


def _heading(a: Point, b: Point) -> float:
    return math.atan2(b[1] - a[1], b[0] - a[0])


def _bend(a: Point, b: Point, c: Point) -> float:
    return abs(math.remainder(_heading(b, c) - _heading(a, b), math.tau))
