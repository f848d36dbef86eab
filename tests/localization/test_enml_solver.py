"""The compiled normal equations equal the plain ones, and the solver finds the lowest cost."""

from dataclasses import replace

import numpy as np
import plain_normal_equations
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.localization.enml import normal_equations
from mend.localization.enml.prior import prior_on_last, whitening_of
from mend.localization.enml.problem import Floats, LtfConstraints, PoseGraph, StfConstraints
from mend.localization.enml.solver import solve
from mend.localization.pose import compose, relative


def problem_of(
    seed: int, *, poses: int, ltf: int, pairs: int, stf: int
) -> tuple[PoseGraph, Floats]:
    """A problem with everything in it, and poses that solve none of it."""
    generator = np.random.default_rng(seed)
    truth = np.cumsum(generator.normal([0.3, 0.0, 0.05], [0.05, 0.05, 0.1], (poses, 3)), axis=0)
    directions = generator.uniform(0.0, 2.0 * np.pi, poses * ltf)
    first = generator.integers(0, max(poses - 1, 1), pairs)
    second = np.minimum(first + 1 + generator.integers(0, 3, pairs), poses - 1)
    angles = generator.uniform(0.0, 2.0 * np.pi, (2, pairs * stf))
    built = PoseGraph(
        prior=truth[0] + generator.normal(0.0, 0.02, 3),
        prior_whitening=whitening_of(np.diag([0.01, 0.02, 0.005])),
        odometry=relative(truth[:-1], truth[1:]) + generator.normal(0.0, 0.02, (poses - 1, 3)),
        odometry_whitening=np.tile(np.diag([20.0, 30.0, 40.0]), (poses - 1, 1, 1)),
        odometry_width=2.0,
        ltf=LtfConstraints(
            start=np.arange(poses + 1) * ltf,
            points=generator.uniform(-5.0, 5.0, (poses * ltf, 2)),
            normals=np.column_stack([np.cos(directions), np.sin(directions)]),
            offsets=generator.uniform(-3.0, 3.0, poses * ltf),
            widths_m=generator.uniform(0.1, 0.4, poses),
        ),
        stf=StfConstraints(
            pairs=np.column_stack([first, second]).astype(np.int64),
            start=np.arange(pairs + 1) * stf,
            points_a=generator.uniform(-5.0, 5.0, (pairs * stf, 2)),
            normals_a=np.column_stack([np.cos(angles[0]), np.sin(angles[0])]),
            points_b=generator.uniform(-5.0, 5.0, (pairs * stf, 2)),
            normals_b=np.column_stack([np.cos(angles[1]), np.sin(angles[1])]),
            width_m=0.1,
        ),
        ltf_weight=20.0,
        stf_weight=10.0,
    )
    return built, truth + generator.normal(0.0, 0.1, truth.shape)


@settings(deadline=None, max_examples=25)
@given(
    seed=st.integers(0, 10_000),
    poses=st.integers(2, 6),
    ltf=st.integers(0, 8),
    pairs=st.integers(0, 3),
    stf=st.integers(0, 6),
)
def test_compiled_normal_equations_equal_the_plain_ones(
    seed: int, poses: int, ltf: int, pairs: int, stf: int
) -> None:
    problem, start = problem_of(seed, poses=poses, ltf=ltf, pairs=pairs, stf=stf)
    fast = normal_equations.linearize(problem, start)
    plain = plain_normal_equations.linearize(problem, start)
    for one, other in zip(fast, plain, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9)


@settings(deadline=None, max_examples=10)
@given(seed=st.integers(0, 10_000))
def test_the_gradient_is_the_slope_of_the_cost(seed: int) -> None:
    problem, start = problem_of(seed, poses=4, ltf=5, pairs=2, stf=4)
    _, gradient, _ = normal_equations.linearize(problem, start)
    step = 1e-6
    for index in range(start.size):
        shift = np.zeros(start.size)
        shift[index] = step
        above, _, _ = normal_equations.linearize(problem, start + shift.reshape(start.shape))
        below, _, _ = normal_equations.linearize(problem, start - shift.reshape(start.shape))
        assert gradient[index] == pytest.approx((above - below) / (2 * step), rel=1e-4, abs=1e-4)


def test_both_paths_solve_to_the_same_poses() -> None:
    problem, start = problem_of(3, poses=6, ltf=8, pairs=3, stf=6)
    fast = solve(problem, start, 50)
    plain = solve(problem, start, 50, plain_normal_equations.linearize)
    np.testing.assert_allclose(fast.poses, plain.poses, atol=1e-8)
    np.testing.assert_allclose(fast.covariance_of(-1), plain.covariance_of(-1), rtol=1e-6)
    assert fast.cost < normal_equations.linearize(problem, start)[0]


def test_without_observations_the_uncertainty_grows_along_the_way() -> None:
    problem, _ = problem_of(0, poses=5, ltf=0, pairs=0, stf=0)
    poses = [problem.prior]
    for motion in problem.odometry:
        poses.append(compose(poses[-1], motion))
    solution = solve(problem, np.array(poses), 20)
    spreads = [np.trace(solution.covariance_of(index)[:2, :2]) for index in range(5)]
    assert solution.cost == pytest.approx(0.0, abs=1e-12)
    assert spreads == sorted(spreads)
    np.testing.assert_allclose(solution.covariance_of(-1), solution.covariance_of(4))


@settings(deadline=None, max_examples=10)
@given(seed=st.integers(0, 10_000), boundary=st.integers(1, 3))
def test_a_prior_says_what_the_poses_before_it_said(seed: int, boundary: int) -> None:
    whole, start = problem_of(seed, poses=5, ltf=0, pairs=0, stf=0)
    best = solve(whole, start, 50)
    unseen = LtfConstraints(
        np.zeros(boundary + 2, dtype=np.int64),
        whole.ltf.points,
        whole.ltf.normals,
        whole.ltf.offsets,
        whole.ltf.widths_m[: boundary + 1],
    )
    before = replace(
        whole,
        odometry=whole.odometry[:boundary],
        odometry_whitening=whole.odometry_whitening[:boundary],
        ltf=unseen,
    )
    mean, whitening = prior_on_last(before, best.poses[: boundary + 1])
    np.testing.assert_allclose(mean, best.poses[boundary], atol=1e-6)
    np.testing.assert_allclose(
        np.linalg.inv(whitening.T @ whitening), best.covariance_of(boundary), rtol=1e-5, atol=1e-9
    )
