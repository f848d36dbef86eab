"""Wheels and lasers of a building's robots: wrong by as much as they say, and the same again."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.sim.building.draws import read_draws, written_draws
from mend.sim.building.laser_noise import LaserNoise, measured_m
from mend.sim.building.odometry import Odometer, OdometryNoise

TRUE_WHEELS = OdometryNoise(0, 0, 0, 0, 0, 0, 0, 0, 0, 0)
NO_SLIP = OdometryNoise(slips_per_m=0.0, scale=0.0, turn_scale=0.0, pull_rad_per_m=0.0)


def driven(seed: int, steps: int, noise: OdometryNoise, way_m: float = 10.0) -> Odometer:
    odometer = Odometer(np.random.default_rng(seed), noise)
    for _ in range(steps):
        odometer.drive(way_m / steps, 0.0, 0.0)
    return odometer


@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-3.0, 3.0))
def test_true_wheels_measure_what_was_driven(ahead: float, left: float, turned: float) -> None:
    odometer = Odometer(np.random.default_rng(1), TRUE_WHEELS)
    odometer.drive(ahead, left, turned)
    x, y, yaw = odometer.pose
    assert math.hypot(x, y) == pytest.approx(math.hypot(ahead, left))
    assert yaw == pytest.approx(turned)


def test_who_stands_measures_nothing() -> None:
    odometer = Odometer(np.random.default_rng(1))
    odometer.drive(0.0, 0.0, 0.0)
    assert odometer.pose == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("steps", [20, 200])
def test_errors_do_not_depend_on_how_small_the_steps_are(steps: int) -> None:
    ends = np.array([driven(seed, steps, NO_SLIP).pose for seed in range(300)])
    assert np.std(ends[:, 0]) == pytest.approx(0.02 * math.sqrt(10.0), rel=0.25)
    assert np.std(ends[:, 2]) == pytest.approx(0.01 * math.sqrt(10.0), rel=0.25)


def test_wheels_that_slip_measure_more_than_was_driven() -> None:
    slips = OdometryNoise(0, 0, 0, 0, 0, 0, 0, slips_per_m=5.0, slip_m=0.3, slip_share=0.5)
    measured = [driven(seed, 200, slips).pose[0] for seed in range(20)]
    assert min(measured) >= 10.0 - 1e-9
    assert np.mean(measured) > 10.5


def test_an_odometer_goes_on_from_a_snapshot() -> None:
    rng, other_rng = np.random.default_rng(3), np.random.default_rng(4)
    odometer, other = Odometer(rng), Odometer(other_rng)
    odometer.drive(1.0, 0.2, 0.3)
    other.restore(odometer.snapshot())
    read_draws(other_rng, written_draws(rng))
    for each in (odometer, other):
        each.drive(1.0, 0.0, 0.1)
    assert odometer.pose == other.pose


def test_draws_that_no_generator_wrote_are_refused() -> None:
    with pytest.raises(ValueError, match="draws"):
        read_draws(np.random.default_rng(1), "[]")


def test_ranges_are_a_little_off_and_some_are_missing() -> None:
    measured = measured_m(np.full(20_000, 3.0), np.random.default_rng(1), LaserNoise(0.01, 0.005))
    back = measured[np.isfinite(measured)]
    assert 1.0 - len(back) / 20_000 == pytest.approx(0.005, rel=0.3)
    assert back.mean() == pytest.approx(3.0, abs=1e-3)
    assert back.std() == pytest.approx(0.01, rel=0.05)


def test_where_nothing_is_nothing_comes_back() -> None:
    assert np.isinf(measured_m(np.full(100, np.inf), np.random.default_rng(1))).all()
