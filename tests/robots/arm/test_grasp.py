"""Grasps: across the thin side, by the knob, and the part where it then must be."""

import math

import numpy as np
import pytest
from drawn_scene import PARTS, Resting
from hypothesis import given
from hypothesis import strategies as st
from scripted_body import GRIPPER, part_in_tool, tool_matrix

from mend.robots.arm.grasp import corners_in_tool, grasp_of, half_turn
from mend.robots.arm.grasp import part_in_tool as grasped_part_in_tool


@pytest.mark.parametrize(
    ("name", "height_m", "yaw", "width_m"),
    [
        ("green_leg", 0.055, 0.0, 0.03),
        ("pink_bar", 0.02, math.pi / 2, 0.03),
        ("purple_top", 0.034, 0.0, 0.028),
    ],
)
def test_parts_are_grasped_across_their_thin_side(name, height_m, yaw, width_m) -> None:
    grasp = grasp_of(PARTS[name], GRIPPER)
    assert grasp.height_m == pytest.approx(height_m)
    assert grasp.yaw == pytest.approx(yaw)
    assert grasp.width_m == pytest.approx(width_m)


@given(yaw=st.floats(-10, 10))
def test_half_a_turn_changes_nothing(yaw: float) -> None:
    turned = half_turn(yaw)
    assert -math.pi / 2 <= turned <= math.pi / 2
    assert abs(math.sin(turned - yaw)) < 1e-6


@given(
    name=st.sampled_from(sorted(PARTS)),
    x=st.floats(0.3, 0.8),
    y=st.floats(-0.6, 0.3),
    yaw=st.floats(-1.5, 1.5),
)
def test_corners_in_the_tool_are_those_of_the_resting_part(name, x, y, yaw) -> None:
    part, resting = PARTS[name], Resting(x, y, 0.7, yaw)
    grasp = grasp_of(part, GRIPPER)
    tool = tool_matrix(grasp.tool_pose(x, y, 0.7, yaw))
    corners = corners_in_tool(part, grasp)[0] @ tool[:3, :3].T + tool[:3, 3]
    local = (corners - resting.matrix()[:3, 3]) @ resting.matrix()[:3, :3]
    assert np.allclose(np.abs(local[:, 0]), part.size[0] / 2)
    assert np.allclose(np.abs(local[:, 1]), part.size[1] / 2)
    assert np.allclose(sorted(local[:, 2]), [0.0] * 4 + [part.size[2]] * 4, atol=1e-9)


def test_a_part_in_the_tool_hangs_below_it() -> None:
    assert part_in_tool("green_leg")[0, 3] == pytest.approx(0.055)


@pytest.mark.parametrize("name", sorted(PARTS))
@given(
    x=st.floats(-1, 1),
    y=st.floats(-1, 1),
    z=st.floats(0, 1),
    yaw=st.floats(-math.pi / 2, math.pi / 2 - 1e-6),
)
def test_where_a_grasped_part_is_follows_from_where_the_tool_is(
    name: str, x: float, y: float, z: float, yaw: float
) -> None:
    grasp = grasp_of(PARTS[name], GRIPPER)
    pose = tool_matrix(grasp.tool_pose(x, y, z, yaw)) @ grasped_part_in_tool(grasp)
    assert pose[:3, 3] == pytest.approx([x, y, z], abs=1e-9)
    assert pose[:3, 2] == pytest.approx([0.0, 0.0, 1.0], abs=1e-9)
    # Fingers do not tell a part from one turned by half a turn.
    found = math.atan2(pose[1, 0], pose[0, 0])
    assert math.sin(2 * (found - yaw)) == pytest.approx(0.0, abs=1e-6)
    assert math.cos(2 * (found - yaw)) == pytest.approx(1.0, abs=1e-6)
