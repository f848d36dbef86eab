"""Wheels of another size than they are taken for: learned on the way, from what the laser saw."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_up_floor import FLOOR

from mend.localization.enml.localizer import EnmlLocalizer
from mend.localization.enml.motion_model import Travel
from mend.localization.enml.parameters import EnmlParameters
from mend.localization.enml.wheels import Step, Wheels
from mend.localization.pose import Poses, compose, relative
from mend.localization.scan import Scan
from mend.maps.ray_cast import cast

ITS = EnmlParameters()
SHARP = np.diag([0.02, 0.02, 0.01]) ** 2
"""The covariance of what a laser tells of a step: good to 2 cm and 0.6 degrees."""
ALONG_A_CORRIDOR = np.diag([1e3, 0.02, 0.01]) ** 2
NOTHING = 1e6 * np.eye(3)
SCALES = st.floats(0.75, 1.35)


def drive(
    wheels: Wheels, scales: tuple[float, float], steps: int, laser: Poses = SHARP, seed: int = 0
) -> None:
    """Ways and turns at random; what odometry tells, times these scales, is how the robot moved."""
    generator = np.random.default_rng(seed)
    for _ in range(steps):
        moved = np.array([generator.uniform(0.3, 1.0), 0.0, generator.uniform(-0.6, 0.6)])
        told = moved / np.array([scales[0], scales[0], scales[1]])
        learn(wheels, told * generator.normal(1.0, 0.05, 3), moved, laser, generator)


def learn(
    wheels: Wheels, told: Poses, moved: Poses, laser: Poses, generator: np.random.Generator
) -> None:
    """One step, from where it is known where the robot is, as an episode finds it."""
    travel = Travel()
    travel.add(wheels.corrected(told))
    whitening = travel.whitening(ITS)
    trust, seen = whitening.T @ whitening, np.linalg.inv(laser)
    measured = moved + generator.multivariate_normal(np.zeros(3), np.minimum(laser, 0.01))
    covariance = np.linalg.inv(trust + seen)
    found = covariance @ (trust @ travel.motion + seen @ measured)
    before = generator.uniform(-3.0, 3.0, 3)
    c, s = np.cos(before[2]), np.sin(before[2])
    on_map = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    joint = np.zeros((6, 6))
    joint[3:, 3:] = on_map @ covariance @ on_map.T
    wheels.learn(Step(travel, before, compose(before, found), joint))


@settings(deadline=None, max_examples=30)
@given(scales=st.tuples(SCALES, SCALES), seed=st.integers(0, 10_000))
def test_whatever_the_wheels_are_wrong_by_is_learned(
    scales: tuple[float, float], seed: int
) -> None:
    wheels = Wheels(ITS)
    drive(wheels, scales, 80, seed=seed)
    np.testing.assert_allclose(wheels.scales, scales, rtol=0.06)


@settings(deadline=None, max_examples=30)
@given(seed=st.integers(0, 10_000))
def test_wheels_that_are_right_stay_so(seed: int) -> None:
    wheels = Wheels(ITS)
    for number in range(10):
        drive(wheels, (1.0, 1.0), 10, seed=10 * seed + number)
        np.testing.assert_allclose(wheels.scales, 1.0, atol=0.08)
    np.testing.assert_allclose(wheels.scales, 1.0, atol=0.04)


def test_along_a_corridor_only_turns_are_learned_from() -> None:
    wheels = Wheels(ITS)
    drive(wheels, (1.2, 1.2), 80, ALONG_A_CORRIDOR)
    assert wheels.scales == pytest.approx([1.0, 1.2], abs=0.03)


def test_nothing_is_learned_where_the_laser_shows_nothing() -> None:
    wheels = Wheels(ITS)
    drive(wheels, (1.2, 1.2), 80, NOTHING)
    assert wheels.scales == pytest.approx(1.0, abs=1e-3)


def test_a_slip_teaches_little() -> None:
    wheels = Wheels(ITS)
    drive(wheels, (1.0, 1.0), 40)
    before = wheels.scales
    learn(
        wheels, np.array([5.0, 0.0, 3.0]), np.array([0.5, 0.0, 0.1]), SHARP,
        np.random.default_rng(1),
    )  # fmt: skip
    assert wheels.scales == pytest.approx(before, abs=0.02)


def test_a_new_load_is_learned_after_the_old() -> None:
    wheels = Wheels(ITS)
    drive(wheels, (0.9, 0.9), 300)
    drive(wheels, (1.1, 1.1), 300, seed=1)
    assert wheels.scales == pytest.approx([1.1, 1.1], abs=0.05)


def test_broken_wheels_are_believed_to_be_off_by_no_more_than_some() -> None:
    wheels = Wheels(ITS)
    drive(wheels, (3.0, 0.2), 200)
    assert wheels.scales == pytest.approx([1.4, 0.7])


def seen_from(pose: Poses, time_s: float) -> Scan:
    angles = np.linspace(-0.75 * np.pi, 0.75 * np.pi, 181)
    ranges, hit = cast(FLOOR.segments, float(pose[0]), float(pose[1]), pose[2] + angles, 10.0)
    ranges = np.where(hit >= 0, ranges, np.inf)
    return Scan(ranges, float(angles[0]), float(angles[1] - angles[0]), 10.0, time_s)


def test_a_robot_that_sees_nothing_goes_by_what_it_learned_until_it_begins_anew() -> None:
    x = np.arange(2.0, 22.0, 0.4)
    way = np.column_stack([x, 7.0 + 0.3 * np.sin(x), 0.3 * np.cos(x)])
    localizer = EnmlLocalizer(FLOOR, start=way[0])
    motions = np.vstack([np.zeros(3), relative(way[:-1], way[1:])])
    for index, (motion, pose) in enumerate(zip(motions, way, strict=True)):
        before = localizer.update(1.2 * motion, seen_from(pose, float(index))).pose
    unseen = Scan(np.full(181, np.inf), -2.0, 0.02, 10.0, 1e3)
    told = np.array([1.2, 0.0, 0.0])
    after = localizer.update(told, unseen).pose
    assert np.hypot(*(after - before)[:2]) == pytest.approx(1.0, abs=0.05)
    localizer.reset(before)
    localizer.update(np.zeros(3), unseen)
    after = localizer.update(told, unseen).pose
    assert np.hypot(*(after - before)[:2]) == pytest.approx(1.2, abs=0.01)
