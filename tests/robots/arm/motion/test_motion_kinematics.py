"""Kinematics of a small arm whose geometry is known."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_arm import JOINTS, small_arm

from mend.errors import WrongInputError
from mend.robots.arm.motion.kinematics import KinematicChain, rotation_from_rpy

angles = st.lists(st.floats(-1.5, 1.5), min_size=6, max_size=6).map(np.array)


@pytest.fixture(scope="module")
def chain(tmp_path_factory: pytest.TempPathFactory) -> KinematicChain:
    return small_arm(tmp_path_factory.mktemp("urdf"))


def test_a_stretched_arm_points_up(chain: KinematicChain) -> None:
    assert np.allclose(chain.pose(np.zeros(6))[:3, 3], (0, 0, 1.4))


def test_one_joint_swings_the_arm_down_to_the_front(chain: KinematicChain) -> None:
    joints = np.array([0, math.pi / 2, 0, 0, 0, 0], dtype=float)
    assert np.allclose(chain.pose(joints)[:3, 3], (1.1, 0, 0.3), atol=1e-12)


@settings(max_examples=30, deadline=None)
@given(joints=angles)
def test_the_jacobian_is_the_derivative_of_the_pose(
    chain: KinematicChain, joints: np.ndarray
) -> None:
    jacobian = chain.jacobian(joints)
    step = 1e-6
    for index in range(6):
        moved = joints.copy()
        moved[index] += step
        before, after = chain.pose(joints), chain.pose(moved)
        assert np.allclose((after - before)[:3, 3] / step, jacobian[:3, index], atol=1e-5)
        turn = (after[:3, :3] @ before[:3, :3].T - np.eye(3)) / step
        spin = (turn[2, 1], turn[0, 2], turn[1, 0])
        assert np.allclose(spin, jacobian[3:, index], atol=1e-5)


@settings(max_examples=40, deadline=None)
@given(joints=angles, nudge=st.lists(st.floats(-0.2, 0.2), min_size=6, max_size=6))
def test_what_is_solved_is_reached_within_the_limits(
    chain: KinematicChain, joints: np.ndarray, nudge: list[float]
) -> None:
    target = chain.pose(joints)
    found = chain.solve(target, joints + np.array(nudge), np.zeros(6))
    if found is not None:
        assert np.allclose(chain.pose(found), target, atol=1e-3)
        assert (found >= chain.lower).all()
        assert (found <= chain.upper).all()


def test_a_pose_near_the_seed_is_found(chain: KinematicChain) -> None:
    joints = np.array([0.3, 0.6, 0.9, 0.2, -0.7, 0.1])
    assert chain.solve(chain.pose(joints), joints + 0.1, np.zeros(6)) is not None


def test_half_a_turn_is_found(chain: KinematicChain) -> None:
    joints = np.array([0.3, 0.6, 0.9, 0.2, -0.7, 0.1])
    target = chain.pose(joints)
    target[:3, :3] = target[:3, :3] @ rotation_from_rpy(0.0, 0.0, math.pi)
    found = chain.solve(target, joints, joints)
    assert found is not None
    assert np.allclose(chain.pose(found), target, atol=1e-3)


def test_what_is_out_of_reach_is_not_found(chain: KinematicChain) -> None:
    target = np.eye(4)
    target[:3, 3] = (3.0, 0.0, 0.0)
    assert chain.solve(target, np.zeros(6), np.zeros(6)) is None


def test_a_joint_that_does_not_lead_to_the_tip_is_an_error(tmp_path: Path) -> None:
    urdf = tmp_path / "arm.urdf"
    small_arm(tmp_path)
    with pytest.raises(WrongInputError, match=r"that lead to 'l2' in arm\.urdf are j1, j2;"):
        KinematicChain(urdf, "l2", JOINTS)
