"""Poses: composing and taking apart are each other's inverse."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.localization.pose import compose, relative, transform, wrap, wrap_angle

COORDINATE = st.floats(-100.0, 100.0)
POSE = st.tuples(COORDINATE, COORDINATE, st.floats(-10.0, 10.0)).map(np.array)


@given(base=POSE, pose=POSE)
@settings(max_examples=40, deadline=None)
def test_a_pose_seen_from_another_and_back_is_the_same(base: np.ndarray, pose: np.ndarray) -> None:
    again = compose(base, relative(base, pose))
    assert again[:2] == pytest.approx(pose[:2], abs=1e-9)
    assert wrap_angle(again[2] - pose[2]) == pytest.approx(0.0, abs=1e-9)


def test_a_motion_is_in_the_robots_frame() -> None:
    assert compose(np.array([1.0, 2.0, np.pi / 2]), np.array([1.0, 0.0, 0.0])) == pytest.approx(
        [1.0, 3.0, np.pi / 2]
    )


def test_many_poses_at_once_are_as_one_by_one() -> None:
    generator = np.random.default_rng(1)
    bases, motions = generator.normal(size=(5, 3)), generator.normal(size=(5, 3))
    one_by_one = [compose(base, motion) for base, motion in zip(bases, motions, strict=True)]
    assert compose(bases, motions) == pytest.approx(np.array(one_by_one))


def test_angles_wrap_into_one_turn() -> None:
    assert wrap(np.array([0.0, np.pi, -np.pi, 3 * np.pi, 7.0])) == pytest.approx(
        [0.0, -np.pi, -np.pi, -np.pi, 7.0 - 2 * np.pi]
    )


def test_points_move_with_their_frame() -> None:
    moved = transform(np.array([1.0, 0.0, np.pi / 2]), np.array([[2.0, 0.0], [0.0, 1.0]]))
    assert moved == pytest.approx(np.array([[1.0, 2.0], [0.0, 0.0]]))
