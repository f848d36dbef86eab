"""The dynamic window: of the velocities that are reached within a cycle, the best that is safe.

Fox, Burgard & Thrun, "The Dynamic Window Approach to Collision Avoidance" (IEEE Robotics &
Automation Magazine 1997). Where the base would come to rest if it braked after one cycle says how
good a velocity is; how near its arc comes to what the laser shows, whether it may be had.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mend.robots.base.body import STANDING, DriveLimits, Velocity
from mend.robots.base.motion.arcs import measure_room
from mend.robots.base.motion.surroundings import Seen

Array = NDArray[np.float64]

MARGIN_M = 0.03
"""It keeps so far from everything: more than a laser's noise, and than what a cycle hides."""
_AMPLE_M = 0.3
"""More room than this is no better."""
_CLEARANCE = 0.5
"""A metre nearer to things is worth so much of a metre of way: below 1, so that no narrow place
that is wide enough stops it."""
_POINT_M = 0.1
"""Nearer to what it steers for than this, it matters less and less how it faces it."""
_SPEEDS, _TURNS = 7, 11
_RINGS = np.linspace(0.0, 1.0, 4)[1:]
_DIRECTIONS = np.linspace(0.0, math.tau, 16, endpoint=False)
_CHANGES = np.concatenate(
    [
        np.zeros((1, 2)),
        *(ring * np.column_stack([np.cos(_DIRECTIONS), np.sin(_DIRECTIONS)]) for ring in _RINGS),
    ]
)
"""From no change of a velocity to the greatest, in each direction."""


@dataclass(frozen=True, slots=True)
class Steering:
    """What the base steers for, in its own frame.

    `towards`: a point to be able to stop at, None to stay; `turn_rad`: how far to turn, of who
    need not face where it goes.
    """

    towards: tuple[float, float] | None
    turn_rad: float


