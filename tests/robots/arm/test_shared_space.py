"""The space that an arm has for a leaf, where several work at one table."""

import math

import pytest
from shapely import Point

from mend.robots.arm.body import ArmRoom, Swing
from mend.robots.arm.shared_space import home, leaf_space
from mend.tasks.frames import Frame
from mend.tasks.scene import Pose, SceneObject

FRAME = Frame(1.0, 0.0, 2)
ROOM = ArmRoom([(0.0, -0.5)], (0.5, 0.0), 0.1)
SWINGING = ArmRoom([(0.0, -0.5)], (0.5, 0.0), 0.1, Swing(pivot=(0.0, 0.0), tool=(0.0, -0.5)))
PART = SceneObject(color=(0.9, 0.1, 0.1), size=(0.06, 0.08, 0.05), pose=Pose(x=0.5, y=0.0))


def test_an_arm_rests_where_its_robot_stands() -> None:
    x, y = home(FRAME, ROOM).centroid.coords[0]
    assert (x, y) == pytest.approx((1.0, 0.5))


def test_a_leaf_takes_the_way_between_its_ends_with_the_part_on_it() -> None:
    space = leaf_space(FRAME, ROOM, [(0.5, 0.0), (0.5, 0.4)], PART)
    assert space.covers(Point(0.5, 0.2))
    assert space.covers(Point(0.36, 0.0))
    assert not space.covers(Point(0.34, 0.0))


def test_an_arm_that_turns_about_its_shoulder_takes_the_arc_between_two_ends() -> None:
    ends = [(1.0, 0.6), (0.4, 0.0)]
    aside = Point(1.0 - 0.6 * math.cos(math.pi / 4), 0.6 * math.sin(math.pi / 4))
    assert not leaf_space(FRAME, ROOM, ends, None).covers(aside)
    assert leaf_space(FRAME, SWINGING, ends, None).covers(aside)


def test_what_of_a_robot_never_moves_is_its_own_space_too() -> None:
    torso = [(-0.3, -0.2), (0.1, -0.2), (0.1, 0.2), (-0.3, 0.2)]
    broad = ArmRoom([(0.0, -0.5)], (0.5, 0.0), 0.1, torso=torso)
    chest, aside = Point(0.95, -0.15), Point(0.7, -0.2)
    for space in (home(FRAME, broad), leaf_space(FRAME, broad, [(0.4, 0.4)], None)):
        assert space.covers(chest)
        assert not space.covers(aside)
    assert not home(FRAME, ROOM).covers(chest)


def test_people_hold_a_part_out_within_the_space_of_its_leaf() -> None:
    there = Point(0.5, 0.0)
    ends = [(1.0, 0.6)]
    assert not leaf_space(FRAME, ROOM, ends, PART).covers(there)
    assert leaf_space(FRAME, ROOM, ends, PART, handed_over=True).covers(there)
