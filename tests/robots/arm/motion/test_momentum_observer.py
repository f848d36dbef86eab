"""The momentum observer: it follows what pushes from outside, and nothing that the motors do."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.robots.arm.motion.momentum_observer import MomentumObserver, force_at_tool

PERIOD_S = 1 / 240
LENGTH_M, MASS_KG, GRAVITY = 0.5, 2.0, 9.81


class Pendulum:
    """A point mass on one joint; the angle is 0 where it hangs."""

    inertia = MASS_KG * LENGTH_M**2

    def momentum_and_drift(
        self, angles: np.ndarray, velocities: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        return self.inertia * velocities, -MASS_KG * GRAVITY * LENGTH_M * np.sin(angles)

    def tool_jacobian(self, angles: np.ndarray) -> np.ndarray:
        return LENGTH_M * np.array([[np.cos(angles[0])], [0.0], [np.sin(angles[0])]])


def swing(motor_nm: float, outside_nm: float, cycles: int, begins: int) -> list[float]:
    """The residual of every cycle of a pendulum that something pushes from a cycle on."""
    model, observer = Pendulum(), MomentumObserver(Pendulum(), rate_hz=6.0)
    angle, velocity, residuals = np.array([0.3]), np.array([0.0]), []
    observer.update(angle, velocity, np.array([motor_nm]), PERIOD_S)
    for cycle in range(cycles):
        outside = outside_nm if cycle >= begins else 0.0
        _, drift = model.momentum_and_drift(angle, velocity)
        velocity = velocity + (motor_nm + outside + drift) / model.inertia * PERIOD_S
        angle = angle + velocity * PERIOD_S
        observer.update(angle, velocity, np.array([motor_nm]), PERIOD_S)
        residuals.append(float(observer.residual[0]))
    return residuals


@settings(max_examples=50, deadline=None)
@given(motor_nm=st.floats(-3.0, 3.0), outside_nm=st.floats(-8.0, 8.0))
def test_it_follows_what_pushes_within_its_time_constant(motor_nm, outside_nm) -> None:
    residuals = swing(motor_nm, outside_nm, cycles=160, begins=80)
    assert max(np.abs(residuals[:80])) < 0.5
    assert residuals[-1] == pytest.approx(outside_nm, abs=0.1 * abs(outside_nm) + 0.5)
    after = residuals[80 + 12] - residuals[79]
    assert abs(after) >= 0.6 * abs(outside_nm) - 0.7


def test_after_a_reset_it_knows_nothing() -> None:
    observer = MomentumObserver(Pendulum(), rate_hz=6.0)
    for _ in range(50):
        observer.update(np.zeros(1), np.zeros(1), np.array([1.0]), PERIOD_S)
    assert abs(observer.residual[0]) > 0.5
    observer.reset()
    observer.update(np.zeros(1), np.ones(1), np.zeros(1), PERIOD_S)
    assert observer.residual[0] == 0.0


@given(
    force=st.tuples(*[st.floats(-50.0, 50.0)] * 3),
    seed=st.integers(0, 1000),
)
def test_a_force_is_found_again_from_the_torques_that_it_makes(force, seed) -> None:
    jacobian = np.random.default_rng(seed).normal(size=(3, 7))
    torques = jacobian.T @ np.array(force)
    noise = np.linspace(0.8, 0.1, 7)
    assert force_at_tool(jacobian, torques, noise) == pytest.approx(np.array(force), abs=0.02)
