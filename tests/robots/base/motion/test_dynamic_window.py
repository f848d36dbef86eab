"""The dynamic window: what it commands keeps the limits, and lets the base stop in time."""

import math

import numpy as np
import pytest
from driven_floor import FORWARD, PERIOD_S, SIDEWAYS, moved, reached
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.robots.base.body import STANDING, BasePose, DriveLimits, Velocity
from mend.robots.base.motion.dynamic_window import MARGIN_M, DynamicWindow, Steering
from mend.robots.base.motion.surroundings import Seen

RADIUS_M = 0.3
ORIGIN = BasePose(0.0, 0.0, 0.0)
LIMITS = pytest.mark.parametrize("limits", [FORWARD, SIDEWAYS], ids=["forward", "sideways"])


def drawn_velocity(rng: np.random.Generator, limits: DriveLimits) -> Velocity:
    speed, turn = rng.uniform(0.0, limits.speed_m_s), rng.uniform(-1.0, 1.0) * limits.turn_rad_s
    bearing = rng.uniform(-math.pi, math.pi) if limits.sideways else 0.0
    return Velocity(speed * math.cos(bearing), speed * math.sin(bearing), turn)


def braking_room_m(at: BasePose, now: Velocity, limits: DriveLimits, points) -> float:
    """How near a base comes to any point that does nothing but brake."""
    window = DynamicWindow(limits, RADIUS_M, PERIOD_S)
    nearest_m = math.inf
    while True:
        offsets = points - np.array([at.x, at.y])
        nearest_m = min(nearest_m, float(np.hypot(*offsets.T).min()))
        if now == STANDING:
            return nearest_m - RADIUS_M
        now = window.brake(now)
        at = moved(at, now)


@LIMITS
@settings(max_examples=sample(50, 150), deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_it_can_still_stop_before_everything_that_stands(limits: DriveLimits, seed: int) -> None:
    rng = np.random.default_rng(seed)
    now, points = drawn_velocity(rng, limits), rng.uniform(-1.5, 1.5, (rng.integers(1, 12), 2))
    assume(braking_room_m(ORIGIN, now, limits, points) > MARGIN_M)
    towards = (rng.uniform(-2.0, 2.0), rng.uniform(-2.0, 2.0))
    steering = Steering(towards, rng.uniform(-3.0, 3.0))
    window = DynamicWindow(limits, RADIUS_M, PERIOD_S)
    told = window.choose(now, steering, Seen.still(points))
    after = reached(now, told, limits)
    assert braking_room_m(moved(ORIGIN, after), after, limits, points) > 0.0


@LIMITS
@settings(max_examples=100, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), speed=st.floats(0.1, 1.0))
def test_it_keeps_the_limits(limits: DriveLimits, seed: int, speed: float) -> None:
    rng = np.random.default_rng(seed)
    now, points = drawn_velocity(rng, limits), rng.uniform(-3.0, 3.0, (30, 2))
    steering = Steering((rng.uniform(-2.0, 2.0), rng.uniform(-2.0, 2.0)), rng.uniform(-3.0, 3.0))
    told = DynamicWindow(limits, RADIUS_M, PERIOD_S).choose(
        now, steering, Seen.still(points), speed
    )
    change = (told.forward_m_s - now.forward_m_s, told.left_m_s - now.left_m_s)
    assert math.hypot(*change) <= limits.acceleration_m_s2 * PERIOD_S + 1e-6
    turned = abs(told.turn_rad_s - now.turn_rad_s)
    assert turned <= limits.turn_acceleration_rad_s2 * PERIOD_S + 1e-6
    # Who has been faster slows down.
    assert told.speed_m_s <= max(speed * limits.speed_m_s, now.speed_m_s) + 1e-6
    assert abs(told.turn_rad_s) <= max(speed * limits.turn_rad_s, abs(now.turn_rad_s)) + 1e-6
    if not limits.sideways:
        assert told.left_m_s == 0.0
        assert told.forward_m_s >= 0.0


@LIMITS
def test_it_speeds_up_where_nothing_is_ahead(limits: DriveLimits) -> None:
    window, now = DynamicWindow(limits, RADIUS_M, PERIOD_S), STANDING
    for _ in range(40):
        now = window.choose(now, Steering((2.0, 0.0), 0.0), Seen.still(np.zeros((0, 2))))
    assert now.forward_m_s == pytest.approx(limits.speed_m_s)


@LIMITS
def test_what_comes_is_kept_farther_away_from_than_what_stands(limits: DriveLimits) -> None:
    now = Velocity(limits.speed_m_s / 2, 0.0, 0.0)
    points = np.array([[1.0, 0.0]])
    window = DynamicWindow(limits, RADIUS_M, PERIOD_S)
    stands = window.choose(now, Steering((2.0, 0.0), 0.0), Seen.still(points))
    comes = window.choose(now, Steering((2.0, 0.0), 0.0), Seen(points, np.array([1.5])))
    assert stands.speed_m_s >= now.speed_m_s
    assert comes == window.brake(now)


@LIMITS
def test_who_is_too_near_to_something_may_leave_it(limits: DriveLimits) -> None:
    behind = Seen.still(np.array([[-RADIUS_M - 0.5 * MARGIN_M, 0.0]]))
    window = DynamicWindow(limits, RADIUS_M, PERIOD_S)
    assert window.choose(STANDING, Steering((1.0, 0.0), 0.0), behind).forward_m_s > 0.0
    ahead = Seen.still(np.array([[RADIUS_M + 0.5 * MARGIN_M, 0.0]]))
    assert window.choose(STANDING, Steering((1.0, 0.0), 0.0), ahead).forward_m_s <= 0.0