class DynamicWindow:
    """Chooses the velocities of one base, a cycle at a time."""

    def __init__(self, limits: DriveLimits, radius_m: float, period_s: float) -> None:
        self._limits, self._radius_m, self._period_s = limits, radius_m, period_s

    def choose(self, now: Velocity, steering: Steering, seen: Seen, speed: float = 1.0) -> Velocity:
        """The velocity of the next cycle.

        `seen` is in the base's frame; `speed` in (0, 1] scales what it does at most. It brakes as
        hard as it can where nothing else is safe.
        """
        candidates = self._candidates(now, steering, speed)
        room_m = self._room_m(candidates, seen, now)
        safe = room_m >= 0.0
        if not safe.any():
            return self.brake(now)
        cost_s = self._needed_s(candidates, steering)
        cost_s -= _CLEARANCE * np.minimum(room_m, _AMPLE_M) / self._limits.speed_m_s
        forward, left, turn = candidates[np.argmin(np.where(safe, cost_s, np.inf))]
        return Velocity(float(forward), float(left), float(turn))

    def brake(self, now: Velocity) -> Velocity:
        """Slow down as hard as the limits allow, on the arc that it is on."""
        braking_s = float(self._braking_s(_row(now))[0])
        if braking_s <= self._period_s:
            return STANDING
        share = 1.0 - self._period_s / braking_s
        return Velocity(now.forward_m_s * share, now.left_m_s * share, now.turn_rad_s * share)

    # --- What may be had ----------------------------------------------------------------------

    def _candidates(self, now: Velocity, steering: Steering, speed: float) -> Array:
        brake = self.brake(now)
        window = self._sideways if self._limits.sideways else self._forward
        return np.concatenate([_row(brake), window(now, steering, speed)])

    def _forward(self, now: Velocity, steering: Steering, speed: float) -> Array:
        """Of a base that goes forward, and turns."""
        limits, period_s = self._limits, self._period_s
        off_m, bearing = _polar(steering.towards)
        if steering.towards is None:
            bearing = steering.turn_rad
        change = limits.acceleration_m_s2 * period_s
        fastest = min(speed * limits.speed_m_s, self._to_rest(off_m, limits.acceleration_m_s2))
        low, high = _within(now.forward_m_s - change, now.forward_m_s + change, 0.0, fastest)
        turns = self._turns(now, bearing, speed)
        forward, turn = np.meshgrid(np.linspace(low, high, _SPEEDS), turns)
        return np.column_stack([forward.ravel(), np.zeros(forward.size), turn.ravel()])

    def _sideways(self, now: Velocity, steering: Steering, speed: float) -> Array:
        """Of a base that goes anywhere: it turns as it should, and may go in any direction."""
        limits, period_s = self._limits, self._period_s
        off_m, bearing = _polar(steering.towards)
        change = limits.acceleration_m_s2 * period_s
        fastest = min(speed * limits.speed_m_s, self._to_rest(off_m, limits.acceleration_m_s2))
        moving = np.array([now.forward_m_s, now.left_m_s])
        ideal = fastest * np.array([math.cos(bearing), math.sin(bearing)]) - moving
        ideal *= min(1.0, change / max(math.hypot(*ideal), 1e-12))
        reached = moving + np.concatenate([ideal[None], change * _CHANGES])
        speeds = np.hypot(*reached.T)
        slowest = max(0.0, now.speed_m_s - change)
        reached *= np.minimum(1.0, max(fastest, slowest) / np.maximum(speeds, 1e-12))[:, None]
        reached = reached[np.hypot(*(reached - moving).T) <= change + 1e-9]
        turn = self._resting_turn(now, steering.turn_rad, speed)
        return np.column_stack([reached, np.full(len(reached), turn)])

    def _turns(self, now: Velocity, off_rad: float, speed: float) -> Array:
        """What turns are in the window; the last is the one that comes to rest where it should."""
        turns = np.linspace(*self._turn_window(now, speed), _TURNS)
        return np.append(turns, self._resting_turn(now, off_rad, speed))

    def _resting_turn(self, now: Velocity, off_rad: float, speed: float) -> float:
        """The turn in the window that comes to rest where it should, or nearest to it."""
        low, high = self._turn_window(now, speed)
        acceleration = self._limits.turn_acceleration_rad_s2
        rests = min(speed * self._limits.turn_rad_s, self._to_rest(abs(off_rad), acceleration))
        return min(max(math.copysign(rests, off_rad), low), high)

    def _turn_window(self, now: Velocity, speed: float) -> tuple[float, float]:
        change = self._limits.turn_acceleration_rad_s2 * self._period_s
        most = speed * self._limits.turn_rad_s
        return _within(now.turn_rad_s - change, now.turn_rad_s + change, -most, most)

    def _to_rest(self, left: float, acceleration: float) -> float:
        """The velocity that, after one cycle and braking, has come just so far."""
        period_s = self._period_s
        return acceleration * (math.sqrt(period_s**2 + 2.0 * left / acceleration) - period_s)

    # --- What is safe -------------------------------------------------------------------------

    def _room_m(self, candidates: Array, seen: Seen, now: Velocity) -> Array:
        """How near each comes to anything, negative where it is not safe.

        What is ahead may itself begin to come as fast as the base goes: it could still stop before
        that. From what comes already it keeps as far as that comes until the base stands.
        """
        times_s = 2.0 * self._rests_s(candidates)
        stands_s = 2.0 * self._period_s + float(self._braking_s(_row(now))[0])
        needs_m = self._radius_m + MARGIN_M + seen.speeds_m_s * stands_s
        speeds = np.hypot(candidates[:, 0], candidates[:, 1])
        away_m = np.hypot(seen.points[:, 0], seen.points[:, 1])
        near = away_m < needs_m + _AMPLE_M + float((speeds * times_s).max())
        # What is nearer than it should be may be left, and not be neared.
        needs_m = np.minimum(needs_m, away_m - 1e-6)
        room_m = np.full(len(candidates), _AMPLE_M)
        measure_room(seen.points[near], needs_m[near], candidates, times_s, room_m)
        return room_m

    def _braking_s(self, velocities: Array) -> Array:
        speeds = np.hypot(velocities[:, 0], velocities[:, 1])
        return np.maximum(
            speeds / self._limits.acceleration_m_s2,
            np.abs(velocities[:, 2]) / self._limits.turn_acceleration_rad_s2,
        )

    def _rests_s(self, candidates: Array) -> Array:
        """For how long each would be held to come as far as in one cycle and braking after it."""
        return self._period_s + self._braking_s(candidates) / 2.0

    # --- What is good -------------------------------------------------------------------------

    def _needed_s(self, candidates: Array, steering: Steering) -> Array:
        """How long it takes at best from where each comes to rest: turning, then going straight."""
        held_s = self._rests_s(candidates)
        turned = candidates[:, 2] * held_s
        if steering.towards is None:
            speeds = np.hypot(candidates[:, 0], candidates[:, 1])
            slow = speeds / self._limits.acceleration_m_s2
            return slow + np.abs(steering.turn_rad - turned) / self._limits.turn_rad_s
        x, y = _moved(candidates, held_s)
        off_x, off_y = steering.towards[0] - x, steering.towards[1] - y
        off_m = np.hypot(off_x, off_y)
        needed_s = off_m / self._limits.speed_m_s
        if self._limits.sideways:
            return needed_s
        facing = np.abs(_wrapped(np.arctan2(off_y, off_x) - turned))
        matters = np.minimum(1.0, off_m / _POINT_M)
        return needed_s + matters * facing / self._limits.turn_rad_s


def _moved(velocities: Array, times_s: Array) -> tuple[Array, Array]:
    """Where each leads, on an arc, in the frame in which it began."""
    turned = velocities[:, 2] * times_s
    half = turned / 2.0
    chord_s = times_s * np.sinc(half / np.pi)
    cos, sin = np.cos(half) * chord_s, np.sin(half) * chord_s
    forward, left = velocities[:, 0], velocities[:, 1]
    return cos * forward - sin * left, sin * forward + cos * left


def _row(velocity: Velocity) -> Array:
    return np.array([[velocity.forward_m_s, velocity.left_m_s, velocity.turn_rad_s]])


def _polar(point: tuple[float, float] | None) -> tuple[float, float]:
    """How far a point is, and in which direction; 0 and straight ahead for none."""
    return (0.0, 0.0) if point is None else (math.hypot(*point), math.atan2(point[1], point[0]))


def _within(low: float, high: float, least: float, most: float) -> tuple[float, float]:
    """The part of low..high within least..most, or of it what is nearest to that."""
    return min(max(low, least), high), max(min(high, most), low)


def _wrapped(angles: Array) -> Array:
    return np.asarray(np.remainder(angles + math.pi, math.tau) - math.pi)
