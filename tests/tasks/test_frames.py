"""A robot's base frame in the scene's: there and back, and a scene as a robot has it."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mend.tasks.frames import ALONE, Frame, frames_of
from mend.tasks.scene import Base, Place, Pose, Scene, Table

LENGTHS = st.floats(-5.0, 5.0)
FRAMES = st.builds(Frame, LENGTHS, LENGTHS, st.integers(0, 3))


@given(FRAMES, LENGTHS, LENGTHS)
def test_a_point_comes_back_to_where_it_was(frame: Frame, x: float, y: float) -> None:
    assert frame.to_scene(*frame.to_robot(x, y)) == pytest.approx((x, y), abs=1e-9)


@given(FRAMES, LENGTHS, LENGTHS, st.floats(-math.pi, math.pi))
def test_a_place_has_its_direction_from_the_robot(
    frame: Frame, x: float, y: float, yaw: float
) -> None:
    scene = Scene(name="s", objects={}, places={"spot": Place(pose=Pose(x=x, y=y, yaw=yaw))})
    seen = frame.scene_to_robot(scene).places["spot"].pose
    assert frame.to_scene(seen.x, seen.y) == pytest.approx((x, y), abs=1e-9)
    assert math.remainder(seen.yaw + frame.yaw - yaw, 2 * math.pi) == pytest.approx(0.0, abs=1e-9)


def test_a_table_seen_from_its_short_side_is_as_deep_as_it_was_wide() -> None:
    table = Table(center=(0.6, 0.0), size=(0.4, 1.2))
    seen = Frame.of(Base(x=0.6, y=-1.5, yaw=math.pi / 2)).table_to_robot(table)
    assert seen.center == pytest.approx((1.5, 0.0))
    assert seen.size == (1.2, 0.4)


def test_without_robots_one_stands_alone_in_the_middle() -> None:
    assert frames_of(Scene(name="s", objects={}, places={})) == {ALONE: Frame()}


def test_a_robot_stands_along_an_edge() -> None:
    with pytest.raises(ValueError, match="multiple of a quarter of a turn"):
        Base(x=0.0, y=0.0, yaw=0.5)
