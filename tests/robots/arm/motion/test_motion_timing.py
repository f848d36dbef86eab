"""Motions keep to their curve and their limits, however the speed is changed on the way."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sampled import sample

from mend.robots.arm.motion.curve import JointCurve
from mend.robots.arm.motion.limits import MotionLimits
from mend.robots.arm.motion.timing import TimedMotion

PERIOD_S = 1 / 240
LIMITS = MotionLimits(
    velocity_rad_s=1.6, acceleration_rad_s2=5.0, jerk_rad_s3=40.0, tool_velocity_m_s=0.35
)

knot = st.lists(st.floats(-2.0, 2.0), min_size=3, max_size=3).map(np.array)


def run(motion: TimedMotion, most: int = 20_000) -> np.ndarray:
    """The joint angles of every cycle."""
    angles = []
    while not motion.finished:
        angles.append(motion.advance()[0])
        assert len(angles) < most
    return np.array(angles)


def bent() -> JointCurve:
    """A curve like that of a straight line of the tool, its parameter in metres."""
    way = np.linspace(0.0, 0.14, 9)
    knots = [np.array([0.2 + 3 * s, np.sin(9 * s), -1.0 + 14 * s * s]) for s in way]
    return JointCurve(knots, way.tolist())


@settings(max_examples=30, deadline=None)
@given(start=knot, end=knot, speed=st.floats(0.1, 1.0))
def test_a_move_ends_where_it_should_and_keeps_all_limits(
    start: np.ndarray, end: np.ndarray, speed: float
) -> None:
    curve = JointCurve([start, end])
    angles = run(TimedMotion(curve, LIMITS, PERIOD_S, speed))
    if len(angles) == 0:
        assert np.allclose(start, end, atol=1e-5)
        return
    assert np.allclose(angles[-1], end, atol=1e-9)
    still = np.repeat(angles[-1:], 3, axis=0)
    padded = np.concatenate([np.repeat(start[None], 3, axis=0), angles, still])
    velocity = np.diff(padded, axis=0) / PERIOD_S
    acceleration = np.diff(velocity, axis=0) / PERIOD_S
    jerk = np.diff(acceleration, axis=0) / PERIOD_S
    assert np.abs(velocity).max() <= LIMITS.velocity_rad_s * speed * 1.001 + 1e-6
    assert np.abs(acceleration).max() <= LIMITS.acceleration_rad_s2 * 1.01 + 1e-3
    # The last cycle ends the motion wherever in the cycle it was over.
    assert np.abs(jerk).max() <= LIMITS.jerk_rad_s3 * 1.05 + 0.5


def test_a_bent_curve_keeps_all_limits() -> None:
    angles = run(TimedMotion(bent(), LIMITS, PERIOD_S, straight=True))
    velocity = np.diff(angles, axis=0) / PERIOD_S
    acceleration = np.diff(velocity, axis=0) / PERIOD_S
    jerk = np.diff(acceleration, axis=0) / PERIOD_S
    assert np.abs(velocity).max() <= LIMITS.velocity_rad_s
    assert np.abs(acceleration).max() <= LIMITS.acceleration_rad_s2 * 1.01
    assert np.abs(jerk).max() <= LIMITS.jerk_rad_s3 * 1.05 + 0.5


def test_the_tool_keeps_its_limit_on_a_straight_line() -> None:
    curve = JointCurve([np.zeros(2), np.full(2, 0.01)], [0.0, 0.5])
    motion = TimedMotion(curve, LIMITS, PERIOD_S, straight=True)
    done = [0.0]
    while not motion.finished:
        motion.advance()
        done.append(motion.progress * 0.5)
    fastest = max(after - before for before, after in pairwise(done)) / PERIOD_S
    assert 0.3 < fastest <= LIMITS.tool_velocity_m_s + 1e-6


@settings(max_examples=sample(6, 20), deadline=None)
@given(changes=st.lists(st.tuples(st.integers(0, 200), st.floats(0.05, 1.0)), max_size=5))
def test_a_changed_speed_never_leaves_the_curve_nor_turns_back(
    changes: list[tuple[int, float]],
) -> None:
    curve = bent()
    motion = TimedMotion(curve, LIMITS, PERIOD_S, straight=True)
    at = dict(changes)
    progress = [0.0]
    while not motion.finished:
        if len(progress) in at:
            motion.set_speed(at[len(progress)])
        angles, _ = motion.advance()
        progress.append(motion.progress)
        assert np.allclose(angles, curve.at(motion.progress * curve.length), atol=1e-9)
        assert len(progress) < 20_000
    assert min(after - before for before, after in pairwise(progress)) > -1e-6
    assert progress[-1] == 1.0


def test_velocities_are_the_change_of_the_angles() -> None:
    motion = TimedMotion(bent(), LIMITS, PERIOD_S, straight=True)
    before, _ = motion.advance()
    for _ in range(30):
        after, velocity = motion.advance()
        # The velocity is the one at the cycle's end, the difference its mean over the cycle.
        assert np.allclose((after - before) / PERIOD_S, velocity, atol=0.05)
        before = after


@pytest.mark.parametrize("speed", [0.0, -0.5, 1.5])
def test_a_speed_outside_its_range_is_refused(speed: float) -> None:
    motion = TimedMotion(bent(), LIMITS, PERIOD_S)
    with pytest.raises(ValueError, match="above 0 and at most 1"):
        motion.set_speed(speed)


def test_a_move_to_where_the_arm_is_takes_no_time() -> None:
    assert TimedMotion(JointCurve([np.ones(3)]), LIMITS, PERIOD_S).finished


def test_a_limit_of_zero_is_refused() -> None:
    with pytest.raises(ValueError, match="jerk_rad_s3 is 0"):
        MotionLimits(1.0, 1.0, 0.0, 1.0)


def test_a_curve_is_joined_from_where_the_arm_stopped() -> None:
    curve = bent()
    here = curve.at(0.06) + 0.004
    rest = curve.joined_from(here)
    assert np.allclose(rest.at(0.0), here)
    assert np.allclose(rest.end, curve.end)
    assert rest.length == pytest.approx(curve.length - 0.06, abs=0.005)


def test_a_curve_needs_knots_and_fitting_parameters() -> None:
    with pytest.raises(ValueError, match="needs knots"):
        JointCurve([])
    with pytest.raises(ValueError, match="needs knots"):
        JointCurve([np.zeros(2)], [0.0, 1.0])
